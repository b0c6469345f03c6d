#include "render/deep_exr.h"

#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>

#include <memory>

#include "base/error.h"
#include "base/pending_file.h"

namespace shadowbench::render {
namespace {

OIIO::ImageSpec make_spec(int width, int height, int channels, const std::string& text) {
    std::vector<std::string> names{"A"};
    if (channels == 3) names = {"A", "AB", "AG", "AR"};
    names.insert(names.end(), {"Z", "ZBack"});
    OIIO::ImageSpec spec(width, height, static_cast<int>(names.size()), OIIO::TypeDesc::FLOAT);
    spec.deep = true;
    spec.channelnames = std::move(names);
    spec.alpha_channel = 0;
    spec.z_channel = spec.channelindex("Z");
    spec.attribute("compression", "zips");  // the only zip for deep scanlines
    spec.attribute("ImageDescription", text);
    spec.attribute("Software", "shadowbench");
    spec.attribute("DateTime", "1970:01:01 00:00:00");  // fixed, so that the same samples give the same bytes
    return spec;
}

template <class Visit>
void for_each_pixel(int width, const DeepBlock& block, const Visit& visit) {
    for (int y = 0; y < block.height; ++y)
        for (int x = 0; x < block.width; ++x) {
            const std::size_t p = static_cast<std::size_t>(y) * block.width + x;
            visit(static_cast<std::int64_t>(block.y0 + y) * width + block.x0 + x, block.begin[p], block.begin[p + 1]);
        }
}

void fill(int width, const DeepBlock& block, const OIIO::ImageSpec& spec, OIIO::DeepData& data) {
    const int a = spec.channelindex("A"), z = spec.channelindex("Z"), z_back = spec.channelindex("ZBack");
    const int rgb[3] = {spec.channelindex("AR"), spec.channelindex("AG"), spec.channelindex("AB")};
    for_each_pixel(width, block, [&](std::int64_t pixel, std::uint64_t begin, std::uint64_t end) {
        for (std::uint64_t s = begin; s < end; ++s) {
            const int i = static_cast<int>(s - begin);
            data.set_deep_value(pixel, z, i, block.z_front[s]);
            data.set_deep_value(pixel, z_back, i, block.z_back[s]);
            const float* alpha = &block.alpha[s * static_cast<std::uint64_t>(block.channels)];
            data.set_deep_value(pixel, a, i, block.channels == 3 ? (alpha[0] + alpha[1] + alpha[2]) / 3.0f : alpha[0]);
            for (int c = 0; c < 3 && block.channels == 3; ++c) data.set_deep_value(pixel, rgb[c], i, alpha[c]);
        }
    });
}

}  // namespace

void write_deep_exr(const std::filesystem::path& file, int width, int height, std::span<const DeepBlock> blocks,
                    const std::string& text) {
    const OIIO::ImageSpec spec = make_spec(width, height, blocks.empty() ? 1 : blocks[0].channels, text);
    OIIO::DeepData data;
    data.init(spec);
    for (const DeepBlock& block : blocks)  // all sample counts first: a later change would move the samples behind it
        for_each_pixel(width, block, [&](std::int64_t pixel, std::uint64_t begin, std::uint64_t end) {
            data.set_samples(pixel, static_cast<int>(end - begin));
        });
    for (const DeepBlock& block : blocks) fill(width, block, spec, data);

    base::PendingFile pending(file);
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("exr");
    if (!output || !output->open(pending.temporary().string(), spec) || !output->write_deep_image(data) ||
        !output->close())
        throw base::Error(base::ErrorCode::io, file.string(),
                          "cannot write the image: " + (output ? output->geterror() : OIIO::geterror()));
    pending.commit();
}

}  // namespace shadowbench::render
