#include <atomic>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <ostream>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/write_files.h"
#include "bench/pace.h"
#include "results/write_result.h"
#include "service/api/helper_side.h"
#include "service/api/service.h"
#include "service/cli/child.h"
#include "service/cli/libraries.h"
#include "service/cli/notify.h"
#include "service/cli/scenario_files.h"
#include "service/cli/server_commands.h"
#include "service/cli/this_program.h"
#include "service/cli/token_file.h"
#include "service/http/server.h"
#include "service/jobs/backup.h"
#include "service/jobs/jobs.h"
#include "service/jobs/launched.h"
#include "service/log/log.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;

constexpr double mib = 1024.0 * 1024.0, gib = 1024.0 * mib;
constexpr double helper_memory = 4.0;         // GiB
constexpr double seconds_after_grace = 30.0;  // that a stop may take once jobs have had their time

std::vector<fs::path> folders_of(const std::vector<std::string>& names) {
    std::vector<fs::path> folders;
    std::error_code ignored;
    for (const std::string& name : names) {
        if (!fs::is_directory(name, ignored))
            throw Error(ErrorCode::no_such_file, "--data " + name, "there is no such folder");
        folders.push_back(fs::absolute(name));
    }
    return folders;
}

// The signals that stop the server. They are blocked before any thread starts; one thread waits for them.
class StopSignals {
public:
    StopSignals() {
        sigemptyset(&set_);
        for (const int signal : {SIGTERM, SIGINT}) sigaddset(&set_, signal);
        pthread_sigmask(SIG_BLOCK, &set_, &before_);
    }
    ~StopSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
    StopSignals(const StopSignals&) = delete;
    StopSignals& operator=(const StopSignals&) = delete;

    // Waits for a signal or for `done`; returns whether a signal came.
    bool wait(const std::atomic<bool>& done) const {
        const timespec slice{0, 100'000'000};
        while (!done)
            if (sigtimedwait(&set_, nullptr, &slice) > 0) return true;
        return false;
    }

private:
    sigset_t set_{}, before_{};
};

// Its first word must be a program, unless a shell has more to do there.
void check_launcher(const std::string& launcher) {
    const std::string first = launcher.substr(0, launcher.find(' '));
    if (first.find('=') < first.find('/'))  // exec would take it for the program
        throw Error(ErrorCode::usage, "--launcher " + first, "begin with a command, as in 'env " + first + " srun'");
    if (first.find_first_of("/'\"\\$`(){};=~") == std::string::npos)
        find_program(first, "name a command that starts others, as in --launcher 'srun --exclusive -N1 -n1'");
}

JobLimits job_limits(const ServeArguments& arguments, const std::vector<NamedToken>& tokens) {
    JobLimits limits;
    limits.queue = arguments.queue;
    limits.seconds = arguments.job_seconds;
    limits.memory = static_cast<std::size_t>(arguments.job_memory * gib);
    limits.parallel = arguments.parallel;
    limits.grace = arguments.grace;
    limits.launcher = arguments.launcher;
    limits.min_free = static_cast<std::uint64_t>(arguments.min_free * mib);
    for (const NamedToken& token : tokens) limits.owners[token.name] = token.limits;
    limits.retention.days = arguments.keep_days;
    limits.retention.jobs = arguments.keep_jobs;
    if (arguments.keep_gib) limits.retention.bytes = static_cast<std::uint64_t>(*arguments.keep_gib * gib);
    return limits;
}

// `further`: arguments of every helper.
ServiceOptions service_options(const ServeArguments& arguments, const std::string& program,
                               const std::vector<std::string>& further, const Log& log) {
    ServiceOptions options;
    options.data = folders_of(arguments.data);
    options.scenarios = scenario_folders();
    options.state = fs::absolute(arguments.state);
    options.limits.body = static_cast<std::size_t>(arguments.body * mib);
    options.limits.resolution = arguments.resolution;
    options.limits.samples_per_pixel = arguments.samples;
    options.limits.bytes = arguments.job_memory * gib;
    options.limits.seconds = arguments.estimate_seconds;
    options.waiting = std::max<std::size_t>(1, arguments.workers / 4);
    options.event_streams = arguments.event_clients;
    options.log = log;
    options.pace = bench::measure_pace();
    options.start_helper = [program, further](std::vector<std::string> words) {
        words.insert(words.end(), further.begin(), further.end());
        return start_process(program, words, static_cast<std::size_t>(helper_memory * gib));
    };
    return options;
}

HttpOptions http_options(const ServeArguments& arguments, const std::vector<NamedToken>& tokens, const Log& log) {
    HttpOptions options;
    options.host = arguments.host;
    options.port = arguments.port;
    options.workers = arguments.workers;
    options.log = log;
    options.base_path = arguments.base_path;
    for (const NamedToken& token : tokens) options.tokens.push_back({token.name, token.token});
    return options;
}

Log log_to(std::ostream& err, const ServeArguments& arguments) {
    const std::string& level = arguments.log_level;
    return make_log(err, arguments.log_format == "json" ? LogFormat::json : LogFormat::text,
                    level == "debug"     ? LogLevel::debug
                    : level == "info"    ? LogLevel::info
                    : level == "warning" ? LogLevel::warning
                                         : LogLevel::error);
}

}  // namespace

void serve_command(const ServeArguments& arguments, std::ostream& out, std::ostream& err) {
    const StopSignals signals;
    std::signal(SIGPIPE, SIG_IGN);  // writing to a closed connection is an error, not a signal
    const HeldProgram held;
    const std::string program = held.path();
    if (!arguments.launcher.empty()) check_launcher(arguments.launcher);
    const Log log = log_to(err, arguments);
    const std::vector<NamedToken> tokens =
        arguments.token_file.empty() ? std::vector<NamedToken>() : read_tokens(arguments.token_file);
    const HttpOptions http = http_options(arguments, tokens, log);
    LibraryArguments libraries{{}, true, arguments.call_seconds};
    if (!arguments.libraries.empty()) libraries.files = libraries_in(arguments.libraries);
    load_libraries(libraries);
    for (const UnusableLibrary& library : part_unusable(libraries))
        say(log, {LogLevel::warning,
                  "server",
                  "a library of techniques cannot be used",
                  {{"file", library.file}, {"reason", library.reason}}});
    const std::vector<std::string> further = library_arguments(libraries);
    const ServiceOptions options = service_options(arguments, program, further, log);
    std::vector<std::string> data;
    for (const fs::path& folder : options.data) data.push_back(folder.string());
    // Another machine knows nothing of files that this process holds open.
    Jobs jobs(arguments.state, arguments.launcher.empty() ? program : this_program(), data,
              job_limits(arguments, tokens), log, {further, hash_of_libraries()});
    Service service(jobs, options);
    HttpServer server(service, options.event_streams, http);
    if (!arguments.port_file.empty()) base::write_files({{arguments.port_file, fmt::format("{}\n", server.port())}});
    out << fmt::format("shadowbench serves {} (state: {})\n", server.url(), arguments.state) << std::flush;
    say(log, {LogLevel::info,
              "server",
              "started",
              {{"url", server.url()}, {"state", arguments.state}, {"pace", options.pace}}});
    notify_manager("READY=1");
    std::atomic<bool> done = false;
    std::thread stopper([&] {
        if (!signals.wait(done)) return;
        notify_manager(
            fmt::format("STOPPING=1\nEXTEND_TIMEOUT_USEC={:.0f}", (arguments.grace + seconds_after_grace) * 1e6));
        say(log, {LogLevel::info, "server", "stopping"});
        jobs.stop();  // the server answers clients meanwhile
        server.stop();
    });
    server.run();
    done = true;
    stopper.join();
    jobs.stop();
    out << "stopped\n";
}

void backup_command(const StateArguments& arguments, std::ostream& out) {
    const std::size_t jobs = back_up(arguments.state, arguments.backup);
    out << fmt::format("{}: {} jobs\n", arguments.backup, jobs);
}

void fsck_command(const StateArguments& arguments, std::ostream& out) {
    const std::vector<std::string> faults = check_state(arguments.state);
    for (const std::string& fault : faults) out << fault << '\n';
    if (!faults.empty())
        throw Error(ErrorCode::bad_input, arguments.state,
                    fmt::format("{} {} found", faults.size(), faults.size() == 1 ? "fault" : "faults"));
    out << fmt::format("{}: no faults\n", arguments.state);
}

void guard_command(const GuardArguments& arguments, std::ostream& out, std::ostream& err) {
    ChildLimits limits;
    limits.seconds = arguments.seconds;
    limits.memory = arguments.memory;
    guard_job(arguments.words.front(), {arguments.words.begin() + 1, arguments.words.end()}, limits, arguments.silence,
              out, err);
}

void examine_command(const HelperArguments& arguments, std::ostream& out) {
    load_libraries(arguments.libraries);
    examine_lines(folders_of(arguments.data), arguments.pace, std::cin, out);
}

void curves_command(const HelperArguments& arguments, std::ostream& out) {
    load_libraries(arguments.libraries);
    curve_lines(folders_of(arguments.data), arguments.light, arguments.variant, std::cin, out);
}

}  // namespace shadowbench::service
