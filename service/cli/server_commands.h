// The commands around the service, once their arguments are read. Each throws base::Error.
#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

namespace shadowbench::service {

struct ServeArguments {
    std::string host = "127.0.0.1";
    int port = 8080;         // 0: any that is free
    std::string port_file;   // written once it listens; empty: none
    std::string token_file;  // empty: no token
    std::string state = "results/service";
    std::vector<std::string> data;  // folders
    double grace = 10.0;            // seconds that a job in work has to end when the server stops
    std::size_t queue = 2000;
    int parallel = 1;                               // jobs at a time
    double job_seconds = 3600.0, job_memory = 8.0;  // GiB
    double estimate_seconds = 1800.0;
    int resolution = 4096, samples = 4096;
    double body = 4.0;  // MiB
    std::size_t workers = 32, event_clients = 64;
};

struct SubmitArguments {
    std::string scenario;          // a path, or a name in the scenario folders
    std::vector<std::string> set;  // path=value
    std::string server = "http://127.0.0.1:8080";
    std::string token_file;
    bool wait = false, fresh = false, no_pictures = false;
};

struct HelperArguments {
    std::vector<std::string> data;
    std::string light;
    std::size_t variant = 0;
};

// Until SIGTERM or SIGINT. What else its watcher should know goes to `err`, a line each: see Jobs.
void serve_command(const ServeArguments& arguments, std::ostream& out, std::ostream& err);
// Whether every technique kept its promises, as far as it was waited for.
bool submit_command(const SubmitArguments& arguments, std::ostream& out, std::ostream& err);
// The server's helpers: see service/api/helper_side.h.
void examine_command(const HelperArguments& arguments, std::ostream& out);
void curves_command(const HelperArguments& arguments, std::ostream& out);

// The first line of a file, which nobody else may be able to read. Throws Error: no_such_file, io, bad_input when it is
// empty, has spaces, or is open to others.
std::string read_token(const std::string& file);

}  // namespace shadowbench::service
