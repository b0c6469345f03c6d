// Reads a binary file front to back. The place of every Error is "file: byte 17", counted from 0. Nothing is allocated
// before the file is known to be long enough for it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <type_traits>
#include <vector>

namespace shadowbench::scene {

class FileReader {
public:
    // Throws Error{no_such_file} or Error{io}.
    explicit FileReader(std::filesystem::path file);

    std::uint64_t size() const { return size_; }
    std::uint64_t position() const { return position_; }

    void seek(std::uint64_t offset, const char* what);

    // Reads values in the file's own byte order; `what` names them in the message if the file is too short.
    template <typename T>
    T value(const char* what) {
        static_assert(std::is_trivially_copyable_v<T>);
        T result;
        read(&result, sizeof(T), what);
        return result;
    }

    template <typename T>
    std::vector<T> array(std::uint64_t count, const char* what) {
        static_assert(std::is_trivially_copyable_v<T>);
        need(count, sizeof(T), what);
        std::vector<T> result(static_cast<std::size_t>(count));
        read(result.data(), result.size() * sizeof(T), what);
        return result;
    }

    // The next `bytes` bytes.
    std::string text(std::uint64_t bytes, const char* what);

    // Throws unless at least `count` items of `bytes` bytes each are left to read.
    void need(std::uint64_t count, std::uint64_t bytes, const char* what) const;

    // Throws Error{bad_input} at an offset.
    [[noreturn]] void fail(std::uint64_t offset, const std::string& message) const;

    // Throws at the first value that is not finite or is beyond max_coordinate; the array begins at `offset`.
    void check_finite(const std::vector<float>& values, std::uint64_t offset, const char* what) const;

private:
    void read(void* to, std::size_t bytes, const char* what);

    std::filesystem::path file_;
    std::ifstream stream_;
    std::uint64_t size_ = 0;
    std::uint64_t position_ = 0;
};

// Reads `count` values a block at a time, of a number that 12 divides, since the values may be vectors of 2, 3 or 4.
// Calls take(values, offset of the first one).
template <typename T, class Take>
void for_each_block(FileReader& file, std::uint64_t count, const char* what, const Take& take) {
    constexpr std::uint64_t most_at_once = 12 << 14;
    file.need(count, sizeof(T), what);
    for (std::uint64_t left = count; left > 0;) {
        const std::uint64_t at = file.position(), here = std::min(left, most_at_once);
        take(file.array<T>(here, what), at);
        left -= here;
    }
}

}  // namespace shadowbench::scene
