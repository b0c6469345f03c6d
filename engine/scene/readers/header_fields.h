// Headers in text at the front of volume files: lines that give a field a value.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/readers/file_reader.h"
#include "scene/scene.h"

namespace shadowbench::scene {

// Reads a line, without its end (LF or CR LF), which the end of the file may be too; empty at the end of the file.
// Throws Error{bad_input} if it is longer than lines of headers are, or begins behind where they end.
std::optional<std::string> read_line(FileReader& file);

// Without spaces and tabs at both ends.
std::string_view trimmed(std::string_view text);

struct HeaderField {
    std::string value;
    std::uint64_t at = 0;  // byte of the file at which its line begins
};

// The fields of a header by their names. The methods throw Error{bad_input} at the line of the field.
class HeaderFields {
public:
    // Keeps a reference to the file.
    explicit HeaderFields(const FileReader& file) : file_(file) {}

    // Throws if the field is there already.
    void add(const std::string& name, std::string_view value, std::uint64_t at);

    // Null if it is not there; need() throws then.
    const HeaderField* find(std::string_view name) const;
    const HeaderField& need(std::string_view name) const;

    [[noreturn]] void fail(const HeaderField& field, const std::string& message) const;

    // Whole numbers, separated by blanks; exactly `count` of them.
    std::vector<std::int64_t> integers(const HeaderField& field, std::size_t count) const;
    // The only one, of at least `least`; without the field, `absent`.
    std::int64_t integer(std::string_view name, std::int64_t least, std::int64_t absent) const;

    // Numbers that are finite and at most max_coordinate on both sides of 0.
    std::vector<double> numbers(const HeaderField& field, std::size_t count) const;

private:
    const FileReader& file_;
    std::map<std::string, HeaderField, std::less<>> fields_;
};

// A size from three whole numbers. Throws if one is below 1 or too large for a volume.
Vec3i size_of(const HeaderFields& header, const HeaderField& field, const std::vector<std::int64_t>& sides);

// The file with the values, which a field of a header names. It must lie in the header's folder or below it, so that a
// header cannot show what other folders hold. Throws Error: bad_input, or no_such_file.
std::filesystem::path file_beside(const std::filesystem::path& header_file, const HeaderFields& header,
                                  const HeaderField& field);

}  // namespace shadowbench::scene
