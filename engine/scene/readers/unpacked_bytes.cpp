#include "scene/readers/unpacked_bytes.h"

#include <zlib.h>

#include <algorithm>

#include <fmt/format.h>

#include "base/error.h"

namespace shadowbench::scene {
namespace {

constexpr std::uint64_t chunk_bytes = 1 << 16;
constexpr std::uint64_t most_ratio = 1032;  // of deflate: bytes that one packed byte unpacks to

}  // namespace

UnpackedBytes::UnpackedBytes(FileReader& file, std::uint64_t begin, Packing packing) : file_(file), begin_(begin) {
    file_.seek(begin, "values");
    if (packing == Packing::none) return;
    stream_ = std::make_unique<z_stream_s>();
    constexpr int largest_window = 15, gzip_or_zlib = 32;
    if (inflateInit2(stream_.get(), largest_window + gzip_or_zlib) != Z_OK)
        throw base::Error(base::ErrorCode::internal, "", "zlib cannot be started");
}

UnpackedBytes::~UnpackedBytes() {
    if (stream_) inflateEnd(stream_.get());
}

void UnpackedBytes::need(std::uint64_t bytes, const char* what) const {
    if (!stream_) return file_.need(bytes, 1, what);
    const std::uint64_t packed = file_.size() - begin_;
    if (bytes / most_ratio > packed)
        file_.fail(begin_, fmt::format("the file is too short: {} packed bytes begin here, which cannot hold {} bytes "
                                       "of {}",
                                       packed, bytes, what));
}

void UnpackedBytes::read(std::span<std::uint8_t> to, const char* what) {
    const std::uint64_t from = position_;
    const std::size_t count = read_some(to);
    if (count < to.size())
        fail(from,
             fmt::format("the file is too short: {} bytes of {} should follow, and {} do", to.size(), what, count));
}

void UnpackedBytes::pass(std::uint64_t bytes, const char* what) {
    if (!stream_) {
        file_.need(bytes, 1, what);
        file_.seek(file_.position() + bytes, what);
        position_ += bytes;
        return;
    }
    std::vector<std::uint8_t> passed(static_cast<std::size_t>(std::min(bytes, chunk_bytes)));
    while (bytes > 0) {
        const std::size_t count = static_cast<std::size_t>(std::min(bytes, chunk_bytes));
        read(std::span(passed).first(count), what);
        bytes -= count;
    }
}

bool UnpackedBytes::at_end() {
    std::uint8_t next = 0;
    return read_some(std::span(&next, 1)) == 0;
}

void UnpackedBytes::fail(std::uint64_t position, const std::string& message) const {
    if (!stream_) file_.fail(begin_ + position, message);
    file_.fail(begin_, fmt::format("byte {} of what begins here, unpacked: {}", position, message));
}

std::size_t UnpackedBytes::read_some(std::span<std::uint8_t> to) {
    std::size_t count = 0;
    if (stream_) {
        count = inflate_some(to);
    } else {
        const std::uint64_t left = file_.size() - file_.position();
        const std::vector<std::uint8_t> bytes =
            file_.array<std::uint8_t>(std::min<std::uint64_t>(to.size(), left), "values");
        std::copy(bytes.begin(), bytes.end(), to.begin());
        count = bytes.size();
    }
    position_ += count;
    return count;
}

std::size_t UnpackedBytes::inflate_some(std::span<std::uint8_t> to) {
    stream_->next_out = to.data();
    stream_->avail_out = static_cast<uInt>(to.size());
    const auto done = [&] { return to.size() - stream_->avail_out; };
    while (stream_->avail_out > 0 && !ended_) {
        if (stream_->avail_in == 0 && !refill())
            fail(position_ + done(), "the packed bytes are cut short: the file ends before they do");
        const int result = inflate(stream_.get(), Z_NO_FLUSH);
        if (result == Z_STREAM_END)
            ended_ = !next_member();
        else if (result != Z_OK)
            fail(position_ + done(), fmt::format("the packed bytes are damaged, or neither gzip nor zlib: {}",
                                                 stream_->msg ? stream_->msg : "zlib cannot read them"));
    }
    return done();
}

// Gives the stream more of the file; false at its end.
bool UnpackedBytes::refill() {
    const std::uint64_t count = std::min(chunk_bytes, file_.size() - file_.position());
    if (count == 0) return false;
    packed_ = file_.array<std::uint8_t>(count, "packed values");
    stream_->next_in = packed_.data();
    stream_->avail_in = static_cast<uInt>(packed_.size());
    return true;
}

bool UnpackedBytes::next_member() {
    constexpr std::uint8_t first_of_gzip = 0x1f;
    if (stream_->avail_in == 0 && !refill()) return false;
    return *stream_->next_in == first_of_gzip && inflateReset(stream_.get()) == Z_OK;
}

std::uint64_t gzip_bytes(const std::filesystem::path& file) {
    constexpr std::uint64_t least = 18;  // a header and an end
    FileReader reader(file);
    if (reader.size() < least) reader.fail(reader.size(), "the file is too short for one that gzip has packed");
    reader.seek(reader.size() - sizeof(std::uint32_t), "size");
    return reader.value<std::uint32_t>("size");
}

std::string unpacked_file(const std::filesystem::path& file) {
    const std::uint64_t size = gzip_bytes(file);
    FileReader reader(file);
    UnpackedBytes bytes(reader, 0, Packing::deflate);
    bytes.need(size, "content");
    std::string content(static_cast<std::size_t>(size), '\0');
    bytes.read({reinterpret_cast<std::uint8_t*>(content.data()), content.size()}, "content");
    if (!bytes.at_end()) bytes.fail(size, "more content than the end of the file states");
    return content;
}

}  // namespace shadowbench::scene
