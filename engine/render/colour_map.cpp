#include "render/colour_map.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include "base/error.h"

namespace shadowbench::render {

std::vector<base::Vec3f> colour_map(const std::vector<float>& values, int width, int height) {
    const OIIO::ImageSpec spec(width, height, 1, OIIO::TypeDesc::FLOAT);
    // A copy, since the library may write to the memory that it wraps.
    std::vector<float> copy = values;
    const OIIO::ImageBuf source(spec, copy.data());
    const OIIO::ImageBuf mapped = OIIO::ImageBufAlgo::color_map(source, 0, "viridis");
    std::vector<base::Vec3f> result(values.size());
    if (mapped.has_error() || !mapped.get_pixels(mapped.roi(), OIIO::TypeDesc::FLOAT, result.data()))
        throw base::Error(base::ErrorCode::internal, "", "OpenImageIO has no colour map: " + mapped.geterror());
    return result;
}

}  // namespace shadowbench::render
