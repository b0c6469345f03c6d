// Reads a PLY file as a header and a stream of numbers, whatever its encoding. Holds a part of it at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/readers/file_reader.h"
#include "scene/readers/unpacked_bytes.h"

namespace shadowbench::scene {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;
    bool is_list = false;
    PlyType count_type = PlyType::uint8;  // for a list
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
};

class PlySource {
public:
    // Reads the header. Unpacks a file whose extension is .gz. Throws Error: no_such_file, io, bad_input.
    explicit PlySource(const std::filesystem::path& file);

    const std::vector<PlyElement>& elements() const { return elements_; }

    // Throws unless the rest of the file can hold the element. Call it before memory is allocated for the element.
    void check_length(const PlyElement& element) const;

    // The most elements that the rest of the file can hold, if each of their lists has `items` items.
    std::uint64_t most_of(const PlyElement& element, std::uint64_t items) const;

    // The next number; it may be any float, including NaN.
    double value(PlyType type);
    // The count at the head of a list: at most as many items as the rest of the file can hold.
    std::uint64_t list_size(const PlyProperty& property);
    void skip(const PlyProperty& property);

    // After the last element: throws if a packed file is damaged in what follows.
    void finish();

    // Throws Error{bad_input} at the line of what was read last, or at the next byte of binary numbers.
    [[noreturn]] void fail(const std::string& message) const;

private:
    enum class Encoding { ascii, little_endian, big_endian };

    std::string line();
    void find_line_end();
    void read_header();
    void read_property(const std::string& words);
    // The least number of bytes of a value.
    std::uint64_t least_bytes(PlyType type) const;
    std::uint64_t left() const { return size_ - begin_ - position_; }
    bool is_text() const { return in_header_ || encoding_ == Encoding::ascii; }

    // Reads more into the window, and drops what has been passed; false at the end of the file.
    bool fill();
    // The place in the window of the next character that is wanted, or of the end of the file.
    template <class Wanted>
    std::size_t find(const Wanted& wanted);

    std::string file_;
    FileReader reader_;
    bool packed_;
    std::uint64_t size_;  // of the file, unpacked
    UnpackedBytes bytes_;
    std::string window_;                   // a part of the file
    std::uint64_t begin_ = 0;              // of the window, in the file
    std::uint64_t lines_ = 0;              // in front of the window
    std::size_t position_ = 0, last_ = 0;  // in the window; last_: of the line or number that was read last
    bool in_header_ = true;
    char line_end_ = '\n';  // '\r' for CR; also '\n' for CR LF
    Encoding encoding_ = Encoding::ascii;
    std::vector<PlyElement> elements_;
};

}  // namespace shadowbench::scene
