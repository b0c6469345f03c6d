// What the readers of images share: OpenImageIO behind Error.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <OpenImageIO/imageio.h>

namespace shadowbench::scene {

// PNG, JPEG, TIFF, OpenEXR, DDS and TGA. Throws Error: no_such_file, io, or bad_input for other files and damaged ones.
std::unique_ptr<OIIO::ImageInput> open_image(const std::filesystem::path& file);

// Throws Error{bad_input} with the file as place, and nowhere else in the message.
[[noreturn]] void refuse_image(const std::filesystem::path& file, const std::string& message);

}  // namespace shadowbench::scene
