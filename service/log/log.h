// What the server says to its operator: one line an event, as text or as JSON.
#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <string>
#include <variant>
#include <vector>

namespace shadowbench::service {

enum class LogLevel { debug, info, warning, error };
enum class LogFormat { text, json };

struct LogField {
    std::string name;
    std::variant<std::string, std::int64_t, double> value;
};

struct LogEvent {
    LogLevel level = LogLevel::info;
    std::string kind;     // "request", "job", "storage", "recovery", "fault", "server"
    std::string message;  // a sentence or a word; may have any bytes
    std::vector<LogField> fields = {};
};

// Thread-safe, and throws nothing. An empty function drops all events: call it through say().
using Log = std::function<void(const LogEvent& event)>;

// Writes events of this level and above, a line each:
//   2026-11-25T01:02:03.004Z info request status=200 path=/v1/jobs
//   {"time":"2026-11-25T01:02:03.004Z","level":"info","event":"request","message":"","status":200,"path":"/v1/jobs"}
// Values that came from clients are quoted and escaped, so that none can begin a line of its own. `to` outlives the
// log.
Log make_log(std::ostream& to, LogFormat format, LogLevel least);

inline void say(const Log& log, const LogEvent& event) {
    if (log) log(event);
}

}  // namespace shadowbench::service
