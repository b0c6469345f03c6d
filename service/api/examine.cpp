#include "service/api/examine.h"

#include <chrono>
#include <exception>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "service/api/helper_side.h"

namespace shadowbench::service {
namespace {

constexpr std::size_t checks_at_a_time = 2, checks_kept = 256;
constexpr int most_answers = 200;  // of a process: what a library may leave behind does not add up

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
      answers_(checks_kept) {
    try {
        keep({start_(arguments_), 0});  // it gets ready while nobody asks yet
    } catch (const std::exception&) {
        // Whoever asks first gets the fault, if there still is one.
    }
}

void Examiner::keep(Idle helper) {
    try {
        if (helper.answers >= most_answers) helper = {start_(arguments_), 0};
    } catch (const std::exception&) {
        return;  // the answer is there; whoever asks next gets the fault, if there still is one
    }
    const std::scoped_lock lock(mutex_);
    if (idle_.size() < checks_at_a_time) idle_.push_back(std::move(helper));
}

// Nothing without a process that waits, or where it fails or reports a fault: it may have died of something else, so a
// new one decides.
std::optional<std::string> Examiner::ask_idle(const std::string& question) {
    Idle helper;
    {
        const std::scoped_lock lock(mutex_);
        if (idle_.empty()) return std::nullopt;
        helper = std::move(idle_.back());
        idle_.pop_back();
    }
    const auto begun = std::chrono::steady_clock::now();
    try {
        std::string line = helper.helper->ask(question, seconds_);
        take_answer(line);
        ++helper.answers;
        keep(std::move(helper));
        return line;
    } catch (const base::Error&) {
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
        if (took.count() > seconds_ / 2.0) throw;
        return std::nullopt;
    }
}

std::string Examiner::ask(const std::string& question) {
    if (auto line = ask_idle(question)) return std::move(*line);
    Idle fresh{start_(arguments_), 1};
    std::string line = fresh.helper->ask(question, seconds_);
    take_answer(line);
    keep(std::move(fresh));
    return line;
}

std::variant<nlohmann::json, std::vector<base::Error>> Examiner::examine(const std::string& scenario,
                                                                         const std::string& recommend) {
    const std::string question = recommend.empty() ? scenario : scenario + "\t" + recommend;
    {
        const std::scoped_lock lock(mutex_);
        if (const std::string* known = answers_.find(question)) return take_answer(*known);
    }
    const Slots::Slot slot = slots_.take(seconds_);
    const std::string line = ask(question);
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
    return ask(std::string(files_mark) + request);
}

}  // namespace shadowbench::service
