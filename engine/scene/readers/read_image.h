// Opens images with OpenImageIO and reports its failures as Error, for all readers of images.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <OpenImageIO/imageio.h>

namespace shadowbench::scene {

// PNG, JPEG, TIFF, OpenEXR, DDS and TGA. Throws Error: no_such_file, io, or bad_input for other files and damaged ones.
std::unique_ptr<OIIO::ImageInput> open_image(const std::filesystem::path& file);

// The index of the channel that holds alpha, or -1.
int alpha_channel(const OIIO::ImageSpec& spec);

// Throws Error{bad_input}, place the file; the message does not name the file.
[[noreturn]] void refuse_image(const std::filesystem::path& file, const std::string& message);

}  // namespace shadowbench::scene
