// The commands of the server and its clients, with their parsed arguments. Each throws base::Error.
#pragma once

#include <cstddef>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "service/cli/commands.h"

namespace shadowbench::service {

struct ServeArguments {
    std::string host = "127.0.0.1";
    int port = 8080;         // 0: any free port
    std::string port_file;   // written once the server listens; empty: none
    std::string token_file;  // empty: no token
    std::string state = "results/service";
    std::vector<std::string> data;  // folders
    std::string libraries;          // folder of libraries of techniques; empty: none
    double call_seconds = 60.0;     // that one call of such a technique may take
    double grace = 10.0;            // seconds that a running job may take to finish when the server stops
    std::size_t queue = 2000;
    int parallel = 1;                               // jobs at a time
    std::string launcher;                           // words of a shell; empty: none
    double job_seconds = 3600.0, job_memory = 8.0;  // GiB
    double estimate_seconds = 1800.0;
    int resolution = 4096, samples = 4096;
    double body = 4.0;        // MiB
    double min_free = 512.0;  // MiB
    std::size_t workers = 32, event_clients = 64;
    std::string base_path;  // where the server appears below its host
    std::string log_format = "text", log_level = "info";
    std::optional<double> keep_days, keep_gib;
    std::optional<std::size_t> keep_jobs;
};

struct StateArguments {
    std::string state = "results/service";
    std::string backup;  // the folder to copy to
};

struct SubmitArguments {
    std::string scenario;          // a path, or the name of one in the scenario folders
    std::vector<std::string> set;  // path=value
    std::string server = "http://127.0.0.1:8080";
    std::string token_file;
    std::string cacert;  // a file of certificates; empty: those of the system
    std::vector<std::string> labels;
    int priority = 0;
    bool wait = false, fresh = false, no_pictures = false;
    std::optional<double> recommend;  // the error to ask a recommendation for
    std::string budget;               // of the recommendation, with a unit; empty: the server's usual one
};

struct HelperArguments {
    std::vector<std::string> data;
    LibraryArguments libraries;
    std::string light;
    std::size_t variant = 0;
    double pace = 1.0;  // as in helper_side.h
};

struct GuardArguments {
    double seconds = 3600.0;
    double silence = 0.0;            // of the server
    std::size_t memory = 0;          // bytes
    std::vector<std::string> words;  // of the command that it runs
};

// Runs until SIGTERM or SIGINT. The log goes to `err`.
void serve_command(const ServeArguments& arguments, std::ostream& out, std::ostream& err);
// Returns whether every technique kept its promises; true without --wait.
bool submit_command(const SubmitArguments& arguments, std::ostream& out, std::ostream& err);
void backup_command(const StateArguments& arguments, std::ostream& out);
// Throws Error{bad_input} where it finds faults, which it prints.
void fsck_command(const StateArguments& arguments, std::ostream& out);
// The helpers of the server: see service/api/helper_side.h.
// What a launcher starts on another machine: see service/jobs/launched.h.
void guard_command(const GuardArguments& arguments, std::ostream& out, std::ostream& err);
void examine_command(const HelperArguments& arguments, std::ostream& out);
void curves_command(const HelperArguments& arguments, std::ostream& out);

}  // namespace shadowbench::service
