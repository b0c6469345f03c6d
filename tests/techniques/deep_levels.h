// Deep shadow maps of random functions, and files of them.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.h"
#include "curves/curve.h"
#include "techniques/deep/deep_file.h"
#include "temporary_folder.h"

namespace shadowbench::techniques::testing {

struct TestFile {
    explicit TestFile(const char* extension = ".dsm") : path(folder.path(std::string("map") + extension)) {}

    const TemporaryFolder folder;
    const std::filesystem::path path;
};

// Removes the old file first, because file systems wait for the disk when a file is overwritten.
inline void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
    std::filesystem::remove(file);
    std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

// Falling functions of 0 to `most` nodes; a third of the pixels are empty; of three channels half are coloured.
inline DeepLevel random_level(int width, int height, int channels, std::uint64_t seed, std::uint64_t most = 9) {
    base::Random random(seed);
    DeepLevel level{width, height, channels, {0}, {}, {}};
    const std::size_t pixels = static_cast<std::size_t>(width) * height;
    if (channels == 3) level.coloured.assign((pixels + 63) / 64, 0);
    for (std::size_t p = 0; p < pixels; ++p) {
        const std::uint64_t nodes = random.below(3) == 0 ? 0 : random.below(most + 1);
        const bool coloured = channels == 3 && random.below(2) == 0;
        if (coloured) level.coloured[p / 64] |= std::uint64_t{1} << (p % 64);
        double z = random.uniform(-1, 1);
        for (std::uint64_t i = 0; i < nodes; ++i) {
            level.floats.push_back(static_cast<float>(z));
            if (random.below(3) != 0) z += random.uniform();  // else a step
        }
        for (int c = 0; c < (coloured ? 3 : 1); ++c) {
            double value = 1.0;
            for (std::uint64_t i = 0; i < nodes; ++i)
                level.floats.push_back(static_cast<float>(value *= random.uniform(0.5, 1)));
        }
        level.offsets.push_back(static_cast<std::uint32_t>(level.floats.size()));
    }
    level.floats.resize(level.floats.size() + DeepLevel::padding);
    return level;
}

// All levels, down to one pixel or to `count` of them.
inline std::vector<DeepLevel> random_levels(int width, int height, int channels, std::uint64_t seed, int count = 99) {
    std::vector<DeepLevel> levels{random_level(width, height, channels, seed)};
    while (static_cast<int>(levels.size()) < count && (width > 1 || height > 1)) {
        width = (width + 1) / 2;
        height = (height + 1) / 2;
        levels.push_back(random_level(width, height, channels, seed + levels.size()));
    }
    return levels;
}

inline curves::Curve curve_of(const DeepLevel& level, int x, int y, int channel) {
    const std::size_t p = level.pixel(x, y);
    const std::uint32_t n = level.nodes(p);
    const float* depths = level.floats.data() + level.offsets[p];
    const float* values = depths + static_cast<std::size_t>(level.has_colour(p) ? 1 + channel : 1) * n;
    curves::Curve curve;
    for (std::uint32_t i = 0; i < n; ++i) curve.push_back({depths[i], values[i]});
    return curve;
}

}  // namespace shadowbench::techniques::testing
