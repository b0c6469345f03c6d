#include "service/jobs/worker.h"

#include <chrono>
#include <cstdint>
#include <fstream>
#include <memory>
#include <mutex>
#include <optional>
#include <system_error>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "base/error.h"
#include "service/jobs/child.h"
#include "service/jobs/launched.h"
#include "service/jobs/progress_line.h"
#include "service/jobs/record.h"
#include "service/jobs/room.h"
#include "service/jobs/storage_wait.h"
#include "service/jobs/utc.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;
using Clock = JobBoard::Clock;

constexpr std::chrono::milliseconds between_progress{100};
constexpr std::chrono::milliseconds last_moment{500};
constexpr int promise_broken = 2;  // exit code: the result is complete

// How a run ended.
struct Success {
    bool kept;
    std::uint64_t bytes = 0;  // of its results
};
struct Requeue {
    bool uncounted;
    std::string why = {};  // how its process died
};
struct Cancelled {};
using Verdict = std::variant<Success, Requeue, Waits, Cancelled, JobFault>;

// What a job's process reads: its scenario and, for a recommendation, what is asked of it.
constexpr const char *scenario_name = "scenario.json", *recommend_name = "recommend.json";

void write_input(const fs::path& file, const std::string& text) {
    std::ofstream out(file, std::ios::binary);
    out << text;
    out.close();
    if (!out) throw Error(ErrorCode::io, "", "the job's scenario cannot be written");
}

std::vector<std::string> arguments_of(const Workplace& place, const StoredJob& job, const fs::path& work) {
    std::vector<std::string> arguments{"job", work.string()};
    for (const std::string& folder : place.data) arguments.insert(arguments.end(), {"--data", folder});
    arguments.insert(arguments.end(), {"--memory-limit", fmt::format("{}", static_cast<double>(place.limits.memory) /
                                                                               (1024.0 * 1024.0 * 1024.0))});
    if (!job.key.pictures) arguments.push_back("--no-pictures");
    arguments.insert(arguments.end(), place.further.begin(), place.further.end());
    return arguments;
}

// Reads the lines of a job's process and passes its progress on to the board, at a limited rate.
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
        } else if (auto* storage = std::get_if<StorageFault>(&heard)) {
            storage_ = std::move(*storage);
        }
    }

    void pass_on() {
        if (!latest_ || Clock::now() < next_) return;
        next_ = Clock::now() + between_progress;
        try {
            const std::uint64_t revision = place_.store.next_revision();
            place_.board.show(run_, std::move(*latest_), revision);
        } catch (const Error&) {
            // The storage fails; progress can be lost.
        }
        latest_.reset();
    }

    const std::optional<JobFault>& fault() const { return fault_; }
    const std::optional<StorageFault>& storage_fault() const { return storage_; }

private:
    const Workplace& place_;
    JobBoard::Run& run_;
    std::optional<JobProgress> latest_;
    std::optional<JobFault> fault_;
    std::optional<StorageFault> storage_;
    Clock::time_point next_{};
};

bool has_result(const fs::path& work) {
    return find_file_in(work, "result.json").has_value();
}

Verdict judge(const Workplace& place, const StoredJob& job, const JobBoard::Run& run, const fs::path& work,
              const ChildReport& report, const std::optional<JobFault>& reported) {
    if (report.end == ChildEnd::stopped)
        return place.board.is_cancelled(run) ? Verdict(Cancelled{}) : Verdict(Requeue{true});
    if (report.end == ChildEnd::exited) {
        const bool finished = report.code == 0 || report.code == promise_broken;
        if (finished && has_result(work)) return Success{report.code == 0};
        return reported.value_or(fault_of_end(report, place.limits, place.hidden));
    }
    if (report.end == ChildEnd::signalled || report.end == ChildEnd::lost) {
        // Who ends the server often ends its processes too, in any order. So a death counts once the server has
        // outlived it for a moment.
        place.board.pause(last_moment);
        if (place.board.stopping()) return Requeue{true};
        // Another run may not be killed.
        if (job.attempts < place.limits.attempts)
            return Requeue{false, fault_of_end(report, place.limits, place.hidden).message};
    }
    return fault_of_end(report, place.limits, place.hidden);
}

// A failure of a job's process on a disk that cannot be written is not the job's fault, whatever it reports.
std::optional<Waits> storage_fault(const Workplace& place, const Verdict& verdict, const ChildReport& report,
                                   const Listener& listener, const fs::path& work) {
    const auto* requeue = std::get_if<Requeue>(&verdict);
    const bool killed = report.end == ChildEnd::signalled || report.end == ChildEnd::lost;
    if (!(killed || report.end == ChildEnd::exited) ||
        !(std::holds_alternative<JobFault>(verdict) || (requeue && !requeue->uncounted)))
        return std::nullopt;
    if (const auto& fault = listener.storage_fault()) return Waits{fault->message, bytes_in(work) + fault->bytes};
    if (!has_room(place.folders.work, least_room))
        return Waits{"nothing can be written to " + place.folders.work.string(), bytes_in(work)};
    // Where little is left, a fault of input or output, or a death, may come from that. The job starts again once there
    // is enough; if the fault is its own, it fails then. What the job itself has written counts as free: else a job
    // that takes the space and dies of its own fault would start again without end.
    const auto* failed = std::get_if<JobFault>(&verdict);
    const bool other = failed && failed->code != static_cast<int>(ErrorCode::io) && !killed;
    const std::uintmax_t own = bytes_in(work);
    if (other || !is_low(place, own)) return std::nullopt;
    return Waits{"little space is left on the disk of " + place.folders.work.string(), own};
}

// Writes the record of the job into its results before they move to their place.
void keep_record(const Workplace& place, const StoredJob& job, bool kept, const std::string& scenario,
                 const fs::path& work) {
    KeptJob record{job, scenario, "", ""};
    record.job.kept = kept;
    record.job.ended = now_utc();
    if (const auto key = place.store.key_of(job.id)) {
        record.idempotency_key = key->key;
        record.request = key->request;
    }
    write_record(work, record);
}

Verdict execute(const Workplace& place, const StoredJob& job, JobBoard::Run& run, const fs::path& work) {
    const std::optional<std::string> scenario = place.store.scenario(job.id);
    if (!scenario) return Cancelled{};  // the job was removed
    write_input(work / scenario_name, *scenario);
    if (!job.key.recommend.empty()) write_input(work / recommend_name, job.key.recommend);
    Listener listener(place, run);
    const ChildLimits limits{place.limits.seconds, place.limits.memory};
    const auto hear = [&](std::string_view line) { listener.hear(line); };
    const auto should_end = [&] {
        listener.pass_on();
        return place.board.is_cancelled(run) || place.board.past_deadline();
    };
    const std::string& launcher = place.limits.launcher;
    const ChildReport report =
        launcher.empty() ? run_child(place.program, arguments_of(place, job, work), limits, hear, should_end)
                         : run_launched(launcher, place.program, place.program,
                                        arguments_of(place, job, fs::absolute(work)), limits, hear, should_end);
    Verdict verdict = judge(place, job, run, work, report, listener.fault());
    if (auto waits = storage_fault(place, verdict, report, listener, work)) return std::move(*waits);
    if (const auto* success = std::get_if<Success>(&verdict)) {
        for (const char* name : {scenario_name, recommend_name}) remove_folder(work / name);  // the record has them
        // Waits for the storage rather than repeat hours of work.
        const auto now = persist(place, [&] {
            const std::optional<StoredJob> row = place.store.find(job.id);
            if (row && row->state == job_states::running) keep_record(place, *row, success->kept, *scenario, work);
            return row;
        });
        if (!now) return Requeue{true};
        if (!*now || (*now)->state != job_states::running) return Cancelled{};
        verdict = Success{success->kept, bytes_in(work)};
        // From here on the published folder says everything about the job.
        publish(place.folders, work, job.id);
    }
    return verdict;
}

std::optional<std::uint64_t> settle(const Workplace& place, const StoredJob& job, const Verdict& verdict) {
    if (const auto* success = std::get_if<Success>(&verdict))
        return place.store.end_running(job.id, {job_states::succeeded, now_utc(), success->kept, {}, success->bytes});
    if (const auto* requeue = std::get_if<Requeue>(&verdict))
        return place.store.requeue_running(job.id, requeue->uncounted);
    if (std::holds_alternative<Waits>(verdict)) return place.store.requeue_running(job.id, true);
    if (const auto* fault = std::get_if<JobFault>(&verdict))
        return place.store.end_running(
            job.id, {job_states::failed, now_utc(), {}, StoredFault{fault->code, fault->where, fault->message}, 0});
    return std::nullopt;
}

// The results of an earlier run, if they were published and only the last step failed.
std::optional<Verdict> finished_before(const Workplace& place, const StoredJob& job) {
    if (!is_published(place.folders, job.id)) return std::nullopt;
    const auto found = read_results(place.folders.jobs / job.id, job.id).job;
    if (!found) return std::nullopt;
    return Success{found->job.kept.value_or(true), bytes_in(place.folders.jobs / job.id)};
}

Verdict attempt(const Workplace& place, const StoredJob& job, JobBoard::Run& run, const fs::path& work) {
    try {
        // The job may have been cancelled between claim() and begin().
        const std::optional<StoredJob> now = place.store.find(job.id);
        if (!now || now->state != job_states::running) return Cancelled{};
        if (auto done = finished_before(place, job)) return std::move(*done);
        make_work_folder(work);
        return execute(place, job, run, work);
    } catch (const Error& error) {
        if (error.code() == ErrorCode::io) return Waits{error.what(), bytes_in(work)};
        return JobFault{static_cast<int>(error.code()), "", hide(error.message(), place.hidden)};
    } catch (const std::exception&) {
        return JobFault{static_cast<int>(ErrorCode::internal), "", "the job could not be run"};
    }
}

// Reports how a run ended, once the store has it.
void tell_end(const Workplace& place, const StoredJob& job, const Verdict& verdict, double seconds) {
    if (std::holds_alternative<Success>(verdict))
        place.news.ended(job, job_states::succeeded, "", seconds);
    else if (const auto* fault = std::get_if<JobFault>(&verdict))
        place.news.ended(job, job_states::failed,
                         fault->where.empty() ? fault->message : fault->where + ": " + fault->message, seconds);
    else if (const auto* requeue = std::get_if<Requeue>(&verdict))
        place.news.requeued(job, requeue->uncounted ? "stopped" : "died", requeue->why);
    else if (const auto* waits = std::get_if<Waits>(&verdict))
        place.news.requeued(job, "storage", waits->why);
}

// Runs a job. Returns what it waits for, if it does.
std::optional<Waits> run_one(const Workplace& place, const StoredJob& job, const std::shared_ptr<JobBoard::Run>& run) {
    place.board.announce(job.revision, true);
    place.news.started(job);
    const auto begun = Clock::now();
    const fs::path work = attempt_folder(place.folders, job.id, job.attempts);
    const Verdict verdict = attempt(place, job, *run, work);
    remove_folder(work);  // first, since it may have filled the disk
    const auto revision = persist(place, [&] { return settle(place, job, verdict); });
    const auto* waits = std::get_if<Waits>(&verdict);
    // The job was cancelled at the last moment.
    if (revision && !*revision) discard_results(place.folders, job.id);
    place.board.end(run);
    if (revision && *revision)
        tell_end(place, job, verdict, std::chrono::duration<double>(Clock::now() - begun).count());
    if (revision && *revision) place.board.announce(**revision, true);
    return waits && revision && *revision ? std::optional(*waits) : std::nullopt;
}

}  // namespace

void run_jobs(const Workplace& place) {
    Patience patience;
    while (!place.board.stopping()) {
        const std::uint64_t seen = place.board.work();
        std::shared_ptr<JobBoard::Run> run;
        const auto job = persist(place, [&] {
            check_storage(place);
            const std::scoped_lock lock(place.board.starting);
            auto claimed = place.store.claim(now_utc(), place.limits.owners);
            if (claimed) run = place.board.begin(claimed->id);
            return claimed;
        });
        if (!job || !*job) {
            place.board.wait_for_work(seen);
        } else if (const auto waits = run_one(place, **job, run)) {
            wait_for_room(place, **job, *waits, patience);
        } else {
            patience = {};
        }
    }
}

}  // namespace shadowbench::service
