// Fuzz targets, one for each reader. A target takes any bytes as the reader's input. It returns if the reader refuses
// them with Error, or gives what its header documents. Any other outcome leaves it as an exception or ends the process.
#pragma once

#include <filesystem>
#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>

#include "base/error.h"
#include "temporary_folder.h"

namespace shadowbench::fuzz {

// Each has a file in targets/ and a folder of the same name in corpus/.
void alpha(std::string_view bytes);
void command_line(std::string_view bytes);
void dds_volume(std::string_view bytes);
void deep_file(std::string_view bytes);
void deep_image(std::string_view bytes);
void functions(std::string_view bytes);
void gltf(std::string_view bytes);
void hair(std::string_view bytes);
void metaimage(std::string_view bytes);
void mitsuba_hair(std::string_view bytes);
void mitsuba_volume(std::string_view bytes);
void nanovdb(std::string_view bytes);
void nrrd(std::string_view bytes);
void obj(std::string_view bytes);
void pbrt(std::string_view bytes);
void ply(std::string_view bytes);
void pvm(std::string_view bytes);
void raw_volume(std::string_view bytes);
void request_head(std::string_view bytes);
void result(std::string_view bytes);
void scenario(std::string_view bytes);
void slc(std::string_view bytes);
void stl(std::string_view bytes);
void technique(std::string_view bytes);
void tressfx(std::string_view bytes);
void vdb(std::string_view bytes);

// The bytes as a file, which exists as long as this object.
class InputFile {
public:
    InputFile(std::string_view bytes, const std::string& extension);

    const std::filesystem::path& path() const { return path_; }

private:
    const TemporaryFolder folder_;
    const std::filesystem::path path_;
};

// Calls `read`, and accepts an Error with one of these codes, whose text must be one printable line that names a place.
void attempt(std::initializer_list<base::ErrorCode> codes, const std::function<void()>& read);

// Takes a value off the front of an input. Bits that the input is too short for are 0.
template <typename T>
T take(std::string_view& bytes) {
    T value{};
    const std::size_t count = bytes.copy(reinterpret_cast<char*>(&value), sizeof value);
    bytes.remove_prefix(count);
    return value;
}
std::string_view take_line(std::string_view& bytes);

}  // namespace shadowbench::fuzz
