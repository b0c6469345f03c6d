// Builds a DeepLevel: compresses functions pixel by pixel into runs, and assembles the runs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "curves/compress.h"
#include "curves/fewest.h"
#include "curves/sweep.h"
#include "techniques/deep/deep_level.h"

namespace shadowbench::techniques {

// The compressed functions of a rectangle of pixels, row after row, each laid out as in DeepLevel.
struct PixelRun {
    int x0 = 0, y0 = 0, width = 0;
    int channels = 1;                     // of the map
    std::vector<std::uint32_t> begin{0};  // pixels + 1 offsets into the floats
    std::vector<float> floats;
    std::vector<unsigned char> coloured;  // channels == 3: whether a pixel holds three

    std::size_t bytes() const {
        return begin.capacity() * sizeof(std::uint32_t) + floats.capacity() * sizeof(float) + coloured.capacity();
    }
};

// One pixel before it is compressed, and the memory for making it; each thread has its own.
struct PixelScratch {
    std::array<curves::Curve, 3> function, kept;
    std::vector<curves::ColourVertex> colour;
    curves::SweepScratch sweep;
    curves::FewestScratch fewest;
    std::array<curves::Curve, 4> children;

    std::size_t bytes() const;
};

// How functions are compressed, and how closely.
struct Compression {
    // By curves/compress.h; by compress_published.h; by fewest.h, but three functions at once by compress.h.
    enum class Method { bounded, published, optimal };

    float tolerance = 0.0f;
    Method method = Method::bounded;
};

// Whether the first `functions` (1 or 3) of the scratch are three that differ.
bool is_coloured(const PixelScratch& scratch, int functions);

// Compresses the first `functions` (1 or 3) of the scratch and appends them as the run's next pixel. Three equal ones
// are stored as one.
void append(PixelRun& run, PixelScratch& scratch, int functions, const Compression& compression);

// The same for a function that the scratch does not hold, and which is not copied.
void append_given(PixelRun& run, PixelScratch& scratch, curves::CurveView function, const Compression& compression);

// The same without loss, and the scratch keeps its functions.
void append_lossless(PixelRun& run, PixelScratch& scratch, int functions);

// Gives back the memory that a run with all its pixels does not need.
void complete(PixelRun& run);

// Puts together runs that fill the level: those of the first rows of pixels, from left to right, then those of the rows
// behind them. It empties each run once it is copied. `peak_bytes` becomes the most that level and runs hold together.
// Throws Error{bad_input} if the level would hold more than 2^32 floats.
DeepLevel assemble(int width, int height, int channels, std::span<PixelRun> runs, std::size_t& peak_bytes);

// The function of a channel; `out` is replaced.
void read_function(const DeepLevel& level, std::size_t pixel, int channel, curves::Curve& out);

}  // namespace shadowbench::techniques
