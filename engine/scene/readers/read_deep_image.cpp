// Deep images: Interpreting OpenEXR Deep Pixels (Hillman, Welford 2013). A sample spans Z to ZBack (a surface if there
// is only Z) and absorbs alpha of the light.
#include <OpenImageIO/deepdata.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "scene/limits.h"
#include "scene/readers/deep_channels.h"
#include "scene/readers/files.h"
#include "scene/readers/kinds.h"
#include "scene/readers/read_image.h"

namespace shadowbench::scene {
namespace {

// Alpha in half precision that a renderer has filtered leaves the range by less than this.
constexpr float alpha_slack = 1e-2f;
constexpr float farthest = static_cast<float>(max_coordinate);

struct Sample {
    float z_front, z_back;
    std::array<float, 3> transmittance;
};

struct Part {
    int number = 0;
    std::string name;
    bool deep = false;
};

std::vector<Part> list_parts(OIIO::ImageInput& input) {
    std::vector<Part> parts;
    for (int number = 0; input.seek_subimage(number, 0); ++number) {
        const OIIO::ImageSpec spec = input.spec(number, 0);
        parts.push_back({number, spec.get_string_attribute("oiio:subimagename"), spec.deep});
    }
    return parts;
}

std::string shown(const Part& part) {
    return part.name.empty() ? fmt::format("{}", part.number) : fmt::format("{} \"{}\"", part.number, part.name);
}

std::string list(const std::vector<Part>& parts) {
    std::string text;
    for (const Part& part : parts)
        if (part.deep) text += (text.empty() ? "" : ", ") + shown(part);
    return text.empty() ? "none" : text;
}

bool is_meant(const Part& part, const DeepChoice& choice) {
    if (const int* number = std::get_if<int>(&choice.part)) return part.number == *number;
    if (const auto* name = std::get_if<std::string>(&choice.part)) return part.name == *name;
    return part.deep;
}

// Names the part that is read and those that are not.
void note_part(const std::vector<Part>& parts, const Part& chosen, ReadNotes& notes) {
    constexpr std::size_t most_names = 8;
    std::string others;
    std::size_t named = 0;
    for (const Part& part : parts) {
        if (part.number == chosen.number) continue;
        if (named == most_names) {
            others += ", ...";
            break;
        }
        others += fmt::format("{}{}{}", named > 0 ? ", " : "", shown(part), part.deep ? "" : " (not deep)");
        ++named;
    }
    notes.lines.push_back(fmt::format("of {} parts {} is read; passed over: {}", parts.size(), shown(chosen), others));
}

int choose_part(OIIO::ImageInput& input, const DeepChoice& choice, const std::filesystem::path& file,
                ReadNotes& notes) {
    const std::vector<Part> parts = list_parts(input);
    std::vector<Part> meant;
    for (const Part& part : parts)
        if (is_meant(part, choice)) meant.push_back(part);
    const bool named = !std::holds_alternative<std::monostate>(choice.part);
    if (meant.empty() && !named) refuse_image(file, "not a deep image");
    if (meant.empty())
        refuse_image(file, fmt::format("there is no such \"part\"; the deep parts are: {}", list(parts)));
    if (meant.size() > 1)
        refuse_image(file, fmt::format("{} parts {}: give \"part\", the number (or name) of one of: {}", meant.size(),
                                       named ? "have this name" : "are deep images", list(parts)));
    if (!meant[0].deep)
        refuse_image(
            file, fmt::format("the part {} is not a deep image; the deep parts are: {}", shown(meant[0]), list(parts)));
    if (parts.size() > 1) note_part(parts, meant[0], notes);
    return meant[0].number;
}

// Moves to the part.
OIIO::ImageSpec open_part(OIIO::ImageInput& input, int part, const std::filesystem::path& file) {
    OIIO::ImageSpec spec = input.spec(part, 0);
    // OpenImageIO 2.4 damages the heap when it reads the pixels of a deep file with levels.
    if (spec.get_int_attribute("openexr:levelmode", 0) != 0 || input.seek_subimage(part, 1))
        refuse_image(file, "a deep image with mip levels; only the plain kind is read");
    const std::uint64_t pixels = static_cast<std::uint64_t>(spec.width) * static_cast<std::uint64_t>(spec.height);
    const std::uint64_t bytes = std::filesystem::file_size(file);
    if (pixels > max_texels || pixels / max_values_per_byte > bytes)
        refuse_image(file, fmt::format("{} x {} pixels in a file of {} bytes; the limit is {} pixels, and {} a byte",
                                       spec.width, spec.height, bytes, max_texels, max_values_per_byte));
    return spec;
}

Sample read_sample(const OIIO::DeepData& data, const DeepChannels& channels, std::int64_t pixel, int index) {
    const float z = data.deep_value(pixel, channels.z, index);
    Sample sample{z, channels.z_back < 0 ? z : data.deep_value(pixel, channels.z_back, index), {}};
    for (std::size_t c = 0; c < 3; ++c)
        sample.transmittance[c] = 1.0f - data.deep_value(pixel, channels.alpha[c], index);
    return sample;
}

// Says what is wrong with a sample; empty if nothing is.
std::string fault_of(const Sample& sample) {
    if (std::isnan(sample.z_front) || std::isnan(sample.z_back)) return "a depth is not a number";
    if (sample.z_front < -farthest) return fmt::format("Z {} is before {}", sample.z_front, -farthest);
    for (const float transmittance : sample.transmittance) {
        if (!std::isfinite(transmittance)) return "alpha is not finite";
        if (transmittance < -alpha_slack || transmittance > 1.0f + alpha_slack)
            return fmt::format("alpha {} is outside [0, 1]", 1.0f - transmittance);
    }
    return "";
}

// Makes samples fulfil what DeepImage promises, and counts what it changes.
class Mender {
public:
    void mend(Sample& sample) {
        if (sample.z_back < sample.z_front) {
            sample.z_back = sample.z_front;
            ++flat_;
        }
        bool clamped = false;
        for (float& transmittance : sample.transmittance) {
            const float within = std::clamp(transmittance, 0.0f, 1.0f);
            clamped = clamped || within != transmittance;
            transmittance = within;
        }
        clamped_ += clamped;
        if (sample.z_back <= farthest) return;
        ++far_;
        // A sample that reaches to infinity has no density near its front, whatever its alpha, unless it is opaque.
        const auto& through = sample.transmittance;
        if (sample.z_front > farthest || std::find(through.begin(), through.end(), 0.0f) == through.end()) return;
        for (float& transmittance : sample.transmittance) transmittance = transmittance == 0.0f ? 0.0f : 1.0f;
        sample.z_back = sample.z_front;
        --far_;
        ++endless_;
    }

    void note(std::size_t samples, ReadNotes& notes) const {
        const auto add = [&](std::uint64_t count, const std::string& what) {
            if (count > 0) notes.lines.push_back(fmt::format("{} of {} samples {}", count, samples, what));
        };
        add(flat_, "have their ZBack before Z: taken as surfaces");
        add(clamped_, "have an alpha just outside [0, 1]: taken as its nearer end");
        add(far_, fmt::format("are at infinity, or reach beyond {}: they lie behind everything", max_coordinate));
        add(endless_, "are opaque and reach to infinity: taken as surfaces");
    }

private:
    std::uint64_t flat_ = 0, clamped_ = 0, far_ = 0, endless_ = 0;
};

// Reduces three channels that are equal everywhere to one.
void drop_equal_channels(DeepImage& image) {
    std::vector<float>& t = image.transmittance;
    for (std::size_t i = 0; i < t.size(); i += 3)
        if (t[i] != t[i + 1] || t[i] != t[i + 2]) return;
    for (std::size_t i = 0; i < t.size(); i += 3) t[i / 3] = t[i];
    t.resize(t.size() / 3);
    t.shrink_to_fit();
    image.channels = 1;
}

// Rows that are packed together.
int rows_at_once(const OIIO::ImageSpec& spec) {
    constexpr int most_in_a_block = 16;  // of an OpenEXR file without tiles
    return spec.tile_height > 0 ? spec.tile_height : most_in_a_block;
}

// `y` is a row of the image, 0 at its top.
void read_rows(OIIO::ImageInput& input, int part, const OIIO::ImageSpec& spec, int y, int rows, OIIO::DeepData& data,
               const std::filesystem::path& file) {
    const int begin = spec.y + y, end = begin + rows;
    const bool sound = spec.tile_width > 0
                           ? input.read_native_deep_tiles(part, 0, spec.x, spec.x + spec.width, begin, end, spec.z,
                                                          spec.z + spec.depth, 0, spec.nchannels, data)
                           : input.read_native_deep_scanlines(part, 0, begin, end, 0, 0, spec.nchannels, data);
    if (!sound) refuse_image(file, "damaged or cut short: " + input.geterror());
}

// Reads a few rows at a time, since OpenImageIO holds all channels of what it reads.
class DeepReader {
public:
    DeepReader(const std::filesystem::path& file, const OIIO::ImageSpec& spec, const DeepChannels& channels)
        : file_(file), spec_(spec), channels_(channels) {
        const bool coloured = channels.alpha[0] != channels.alpha[1] || channels.alpha[0] != channels.alpha[2];
        image_.width = spec.width;
        image_.height = spec.height;
        image_.channels = coloured ? 3 : 1;
        image_.begin.reserve(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) + 1);
        image_.begin.push_back(0);
    }

    DeepImage read(OIIO::ImageInput& input, int part) {
        for (int y = 0; y < spec_.height; y += rows_at_once(spec_)) {
            const int rows = std::min(rows_at_once(spec_), spec_.height - y);
            OIIO::DeepData data;
            read_rows(input, part, spec_, y, rows, data, file_);
            take(data, y, rows);
        }
        for (std::vector<float>* kept : {&image_.z_front, &image_.z_back, &image_.transmittance}) kept->shrink_to_fit();
        if (image_.channels == 3) drop_equal_channels(image_);
        mender_.note(image_.z_front.size(), image_.notes);
        return std::move(image_);
    }

private:
    void take(const OIIO::DeepData& data, int y, int rows) {
        const std::int64_t pixels = static_cast<std::int64_t>(spec_.width) * rows;
        for (std::int64_t pixel = 0; pixel < pixels; ++pixel) {
            const auto count = static_cast<std::uint64_t>(data.samples(pixel));
            if (image_.z_front.size() + count > max_deep_samples)
                refuse_image(file_, fmt::format("over {} samples, the limit", max_deep_samples));
            take_pixel(data, pixel, y);
        }
    }

    void take_pixel(const OIIO::DeepData& data, std::int64_t pixel, int y) {
        samples_.clear();
        for (int i = 0; i < data.samples(pixel); ++i) {
            Sample sample = read_sample(data, channels_, pixel, i);
            if (const std::string fault = fault_of(sample); !fault.empty())
                refuse_image(file_, fmt::format("pixel ({}, {}), sample {}: {}", pixel % spec_.width,
                                                y + pixel / spec_.width, i, fault));
            mender_.mend(sample);
            samples_.push_back(sample);
        }
        std::stable_sort(samples_.begin(), samples_.end(), [](const Sample& a, const Sample& b) {
            return a.z_front < b.z_front || (a.z_front == b.z_front && a.z_back < b.z_back);
        });
        for (const Sample& sample : samples_) {
            image_.z_front.push_back(sample.z_front);
            image_.z_back.push_back(sample.z_back);
            image_.transmittance.insert(image_.transmittance.end(), sample.transmittance.begin(),
                                        sample.transmittance.begin() + image_.channels);
        }
        image_.begin.push_back(image_.z_front.size());
    }

    const std::filesystem::path& file_;
    const OIIO::ImageSpec& spec_;
    const DeepChannels& channels_;
    DeepImage image_;
    Mender mender_;
    std::vector<Sample> samples_;  // of a pixel
};

}  // namespace

bool is_deep_image(const std::filesystem::path& file) {
    try {
        const std::unique_ptr<OIIO::ImageInput> input = open_image(file);
        const std::vector<Part> parts = list_parts(*input);
        return std::any_of(parts.begin(), parts.end(), [](const Part& part) { return part.deep; });
    } catch (const base::Error&) {
        throw;
    } catch (const std::exception& fault) {
        refuse_image(file, fmt::format("not a readable image: {}", fault.what()));
    }
}

DeepImage read_deep_image(const std::filesystem::path& file, const DeepChoice& choice) {
    try {
        const std::unique_ptr<OIIO::ImageInput> input = open_image(file);
        ReadNotes notes;
        const int part = choose_part(*input, choice, file, notes);
        const OIIO::ImageSpec spec = open_part(*input, part, file);
        const DeepChannels channels = find_deep_channels(spec.channelnames, choice.layer, file, notes);
        DeepImage image = DeepReader(file, spec, channels).read(*input, part);
        image.notes.lines.insert(image.notes.lines.begin(), notes.lines.begin(), notes.lines.end());
        return image;
    } catch (const base::Error&) {
        throw;
    } catch (const std::exception& fault) {
        refuse_image(file, fmt::format("not a readable deep image: {}", fault.what()));
    }
}

}  // namespace shadowbench::scene
