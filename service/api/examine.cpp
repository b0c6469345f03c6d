#include "service/api/examine.h"

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "service/api/helper_side.h"

namespace shadowbench::service {
namespace {

constexpr std::size_t checks_at_a_time = 2, checks_kept = 256;

base::Error error_of(const nlohmann::json& error) {
    return {static_cast<base::ErrorCode>(error.value("code", 70)), error.value("where", ""),
            error.value("message", "")};
}

}  // namespace

nlohmann::json take_answer(const std::string& line) {
    nlohmann::json answer = nlohmann::json::parse(line, nullptr, false);
    if (!answer.is_object()) throw base::Error(base::ErrorCode::internal, "helper process", "its answer is not JSON");
    if (const auto error = answer.find("error"); error != answer.end()) throw error_of(*error);
    return answer;
}

Examiner::Examiner(StartHelper start, std::vector<std::string> arguments, double seconds, std::size_t waiting)
    : start_(std::move(start)),
      arguments_(std::move(arguments)),
      seconds_(seconds),
      slots_(checks_at_a_time, waiting),
      answers_(checks_kept) {}

std::variant<nlohmann::json, std::vector<base::Error>> Examiner::examine(const std::string& scenario,
                                                                         const std::string& recommend) {
    const std::string question = recommend.empty() ? scenario : scenario + "\t" + recommend;
    {
        const std::scoped_lock lock(mutex_);
        if (const std::string* known = answers_.find(question)) return take_answer(*known);
    }
    const Slots::Slot slot = slots_.take(seconds_);
    const std::string line = start_(arguments_)->ask(question, seconds_);
    nlohmann::json answer = take_answer(line);
    if (const auto faults = answer.find("faults"); faults != answer.end()) {
        std::vector<base::Error> wrong;
        for (const nlohmann::json& fault : *faults) wrong.push_back(error_of(fault));
        return wrong;
    }
    const std::scoped_lock lock(mutex_);
    answers_.put(question, line);
    return answer;
}

std::string Examiner::arrange(const std::string& request) {
    const Slots::Slot slot = slots_.take(seconds_);
    std::string line = start_(arguments_)->ask(std::string(files_mark) + request, seconds_);
    take_answer(line);  // throws the fault that it may be
    return line;
}

}  // namespace shadowbench::service
