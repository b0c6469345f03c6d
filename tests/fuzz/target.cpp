#include "fuzz/target.h"

#include <algorithm>
#include <fstream>

#include "fuzz/expect.h"

namespace shadowbench::fuzz {

InputFile::InputFile(std::string_view bytes, const std::string& extension)
    : path_(folder_.path() / ("input" + extension)) {
    std::ofstream stream(path_, std::ios::binary);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    expect(bool(stream), "the input can be written to a file");
}

void attempt(std::initializer_list<base::ErrorCode> codes, const std::function<void()>& read) {
    try {
        read();
    } catch (const base::Error& error) {
        const std::string_view line = error.what();
        expect(std::find(codes.begin(), codes.end(), error.code()) != codes.end(), line);
        expect(!error.message().empty(), "an error says what is wrong");
        const auto control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
        expect(std::none_of(line.begin(), line.end(), control), "an error is one printable line");
    }
}

std::string_view take_line(std::string_view& bytes) {
    const std::size_t end = std::min(bytes.find('\n'), bytes.size());
    const std::string_view line = bytes.substr(0, end);
    bytes.remove_prefix(std::min(end + 1, bytes.size()));
    return line;
}

}  // namespace shadowbench::fuzz
