#include "base/read_text.h"

#include <array>
#include <cstdint>
#include <fstream>

#include "base/error.h"
#include "base/utf8.h"

namespace shadowbench::base {

std::string read_bytes(const std::filesystem::path& file) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored))
        throw Error(ErrorCode::no_such_file, file.string(), "there is no such file");
    if (std::filesystem::is_directory(file, ignored))
        throw Error(ErrorCode::io, file.string(), "a folder cannot be read as a file");
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw Error(ErrorCode::io, file.string(), "cannot open the file");
    // A string that grows would hold the file twice at times. A pipe has no size, and some files state 0.
    std::error_code no_size;
    const std::uintmax_t size = std::filesystem::file_size(file, no_size);
    std::string content(no_size ? 0 : static_cast<std::size_t>(size), '\0');
    stream.read(content.data(), static_cast<std::streamsize>(content.size()));
    content.resize(static_cast<std::size_t>(stream.gcount()));
    std::array<char, 4096> more;
    while (stream.read(more.data(), std::streamsize{more.size()}) || stream.gcount() > 0)
        content.append(more.data(), static_cast<std::size_t>(stream.gcount()));
    if (stream.bad()) throw Error(ErrorCode::io, file.string(), "cannot read the file");
    return content;
}

std::string read_text(const std::filesystem::path& file) {
    std::string text = read_bytes(file);
    const std::size_t mark = text.size() - without_mark(text, file.string()).size();
    text.erase(0, mark);
    return text;
}

}  // namespace shadowbench::base
