#include "service/api/file_answer.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

#include "base/error.h"
#include "base/hash_text.h"
#include "document/document.h"
#include "service/api/accept.h"
#include "service/api/problem.h"

namespace shadowbench::service {
namespace {

struct ByteRange {
    std::uint64_t first, length;
};

// A number that is too large becomes the largest: as the last byte of a range it means the end of the file.
bool read_number(const std::string& text, std::uint64_t& value) {
    const auto [rest, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (fault == std::errc::result_out_of_range) value = std::numeric_limits<std::uint64_t>::max();
    return fault != std::errc::invalid_argument && rest == text.data() + text.size();
}

constexpr const char* byte_unit = "bytes=";

// The range that decides about the answer; null: the whole file. A server may ignore ranges: this one ignores several
// of them, other units and, as it must (RFC 9110, 14.2), those of HEAD.
const std::string* range_of(const ApiRequest& request, const std::string& etag) {
    const std::string *range = request.header("range"), *if_range = request.header("if-range");
    if (!range || request.method == "HEAD" || (if_range && *if_range != etag)) return nullptr;
    return range->starts_with(byte_unit) && range->find(',') == std::string::npos ? range : nullptr;
}

// Reads "bytes=0-99", "bytes=100-", "bytes=-100". Nothing for a range outside of the file.
std::optional<ByteRange> read_range(const std::string& text, std::uint64_t size) {
    const std::string unit = byte_unit;
    const std::size_t dash = text.find('-');
    if (!text.starts_with(unit) || dash == std::string::npos || size == 0) return {};
    const std::string from = text.substr(unit.size(), dash - unit.size()), to = text.substr(dash + 1);
    std::uint64_t first = 0, last = size - 1;
    if (from.empty()) {
        std::uint64_t count = 0;
        if (!read_number(to, count) || count == 0) return {};
        first = count >= size ? 0 : size - count;
    } else {
        if (!read_number(from, first) || first >= size) return {};
        if (!to.empty() && (!read_number(to, last) || last < first)) return {};
        last = std::min(last, size - 1);
    }
    return ByteRange{first, last - first + 1};
}

ApiResponse not_modified(const std::string& etag) {
    ApiResponse response;
    response.status = 304;
    response.headers = {{"ETag", etag}, {"Cache-Control", "private, no-cache"}};
    return response;
}

}  // namespace

const char* type_of_file(const std::filesystem::path& file) {
    const std::string extension = file.extension().string();
    if (extension == ".json") return "application/json";
    if (extension == ".csv") return "text/csv; charset=utf-8";
    if (extension == ".png") return "image/png";
    if (extension == ".exr") return "image/x-exr";
    return "application/octet-stream";
}

ApiResponse file_answer(const ApiRequest& request, const std::filesystem::path& file) {
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0) return problem(404, "There is no such file.");
    auto open = std::make_shared<const OpenFile>(descriptor);
    struct stat status {};
    if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) return problem(404, "There is no such file.");
    const auto size = static_cast<std::uint64_t>(status.st_size);
    // Jobs rename complete files into place, so a file with this inode and time never changes.
    const std::string etag =
        fmt::format("\"{:x}-{:x}-{:x}.{:x}\"", status.st_ino, size, status.st_mtim.tv_sec, status.st_mtim.tv_nsec);
    if (has_version(request, etag)) return not_modified(etag);
    ApiResponse response;
    response.type = type_of_file(file);
    response.headers = {{"ETag", etag}, {"Cache-Control", "private, no-cache"}, {"Accept-Ranges", "bytes"}};
    response.file = FilePart{std::move(open), 0, size};
    const std::string* range = range_of(request, etag);
    if (!range) return response;
    const std::optional<ByteRange> part = read_range(*range, size);
    if (!part) {
        response = problem(416, "Range must be a range of bytes within the file.");
        response.headers.push_back({"Content-Range", fmt::format("bytes */{}", size)});
        return response;
    }
    response.status = 206;
    response.file->offset = part->first;
    response.file->length = part->length;
    response.headers.push_back(
        {"Content-Range", fmt::format("bytes {}-{}/{}", part->first, part->first + part->length - 1, size)});
    return response;
}

ApiResponse text_answer(const ApiRequest& request, const std::string& type, std::string text) {
    const std::string etag = "\"" + base::hash_text(text) + "\"";
    if (has_version(request, etag)) return not_modified(etag);
    ApiResponse response;
    response.type = type;
    response.headers = {{"ETag", etag}, {"Cache-Control", "private, no-cache"}};
    response.body = std::move(text);
    return response;
}

std::string read_all(const FilePart& part) {
    std::string bytes(part.length, '\0');
    for (std::size_t got = 0; got < bytes.size();) {
        const ssize_t n = ::pread(part.file->descriptor, bytes.data() + got, bytes.size() - got,
                                  static_cast<off_t>(part.offset + got));
        if (n <= 0) throw base::Error(base::ErrorCode::io, "result", "cannot read");
        got += static_cast<std::size_t>(n);
    }
    return bytes;
}

}  // namespace shadowbench::service
