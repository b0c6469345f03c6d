#include "service/jobs/worker.h"

#include <ctime>
#include <fstream>
#include <optional>
#include <system_error>
#include <type_traits>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "base/error.h"
#include "service/jobs/child.h"
#include "service/jobs/progress_line.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;
using Clock = JobBoard::Clock;

constexpr std::chrono::milliseconds between_progress{100};
constexpr std::chrono::milliseconds before_next_try{500};
constexpr int promise_broken = 2;  // exit code: a result all the same

// How a run ended.
struct Success {
    bool kept;
};
struct Again {
    bool uncounted;
};
struct Cancelled {};
using Verdict = std::variant<Success, Again, Cancelled, JobFault>;

// Repeats what the store could not do, as on a full disk. Nothing: the server stops; the next one finds the job as it
// is.
template <class Body>
auto persist(const Workplace& place, const Body& body) -> std::optional<std::decay_t<decltype(body())>> {
    for (;;) {
        try {
            return body();
        } catch (const Error&) {
            if (place.board.stopping()) return std::nullopt;
            place.board.pause(before_next_try);
        }
    }
}

void write_scenario(const fs::path& work, const std::string& text) {
    std::ofstream file(work / "scenario.json", std::ios::binary);
    file << text;
    file.close();
    if (!file) throw Error(ErrorCode::io, "", "the job's scenario cannot be written");
}

std::vector<std::string> arguments_of(const Workplace& place, const StoredJob& job, const fs::path& work) {
    std::vector<std::string> arguments{place.program, "job", work.string()};
    for (const std::string& folder : place.data) arguments.insert(arguments.end(), {"--data", folder});
    arguments.insert(arguments.end(), {"--memory-limit", fmt::format("{}", static_cast<double>(place.limits.memory) /
                                                                               (1024.0 * 1024.0 * 1024.0))});
    if (!job.key.pictures) arguments.push_back("--no-pictures");
    return arguments;
}

// What a child says about itself, passed on to the board no faster than people read.
class Listener {
public:
    Listener(const Workplace& place, JobBoard::Run& run) : place_(place), run_(run) {}

    void hear(std::string_view line) {
        auto heard = read_line(line);
        if (auto* progress = std::get_if<JobProgress>(&heard)) {
            latest_ = std::move(*progress);
            pass_on();
        } else if (auto* fault = std::get_if<JobFault>(&heard)) {
            fault->where = hide(fault->where, place_.hidden);
            fault->message = hide(fault->message, place_.hidden);
            fault_ = std::move(*fault);
        }
    }

    void pass_on() {
        if (!latest_ || Clock::now() < next_) return;
        next_ = Clock::now() + between_progress;
        try {
            const std::uint64_t revision = place_.store.next_revision();
            place_.board.show(run_, std::move(*latest_), revision);
        } catch (const Error&) {
            // The disk is full: progress is not what matters now.
        }
        latest_.reset();
    }

    const std::optional<JobFault>& fault() const { return fault_; }

private:
    const Workplace& place_;
    JobBoard::Run& run_;
    std::optional<JobProgress> latest_;
    std::optional<JobFault> fault_;
    Clock::time_point next_{};
};

bool has_result(const fs::path& work) {
    return find_file_in(work, "result.json").has_value();
}

Verdict judge(const Workplace& place, const StoredJob& job, const JobBoard::Run& run, const fs::path& work,
              const ChildReport& report, const std::optional<JobFault>& said) {
    if (report.end == ChildEnd::told)
        return place.board.is_cancelled(run) ? Verdict(Cancelled{}) : Verdict(Again{true});
    if (report.end == ChildEnd::exited) {
        const bool finished = report.code == 0 || report.code == promise_broken;
        if (finished && has_result(work)) return Success{report.code == 0};
        return said.value_or(fault_of_end(report, place.limits));
    }
    // Nobody asked for it, and it may not come again.
    if (report.end == ChildEnd::signalled && job.attempts < place.limits.attempts) return Again{false};
    return fault_of_end(report, place.limits);
}

Verdict execute(const Workplace& place, const StoredJob& job, JobBoard::Run& run, const fs::path& work) {
    const std::optional<std::string> scenario = place.store.scenario(job.id);
    if (!scenario) return Cancelled{};  // and removed
    write_scenario(work, *scenario);
    Listener listener(place, run);
    const ChildLimits limits{place.limits.seconds, place.limits.memory};
    const ChildReport report = run_child(
        arguments_of(place, job, work), limits, [&](std::string_view line) { listener.hear(line); },
        [&] {
            listener.pass_on();
            return place.board.is_cancelled(run) || place.board.past_deadline();
        });
    Verdict verdict = judge(place, job, run, work, report, listener.fault());
    if (const auto* success = std::get_if<Success>(&verdict)) {
        fs::remove(work / "scenario.json");  // the store has it
        // From here on whoever finds the folder in its place knows all that is to know of the job.
        if (!place.store.note_kept(job.id, success->kept)) return Cancelled{};
        publish(place.folders, work, job.id);
    }
    return verdict;
}

std::optional<std::uint64_t> settle(const Workplace& place, const StoredJob& job, const Verdict& verdict) {
    if (const auto* success = std::get_if<Success>(&verdict))
        return place.store.end_running(job.id, {job_states::succeeded, now_utc(), success->kept, {}});
    if (const auto* again = std::get_if<Again>(&verdict)) return place.store.requeue_running(job.id, again->uncounted);
    if (const auto* fault = std::get_if<JobFault>(&verdict))
        return place.store.end_running(
            job.id, {job_states::failed, now_utc(), {}, StoredFault{fault->code, fault->where, fault->message}});
    return std::nullopt;
}

void run_one(const Workplace& place, const StoredJob& job) {
    const auto run = place.board.begin(job.id);
    place.board.announce(job.revision, true);
    const fs::path work = place.folders.work / fmt::format("{}-{}", job.id, job.attempts);
    Verdict verdict = Cancelled{};
    try {
        // A cancellation between the claim and the begin found nobody to tell.
        const std::optional<StoredJob> now = place.store.find(job.id);
        if (now && now->state == job_states::running) {
            make_work_folder(work);
            verdict = execute(place, job, *run, work);
        }
    } catch (const Error& error) {
        verdict = JobFault{static_cast<int>(error.code()), "", hide(error.message(), place.hidden)};
    } catch (const std::exception&) {
        verdict = JobFault{static_cast<int>(ErrorCode::internal), "", "the job could not be run"};
    }
    const auto revision = persist(place, [&] { return settle(place, job, verdict); });
    const bool succeeded = std::holds_alternative<Success>(verdict);
    // Cancelled at the last moment, or its results got their place and then a fault came.
    if (revision && (!*revision || !succeeded)) remove_folder(place.folders.jobs / job.id);
    place.board.end(run);
    remove_folder(work);
    if (revision && *revision) place.board.announce(**revision, true);
}

}  // namespace

void run_jobs(const Workplace& place) {
    while (!place.board.stopping()) {
        const std::uint64_t seen = place.board.work();
        const auto job = persist(place, [&] { return place.store.claim(now_utc()); });
        if (job && *job)
            run_one(place, **job);
        else
            place.board.wait_for_work(seen);
    }
}

void recover_running(const Workplace& place) {
    for (const StoredJob& job : place.store.list(job_states::running, INT32_MAX, 0)) {
        if (job.kept && is_published(place.folders, job.id)) {
            place.store.end_running(job.id, {job_states::succeeded, now_utc(), job.kept, {}});
        } else if (job.attempts >= place.limits.attempts) {
            const StoredFault fault{
                static_cast<int>(ErrorCode::internal), "",
                fmt::format("the server died during this job's run, the last of {} that it may have", job.attempts)};
            place.store.end_running(job.id, {job_states::failed, now_utc(), {}, fault});
        } else {
            place.store.requeue_running(job.id, false);
        }
    }
}

std::string now_utc() {
    std::timespec now{};
    std::timespec_get(&now, TIME_UTC);
    std::tm parts{};
    gmtime_r(&now.tv_sec, &parts);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &parts);
    return fmt::format("{}.{:03}Z", text, now.tv_nsec / 1000000);
}

}  // namespace shadowbench::service
