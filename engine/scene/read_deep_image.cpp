// Deep images: Interpreting OpenEXR Deep Pixels (Hillman, Welford 2013). A sample spans Z to ZBack (Z alone: a surface)
// and takes A of the light.
#include <OpenImageIO/deepdata.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <numeric>

#include <fmt/format.h>

#include "base/error.h"
#include "scene/files.h"
#include "scene/limits.h"
#include "scene/read_image.h"

namespace shadowbench::scene {
namespace {

// Alpha of half precision, filtered by a renderer, misses the range by less than this.
constexpr float alpha_slack = 1e-2f;

struct Sample {
    float z_front, z_back, transmittance;
};

struct Channels {
    int alpha, z, z_back;  // z_back: -1 without one
};

// Moves to the first deep part.
OIIO::ImageSpec find_deep_part(OIIO::ImageInput& input, const std::filesystem::path& file, int& part) {
    for (part = 0; input.seek_subimage(part, 0); ++part) {
        const OIIO::ImageSpec spec = input.spec(part, 0);
        if (!spec.deep) continue;
        // Reading the pixels of a deep file with levels damages the heap in OpenImageIO 2.4.
        if (spec.get_int_attribute("openexr:levelmode", 0) != 0 || input.seek_subimage(part, 1))
            refuse_image(file, "a deep image with mip levels; only the plain kind is read");
        return spec;
    }
    refuse_image(file, "not a deep image");
}

Channels find_channels(const OIIO::ImageSpec& spec, const std::filesystem::path& file) {
    const Channels channels{spec.channelindex("A"), spec.channelindex("Z"), spec.channelindex("ZBack")};
    if (channels.alpha < 0 || channels.z < 0)
        refuse_image(file,
                     fmt::format("the channels A and Z are needed; there are: {}", fmt::join(spec.channelnames, ", ")));
    return channels;
}

Sample read_sample(const OIIO::DeepData& data, const Channels& channels, std::int64_t pixel, int index) {
    const float z = data.deep_value(pixel, channels.z, index);
    const float z_back = channels.z_back < 0 ? z : data.deep_value(pixel, channels.z_back, index);
    return {z, z_back, 1.0f - data.deep_value(pixel, channels.alpha, index)};
}

// Empty when nothing is wrong.
std::string fault_of(const Sample& sample) {
    if (!std::isfinite(sample.z_front) || !std::isfinite(sample.z_back) || !std::isfinite(sample.transmittance))
        return "a value is not finite";
    if (std::abs(sample.z_front) > max_coordinate || std::abs(sample.z_back) > max_coordinate)
        return fmt::format("a depth is beyond {}", max_coordinate);
    if (sample.z_back < sample.z_front) return fmt::format("ZBack {} lies before Z {}", sample.z_back, sample.z_front);
    if (sample.transmittance < -alpha_slack || sample.transmittance > 1.0f + alpha_slack)
        return fmt::format("alpha {} is outside [0, 1]", 1.0f - sample.transmittance);
    return "";
}

DeepImage convert(const OIIO::DeepData& data, const OIIO::ImageSpec& spec, const Channels& channels,
                  const std::filesystem::path& file) {
    DeepImage image{spec.width, spec.height, {0}, {}, {}, {}};
    const std::int64_t pixels = static_cast<std::int64_t>(spec.width) * spec.height;
    std::uint64_t total = 0;
    for (std::int64_t pixel = 0; pixel < pixels; ++pixel) total += static_cast<std::uint64_t>(data.samples(pixel));
    if (total > max_deep_samples)
        refuse_image(file, fmt::format("{} samples; the limit is {}", total, max_deep_samples));
    image.begin.reserve(static_cast<std::size_t>(pixels) + 1);
    for (auto* values : {&image.z_front, &image.z_back, &image.transmittance}) values->reserve(total);

    std::vector<Sample> samples;
    for (std::int64_t pixel = 0; pixel < pixels; ++pixel) {
        samples.clear();
        for (int i = 0; i < data.samples(pixel); ++i) {
            Sample sample = read_sample(data, channels, pixel, i);
            if (const std::string fault = fault_of(sample); !fault.empty())
                refuse_image(file, fmt::format("pixel ({}, {}), sample {}: {}", pixel % spec.width, pixel / spec.width,
                                               i, fault));
            sample.transmittance = std::clamp(sample.transmittance, 0.0f, 1.0f);
            samples.push_back(sample);
        }
        std::stable_sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) {
            return a.z_front < b.z_front || (a.z_front == b.z_front && a.z_back < b.z_back);
        });
        for (const Sample& sample : samples) {
            image.z_front.push_back(sample.z_front);
            image.z_back.push_back(sample.z_back);
            image.transmittance.push_back(sample.transmittance);
        }
        image.begin.push_back(image.z_front.size());
    }
    return image;
}

}  // namespace

DeepImage read_deep_image(const std::filesystem::path& file) {
    try {
        const std::unique_ptr<OIIO::ImageInput> input = open_image(file);
        int part = 0;
        const OIIO::ImageSpec spec = find_deep_part(*input, file, part);
        const Channels channels = find_channels(spec, file);
        const std::uint64_t pixels = static_cast<std::uint64_t>(spec.width) * static_cast<std::uint64_t>(spec.height);
        const std::uint64_t bytes = std::filesystem::file_size(file);
        if (pixels > max_texels || pixels / max_values_per_byte > bytes)
            refuse_image(file,
                         fmt::format("{} x {} pixels in a file of {} bytes; the limit is {} pixels, and {} a byte",
                                     spec.width, spec.height, bytes, max_texels, max_values_per_byte));
        OIIO::DeepData data;
        if (!input->read_native_deep_image(part, 0, data))
            refuse_image(file, "damaged or cut short: " + input->geterror());
        return convert(data, spec, channels, file);
    } catch (const base::Error&) {
        throw;
    } catch (const std::exception& fault) {
        refuse_image(file, fmt::format("not a readable deep image: {}", fault.what()));
    }
}

}  // namespace shadowbench::scene
