#include "render/image_file.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "base/error.h"
#include "render/display.h"

namespace shadowbench::render {
namespace {

// `values` holds three values of `type` a pixel.
std::string encode(const char* format, const OIIO::ImageSpec& spec, OIIO::TypeDesc type, const void* values) {
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format);
    if (!output)
        throw base::Error(base::ErrorCode::io, "", std::string("OpenImageIO cannot write ") + format + " files here");
    OIIO::Filesystem::IOVecOutput bytes;
    // The file name only selects the format: everything is written to `bytes`.
    const std::string name = std::string("picture.") + format;
    if (!output->set_ioproxy(&bytes) || !output->open(name, spec) || !output->write_image(type, values) ||
        !output->close())
        throw base::Error(base::ErrorCode::io, "", "OpenImageIO cannot encode a picture: " + output->geterror());
    return {bytes.buffer().begin(), bytes.buffer().end()};
}

}  // namespace

std::string encode_exr(const Image& image) {
    OIIO::ImageSpec spec(image.width, image.height, 3, OIIO::TypeDesc::HALF);
    spec.attribute("compression", "zip");
    spec.attribute("oiio:ColorSpace", "lin_srgb");
    spec.attribute("DateTime", "1970:01:01 00:00:00");  // fixed: the library would write the current time
    return encode("exr", spec, OIIO::TypeDesc::FLOAT, image.pixels.data());
}

std::string encode_png(const Image& image) {
    std::vector<std::uint8_t> values;
    values.reserve(image.pixels.size() * 3);
    for (const base::Vec3f& pixel : image.pixels)
        for (int c = 0; c < 3; ++c) {
            const double value = pixel[c] > 0.0f ? std::min<double>(pixel[c], 1.0) : 0.0;
            values.push_back(static_cast<std::uint8_t>(std::lround(255.0 * to_display(value))));
        }
    OIIO::ImageSpec spec(image.width, image.height, 3, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    return encode("png", spec, OIIO::TypeDesc::UINT8, values.data());
}

}  // namespace shadowbench::render
