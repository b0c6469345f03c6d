#include "techniques/mean_rays.h"

namespace shadowbench::techniques {
namespace {

// A mean of exponentials is convex, and so is its logarithm. Between two of its vertices, a constant extinction lies
// between the mean and the line that joins them: it errs by no more than that line.
constexpr double linearisation = 1e-4;

// Appends the segments of a function that falls from 1; nothing follows a value of 0.
void append_segments(const curves::Curve& mean, rays::LightRays& out) {
    for (std::size_t i = 0; i + 1 < mean.size(); ++i) {
        const curves::Vertex &from = mean[i], &to = mean[i + 1];
        if (!(to.value < from.value)) continue;
        out.z_front.push_back(from.z);
        out.z_back.push_back(to.z);
        out.transmittance.push_back(to.value / from.value);
    }
}

}  // namespace

const rays::LightRays& MeanRays::of(const rays::LightRays& tile, const curves::RayFunctions* functions) {
    functions_bytes_ = functions ? functions->scratch_bytes() : 0;
    result_.tile = tile.tile;
    result_.x0 = tile.x0;
    result_.y0 = tile.y0;
    result_.width = tile.width;
    result_.height = tile.height;
    result_.z_front.clear();
    result_.z_back.clear();
    result_.transmittance.clear();
    result_.begin.assign(1, 0);
    const auto samples = static_cast<std::size_t>(tile.samples);
    for (std::size_t first = 0; first < tile.rays(); first += samples) {
        if (tile.begin[first] < tile.begin[first + samples]) {
            if (functions)
                curves::visibility(tile, *functions, first, samples, linearisation, scratch_, mean_);
            else
                curves::visibility(tile, first, samples, linearisation, scratch_, mean_);
            append_segments(mean_, result_);
        }
        result_.begin.push_back(static_cast<std::uint32_t>(result_.segments()));
    }
    result_.submission.clear();
    if (!tile.submission.empty())
        for (std::uint32_t s = 0; s < result_.segments(); ++s) result_.submission.push_back(s);
    return result_;
}

std::size_t MeanRays::bytes() const {
    return functions_bytes_ + scratch_.bytes() + mean_.capacity() * sizeof(curves::Vertex) + result_.bytes();
}

}  // namespace shadowbench::techniques
