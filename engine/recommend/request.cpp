#include "recommend/request.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/json_pointer.h"
#include "techniques/technique.h"

namespace shadowbench::recommend {
namespace {

using base::Error;
using base::ErrorCode;
using nlohmann::json;

constexpr const char* keys[] = {"error", "measure", "cheapest", "at_most", "budget", "light", "only"};

template <class Words>
std::size_t index_of(const Words& words, const json& value) {
    return static_cast<std::size_t>(
        std::find_if(std::begin(words), std::end(words), [&](const char* word) { return value == word; }) -
        std::begin(words));
}

bool is_number_above_zero(const json& value) {
    return value.is_number() && std::isfinite(value.get<double>()) && value.get<double>() > 0.0;
}

class Reader {
public:
    Reader(const json& request, std::string where, std::vector<Error>& faults)
        : request_(request), where_(std::move(where)), faults_(faults) {}

    Request read() {
        Request read;
        if (!request_.is_object()) {
            fault(where_, "must be an object");
            return read;
        }
        for (const auto& [key, value] : request_.items())
            if (index_of(keys, key) == std::size(keys))
                fault(place(key), fmt::format("unknown key; there are: {}", fmt::join(keys, ", ")));
        read_error(read);
        read_measure(read);
        read_cheapest(read);
        read_limits(read);
        read_budget(read);
        if (const json* light = given("light")) {
            if (light->is_string())
                read.light = light->get<std::string>();
            else
                fault(place("light"), "must be a text: the name of a light, or its number, from 0");
        }
        read_only(read);
        return read;
    }

private:
    void fault(const std::string& where, const std::string& message) {
        faults_.emplace_back(ErrorCode::bad_input, where, message);
    }
    std::string place(const std::string& key) const { return base::append_token(where_, key); }
    const json* given(const char* key) const {
        const auto found = request_.find(key);
        return found == request_.end() ? nullptr : &*found;
    }

    void read_error(Request& read) {
        const json* error = given("error");
        if (error && error->is_number() && error->get<double>() >= least_error && error->get<double>() <= most_error)
            read.goal.error = error->get<double>();
        else
            fault(place("error"), fmt::format("{}must be a number from {} to {}: the largest error that is good enough",
                                              error ? "" : "is missing; it ", least_error, most_error));
    }

    void read_measure(Request& read) {
        const json* measure = given("measure");
        if (!measure) return;
        const std::size_t index = index_of(measure_words, *measure);
        if (index < std::size(measure_words))
            read.measure = static_cast<Measure>(index);
        else
            fault(place("measure"), fmt::format("must be one of: {}", fmt::join(measure_words, ", ")));
    }

    void read_cheapest(Request& read) {
        const json* cheapest = given("cheapest");
        if (!cheapest || *cheapest == "all") return;
        const json list = cheapest->is_array() ? *cheapest : json::array({*cheapest});
        read.goal.asked = {};
        if (list.empty()) fault(place("cheapest"), "must name a cost, or be left out for all");
        for (std::size_t i = 0; i < list.size(); ++i) {
            const std::string where =
                cheapest->is_array() ? base::append_token(place("cheapest"), std::to_string(i)) : place("cheapest");
            const std::size_t cost = index_of(cost_words, list[i]);
            if (cost < costs)
                read.goal.asked[cost] = true;
            else
                fault(where, fmt::format("must be one of: {}{}", fmt::join(cost_words, ", "),
                                         cheapest->is_array() ? "" : ", all"));
        }
    }

    void read_limits(Request& read) {
        const json* limits = given("at_most");
        if (!limits) return;
        if (!limits->is_object()) return fault(place("at_most"), "must be an object of limits by their costs");
        for (const auto& [key, value] : limits->items()) {
            const std::string where = base::append_token(place("at_most"), key);
            const std::size_t cost = index_of(cost_words, key);
            if (cost == costs)
                fault(where, fmt::format("unknown cost; there are: {}", fmt::join(cost_words, ", ")));
            else if (!is_number_above_zero(value))
                fault(where, fmt::format("must be a number above 0, in {}",
                                         cost == static_cast<std::size_t>(Cost::lookup)  ? "ns"
                                         : cost == static_cast<std::size_t>(Cost::bytes) ? "bytes"
                                                                                         : "ms"));
            else
                read.goal.at_most[cost] = value.get<double>();
        }
    }

    void read_budget(Request& read) {
        const json* budget = given("budget");
        read.goal.budget = usual_budget;
        if (budget && is_number_above_zero(*budget))
            read.goal.budget = budget->get<double>();
        else if (budget)
            fault(place("budget"), "must be a number of seconds above 0");
    }

    void read_only(Request& read) {
        const json* only = given("only");
        if (!only) return;
        if (!only->is_array() || only->empty())
            return fault(place("only"), "must be a list of techniques, or be left out for all");
        for (std::size_t i = 0; i < only->size(); ++i) {
            const std::string where = base::append_token(place("only"), std::to_string(i));
            if (!(*only)[i].is_string()) {
                fault(where, "must be the id of a technique");
                continue;
            }
            try {
                read.only.push_back(techniques::find((*only)[i].get<std::string>(), where).id);
            } catch (const Error& error) {
                faults_.push_back(error);
            }
        }
        std::sort(read.only.begin(), read.only.end());
        read.only.erase(std::unique(read.only.begin(), read.only.end()), read.only.end());
    }

    const json& request_;
    std::string where_;
    std::vector<Error>& faults_;
};

}  // namespace

Request read_request(const json& request, const std::string& where, std::vector<Error>& faults) {
    return Reader(request, where, faults).read();
}

json to_json(const Request& request) {
    json cheapest = json::array(), at_most = json::object();
    for (std::size_t k = 0; k < costs; ++k) {
        if (request.goal.asked[k]) cheapest.push_back(cost_words[k]);
        if (std::isfinite(request.goal.at_most[k])) at_most[cost_words[k]] = request.goal.at_most[k];
    }
    json out = {{"error", request.goal.error},
                {"measure", measure_words[static_cast<std::size_t>(request.measure)]},
                {"cheapest", std::move(cheapest)},
                {"at_most", std::move(at_most)},
                {"budget", request.goal.budget}};
    if (!request.light.empty()) out["light"] = request.light;
    if (!request.only.empty()) out["only"] = request.only;
    return out;
}

}  // namespace shadowbench::recommend
