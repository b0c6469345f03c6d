#include "scene/readers/file_reader.h"

#include <bit>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "scene/limits.h"

namespace shadowbench::scene {

static_assert(std::endian::native == std::endian::little, "values are read as they lie in little-endian files");

using base::Error;
using base::ErrorCode;

FileReader::FileReader(std::filesystem::path file) : file_(std::move(file)) {
    std::error_code fault;
    if (!std::filesystem::exists(file_, fault))
        throw Error(ErrorCode::no_such_file, file_.string(), "there is no such file");
    size_ = std::filesystem::file_size(file_, fault);
    if (fault) throw Error(ErrorCode::io, file_.string(), "cannot be read: " + fault.message());
    stream_.open(file_, std::ios::binary);
    if (!stream_) throw Error(ErrorCode::io, file_.string(), "cannot be opened");
}

void FileReader::seek(std::uint64_t offset, const char* what) {
    if (offset > size_) fail(size_, fmt::format("the file ends before the {} at byte {}", what, offset));
    stream_.seekg(static_cast<std::streamoff>(offset));
    position_ = offset;
}

void FileReader::need(std::uint64_t count, std::uint64_t bytes, const char* what) const {
    if (count > (size_ - position_) / bytes)
        fail(position_, fmt::format("the file is too short: {} x {} bytes of {} begin here, and it ends at byte {}",
                                    count, bytes, what, size_));
}

std::string FileReader::text(std::uint64_t bytes, const char* what) {
    need(bytes, 1, what);
    std::string result(static_cast<std::size_t>(bytes), '\0');
    read(result.data(), result.size(), what);
    return result;
}

void FileReader::fail(std::uint64_t offset, const std::string& message) const {
    throw Error(ErrorCode::bad_input, fmt::format("{}: byte {}", file_.string(), offset), message);
}

void FileReader::check_finite(const std::vector<float>& values, std::uint64_t offset, const char* what) const {
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!(std::abs(values[i]) <= static_cast<float>(max_coordinate)))
            fail(offset + i * sizeof(float),
                 fmt::format("{}: {} is not a finite number below {}", what, values[i], max_coordinate));
}

void FileReader::read(void* to, std::size_t bytes, const char* what) {
    need(bytes, 1, what);
    stream_.read(static_cast<char*>(to), static_cast<std::streamsize>(bytes));
    if (!stream_) throw Error(ErrorCode::io, fmt::format("{}: byte {}", file_.string(), position_), "reading failed");
    position_ += bytes;
}

}  // namespace shadowbench::scene
