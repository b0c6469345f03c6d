// Fuzz targets: one a reader. A target takes any bytes as the reader's input and returns when the reader refuses them
// with Error, or gives what its header documents. Everything else leaves it as an exception, or ends the process.
#pragma once

#include <filesystem>
#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>

#include "base/error.h"
#include "temporary_folder.h"

namespace shadowbench::fuzz {

// One a file in targets/, and a folder of the same name in corpus/.
void alpha(std::string_view bytes);
void command_line(std::string_view bytes);
void deep_file(std::string_view bytes);
void deep_image(std::string_view bytes);
void functions(std::string_view bytes);
void hair(std::string_view bytes);
void obj(std::string_view bytes);
void ply(std::string_view bytes);
void raw_volume(std::string_view bytes);
void request_head(std::string_view bytes);
void result(std::string_view bytes);
void scenario(std::string_view bytes);
void technique(std::string_view bytes);
void tressfx(std::string_view bytes);
void vdb(std::string_view bytes);

// The bytes as a file, for as long as this lives.
class InputFile {
public:
    InputFile(std::string_view bytes, const std::string& extension);

    const std::filesystem::path& path() const { return path_; }

private:
    const TemporaryFolder folder_;
    const std::filesystem::path path_;
};

// Takes what a reader documents: an Error of one of these codes, whose text is one printable line that names a place.
void attempt(std::initializer_list<base::ErrorCode> codes, const std::function<void()>& read);

// The front of an input, taken off it: 0 in the bits that it is too short for.
template <typename T>
T take(std::string_view& bytes) {
    T value{};
    const std::size_t count = bytes.copy(reinterpret_cast<char*>(&value), sizeof value);
    bytes.remove_prefix(count);
    return value;
}
std::string_view take_line(std::string_view& bytes);

}  // namespace shadowbench::fuzz
