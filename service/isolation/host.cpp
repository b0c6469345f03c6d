#include "service/isolation/host.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "service/isolation/content.h"
#include "service/process/descriptor.h"
#include "techniques/external/library.h"

namespace shadowbench::service {
namespace {

using base::Error;
using base::ErrorCode;

// Returns false at the end of the connection.
bool read_all(int line, void* to, std::size_t size) {
    char* at = static_cast<char*>(to);
    while (size > 0) {
        const ssize_t count = ::read(line, at, size);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        at += count;
        size -= static_cast<std::size_t>(count);
    }
    return true;
}

bool write_all(int line, const void* from, std::size_t size) {
    const char* at = static_cast<const char*>(from);
    while (size > 0) {
        const ssize_t count = ::send(line, at, size, MSG_NOSIGNAL);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        at += count;
        size -= static_cast<std::size_t>(count);
    }
    return true;
}

// The library and its one map.
class Hosted {
public:
    Hosted(std::string file, std::string hash) : file_(std::move(file)), hash_(std::move(hash)) {}

    MessageWriter answer(Request request, MessageReader& from) {
        MessageWriter to;
        switch (request) {
            case Request::describe:
                open();
                to.put(static_cast<std::uint64_t>(open_->techniques.size()));
                for (const techniques::Outside& technique : open_->techniques) put(to, technique.description);
                break;
            case Request::error_bound:
            case Request::least_bytes:
            case Request::create:
                ask_technique(request, from, to);
                break;
            case Request::destroy:
                map_.reset();
                break;
            case Request::add:
                map().add(get_rays(from));
                break;
            case Request::finish:
                map().finish();
                break;
            case Request::lookup:
                look_up(from, to);
                break;
            case Request::bytes:
                to.put(map().bytes());
                break;
            case Request::nodes:
                put(to, map().nodes());
                break;
            case Request::stored:
                give_stored(from, to);
                break;
        }
        return to;
    }

private:
    techniques::MapCalls& map() {
        if (!map_) throw Error(ErrorCode::internal, "", "there is no map");
        return *map_;
    }
    void ask_technique(Request request, MessageReader& from, MessageWriter& to) {
        if (!open_) open();
        techniques::TechniqueCalls& calls = *open_->techniques.at(from.get<std::uint64_t>()).calls;
        const techniques::ParameterValues values = get_values(from);
        const auto layout = from.get<rays::MapLayout>();
        if (request == Request::error_bound) to.put(calls.error_bound(values, layout));
        if (request == Request::least_bytes) to.put(calls.least_bytes(values, layout));
        if (request == Request::create) map_ = calls.create(values, layout);
    }
    void look_up(MessageReader& from, MessageWriter& to) {
        from.get_list(queries_);
        from.get_list(footprints_);
        from.get_list(visibility_);
        map().lookup(queries_, footprints_, visibility_);
        to.put_list(std::span<const float>(visibility_));
    }
    void give_stored(MessageReader& from, MessageWriter& to) {
        const int x = from.get<int>(), y = from.get<int>();
        from.get_list(depths_);
        map().stored(x, y, depths_, curve_);
        to.put_list(std::span<const curves::Vertex>(curve_));
    }

    void open() {
        if (techniques::identify(file_).hash != hash_)
            throw Error(ErrorCode::bad_input, file_, "the file of the library has changed since it was loaded");
        open_.emplace(techniques::open_library(file_));
    }

    std::string file_, hash_;
    std::optional<techniques::OpenLibrary> open_;
    std::unique_ptr<techniques::MapCalls> map_;
    std::vector<techniques::Query> queries_;
    std::vector<techniques::Footprint> footprints_;
    std::vector<float> visibility_, depths_;
    curves::Curve curve_;
};

// Moves the connection away from the standard streams, which then lead nowhere.
int take_connection() {
    const int line = ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 3);
    const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
    if (line < 0 || nowhere < 0 || ::dup2(nowhere, STDIN_FILENO) < 0 || ::dup2(nowhere, STDOUT_FILENO) < 0)
        throw Error(ErrorCode::io, "standard input", std::strerror(errno));
    return line;
}

}  // namespace

void host_techniques(const std::string& library, const std::string& hash) {
    const Descriptor line(take_connection());
    Hosted hosted(library, hash);
    MessageHead head{static_cast<std::uint32_t>(ReplyKind::done), 0};
    if (!write_all(line.number(), &head, sizeof head)) return;  // it has started
    while (read_all(line.number(), &head, sizeof head)) {
        std::string body(head.size, '\0');
        if (!read_all(line.number(), body.data(), body.size())) return;
        MessageReader from(std::move(body));
        MessageWriter to;
        ReplyKind reply = ReplyKind::done;
        try {
            to = hosted.answer(static_cast<Request>(head.kind), from);
        } catch (const Error& error) {
            reply = ReplyKind::failed;
            to.put_text(error.message());
        }
        const MessageHead answer{static_cast<std::uint32_t>(reply), to.body().size()};
        if (!write_all(line.number(), &answer, sizeof answer) ||
            !write_all(line.number(), to.body().data(), to.body().size()))
            return;
    }
}

}  // namespace shadowbench::service
