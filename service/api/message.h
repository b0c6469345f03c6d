// Requests and responses of the API: the content of HTTP messages, without sockets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace shadowbench::service {

struct Field {
    std::string name, value;
};

struct ApiRequest {
    std::string method;             // as sent
    std::vector<std::string> path;  // segments, each decoded: "/v1/jobs" is {"v1", "jobs"}; "/" is {""}
    std::vector<Field> query;       // decoded
    std::vector<Field> headers;     // names in lower case
    bool has_body = false;          // known before the body is read
    std::string body;
    std::string id = {};      // names it in the log and in the answer
    std::string client = {};  // the name of the token that it came with; empty: the server has no named tokens
    std::string prefix = {};  // where the server appears below its host, as "/lab"; links begin with it

    // The value of the first field of this name; null where there is none.
    const std::string* header(const std::string& lower_name) const;
    const std::string* parameter(const std::string& name) const;
};

// A part of an open regular file. It stays complete when the file is renamed or removed.
struct OpenFile {
    explicit OpenFile(int open) : descriptor(open) {}
    ~OpenFile();
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;
    const int descriptor;
};
struct FilePart {
    std::shared_ptr<const OpenFile> file;
    std::uint64_t offset = 0, length = 0;
};

// A source of server-sent events. Each call blocks for a second at most and gives text to send, which may be empty;
// nothing at the end of the stream.
using EventSource = std::function<std::optional<std::string>()>;

struct ApiResponse {
    int status = 200;
    std::string type;  // media type; empty: no content
    std::vector<Field> headers;
    std::string body;
    std::optional<FilePart> file;  // instead of the body
    EventSource events;            // instead of the body

    const std::string* header(const std::string& name) const;  // `name` is case-sensitive
};

}  // namespace shadowbench::service
