#include "render/light_map.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "bench/ray_source.h"
#include "rays/light_rays.h"

namespace shadowbench::render {
namespace {

using base::Vec2i;
using base::Vec3f;
using rays::LightRays;

Vec2i picture_size(const rays::MapLayout& layout) {
    const std::int64_t longest = std::max(layout.width, layout.height);
    const auto scaled = [&](std::int64_t side) {
        return static_cast<int>(
            longest <= longest_light_map ? side : std::max<std::int64_t>(1, side * longest_light_map / longest));
    };
    return {scaled(layout.width), scaled(layout.height)};
}

// The sum over the rays of one pixel of the tile.
Vec3f through(const LightRays& tile, std::size_t pixel) {
    const auto samples = static_cast<std::size_t>(tile.samples), channels = static_cast<std::size_t>(tile.channels);
    Vec3f sum(0.0f);
    for (std::size_t ray = pixel * samples; ray < (pixel + 1) * samples; ++ray) {
        Vec3f product(1.0f);
        for (std::size_t s = tile.begin[ray]; s < tile.begin[ray + 1]; ++s)
            for (std::size_t c = 0; c < 3; ++c)
                product[static_cast<int>(c)] *= tile.transmittance[s * channels + (channels == 1 ? 0 : c)];
        sum += product;
    }
    return sum;
}

}  // namespace

Image light_map(const bench::RaySource& source, const rays::MapLayout& layout) {
    Image image(picture_size(layout), Vec3f(0.0f));
    std::vector<std::uint32_t> rays(image.pixels.size(), 0);
    const auto place = [](std::int64_t at, int size, int of) { return static_cast<int>(at * size / of); };
    source.for_each_batch(0, [&](bench::RaySource::Batch tiles) {
        for (const LightRays& tile : tiles)
            for (int y = 0; y < tile.height; ++y)
                for (int x = 0; x < tile.width; ++x) {
                    const int column = place(tile.x0 + x, image.width, layout.width);
                    const int row = place(layout.height - 1 - (tile.y0 + y), image.height, layout.height);
                    const auto to = static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                                    static_cast<std::size_t>(column);
                    image.pixels[to] +=
                        through(tile, static_cast<std::size_t>(y) * static_cast<std::size_t>(tile.width) +
                                          static_cast<std::size_t>(x));
                    rays[to] += static_cast<std::uint32_t>(tile.samples);
                }
    });
    for (std::size_t p = 0; p < rays.size(); ++p) image.pixels[p] = image.pixels[p] / static_cast<float>(rays[p]);
    return image;
}

}  // namespace shadowbench::render
