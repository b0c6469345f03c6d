#include "service/api/curve_cache.h"

#include <chrono>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"

namespace shadowbench::service {
namespace {

constexpr std::size_t curves_at_a_time = 2, lights = 2, curves_kept = 1024;

}  // namespace

CurveCache::CurveCache(StartHelper start, std::vector<std::string> arguments, double seconds, std::size_t waiting)
    : start_(std::move(start)),
      arguments_(std::move(arguments)),
      seconds_(seconds),
      slots_(curves_at_a_time, waiting),
      answers_(curves_kept),
      workers_(lights) {}

std::shared_ptr<CurveCache::Worker> CurveCache::worker_for(const std::string& key) {
    const std::scoped_lock lock(mutex_);
    if (const auto* known = workers_.find(key)) return *known;
    std::erase_if(fresh_, [](const auto& entry) { return entry.second.expired(); });
    std::weak_ptr<Worker>& place = fresh_[key];
    std::shared_ptr<Worker> worker = place.lock();
    if (!worker) place = worker = std::make_shared<Worker>();
    return worker;
}

std::string CurveCache::curves(const CurveQuestion& question, const std::function<std::string()>& scenario) {
    const std::string place =
        fmt::format("{} {} {} {} {}", question.job, question.variant, question.x, question.y, question.light);
    {
        const std::scoped_lock lock(mutex_);
        if (const std::string* known = answers_.find(place)) return *known;
    }
    const Slots::Slot slot = slots_.take(seconds_);
    const std::string key = fmt::format("{} {} {}", question.job, question.variant, question.light);
    const std::shared_ptr<Worker> worker = worker_for(key);
    const std::unique_lock turn(worker->mutex, std::chrono::duration<double>(seconds_));
    if (!turn) throw Busy{};
    std::string line = fmt::format("{} {}", question.x, question.y);
    const bool first = !worker->helper;
    if (first) {
        std::vector<std::string> arguments = arguments_;
        arguments.push_back("--variant=" + std::to_string(question.variant));
        if (!question.light.empty()) arguments.push_back("--light=" + question.light);
        line = scenario() + "\n" + line;
        worker->helper = start_(arguments);
    }
    std::string answer;
    try {
        answer = worker->helper->ask(line, seconds_);
    } catch (const base::Error&) {
        worker->helper.reset();  // it has ended, or still works on this request
        throw;
    }
    try {
        take_answer(answer);
    } catch (const base::Error&) {
        if (first) worker->helper.reset();
        throw;
    }
    const std::scoped_lock lock(mutex_);
    answers_.put(place, answer);
    if (first) workers_.put(key, worker);
    return answer;
}

}  // namespace shadowbench::service
