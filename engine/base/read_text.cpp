#include "base/read_text.h"

#include <fstream>
#include <iterator>

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
    try {
        return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    } catch (const std::ios_base::failure&) {  // from the buffer, whatever the stream's exceptions() are
        throw Error(ErrorCode::io, file.string(), "cannot read the file");
    }
}

std::string read_text(const std::filesystem::path& file) {
    std::string text = read_bytes(file);
    const std::size_t mark = text.size() - without_mark(text, file.string()).size();
    text.erase(0, mark);
    return text;
}

}  // namespace shadowbench::base
