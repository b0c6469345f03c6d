#include "service/jobs/retention.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <set>

#include <fmt/format.h>

#include "service/jobs/utc.h"

namespace shadowbench::service {
namespace {

constexpr double seconds_a_day = 86400.0;
constexpr std::chrono::milliseconds between_sweeps{1000};
constexpr std::chrono::seconds longest_between_sweeps{60};
constexpr int most_new_faults = 5;  // in one sweep

std::size_t ended_runs(const JobTally& tally) {
    std::size_t all = tally.reused;
    for (const auto& [state, number] : tally.ended) all += number;
    return all;
}

// `stuck`: the jobs that could not be removed before. They come last, so that they keep no other one. After some new
// faults the others wait for the next sweep, since all of the storage may fail.
void remove_all(const Workplace& place, std::vector<Removable> jobs, std::set<std::string>& stuck,
                const std::function<void(const std::string& id, const char* reason)>& remove) {
    std::stable_partition(jobs.begin(), jobs.end(), [&](const Removable& job) { return !stuck.contains(job.id); });
    int new_faults = 0;
    for (const Removable& job : jobs) {
        if (place.board.stopping() || new_faults == most_new_faults) return;
        try {
            remove(job.id, job.reason);
            stuck.erase(job.id);
        } catch (const std::exception& fault) {
            if (!stuck.insert(job.id).second) continue;
            ++new_faults;
            place.news.storage(fmt::format("job {} cannot be removed: {}", job.id, fault.what()));
        }
    }
}

}  // namespace

std::vector<Removable> choose_removable(const std::vector<JobStore::Ended>& jobs, const Retention& keep,
                                        const std::string& now) {
    std::uint64_t bytes = 0;
    for (const JobStore::Ended& job : jobs) bytes += job.bytes;
    std::vector<Removable> chosen;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        const std::optional<double> age = seconds_between(jobs[i].ended, now);
        if (keep.days && age && *age > *keep.days * seconds_a_day)
            chosen.push_back({jobs[i].id, "age"});
        else if (keep.jobs && jobs.size() - i > *keep.jobs)
            chosen.push_back({jobs[i].id, "number"});
        else if (keep.bytes && bytes > *keep.bytes)
            chosen.push_back({jobs[i].id, "space"});
        else
            continue;
        bytes -= jobs[i].bytes;
    }
    return chosen;
}

void sweep(const Workplace& place, const std::function<void(const std::string& id, const char* reason)>& remove) {
    std::size_t seen = 0;
    std::set<std::string> stuck;
    auto last = JobBoard::Clock::now() - longest_between_sweeps;
    for (; !place.board.stopping(); place.board.pause(between_sweeps)) {
        const std::size_t now = ended_runs(place.news.tally());
        if (now == seen && JobBoard::Clock::now() - last < longest_between_sweeps) continue;
        try {
            place.presence.check();
            remove_all(place, choose_removable(place.store.list_removable(), place.limits.retention, now_utc()), stuck,
                       remove);
            seen = now;
            last = JobBoard::Clock::now();
        } catch (const std::exception&) {
            // The storage fails, which the workers report.
        }
    }
}

}  // namespace shadowbench::service
