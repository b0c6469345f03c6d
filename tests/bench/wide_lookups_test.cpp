// The error of wide lookups if the rays of each pixel are kept as one function. It is small against the truth if pixels
// at the footprint's border are weighted by their covered area.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include <nlohmann/json.hpp>

#include "bench/run.h"
#include "document/document.h"

namespace shadowbench::bench {
namespace {

using nlohmann::json;

// The allowed error, as a factor of the error of the same rays kept one by one, for pixels with many crossings, as in
// hair. Both err by the noise of the rays inside the footprint; whole pixels also err by up to half a pixel at each
// side. (A single edge of an opaque surface is a different case: a pixel cut by both the edge and the footprint's
// border knows only its share of light, so the answer errs by at most f (1 - f) / width, f the share that the edge
// leaves.)
constexpr double close = 1.5;

struct Errors {
    double deep, pixels, uncompressed;  // RMS of lookups
};

// The RMS errors of lossless deep maps, weighted by area or by whole pixels as in the paper, and of the rays.
Errors errors_of(json document, double width) {
    document["techniques"] = json::parse(R"([{"type": "deep", "tolerance": 0},
        {"type": "deep", "tolerance": 0, "kernel": "pixels"}, {"type": "uncompressed"}])");
    for (const char* assignment :
         {"timing.repetitions=1", "timing.lookups=64", "reference.queries=2048", "reference.spread_seeds=0"})
        document::set_value(document, assignment);
    document["receivers"]["filter_width"] = width;
    const results::LightResult light = run(document, {}, {}).variants.at(0).lights.at(0);
    const auto rms = [&](std::size_t cell) { return light.cells.at(cell).lookup->norms.rms; };
    return {rms(0), rms(1), rms(2)};
}

void expect_close(const json& document) {
    for (const double width : {4.0, 3.7}) {
        const Errors rms = errors_of(document, width);
        EXPECT_LE(rms.deep, close * rms.uncompressed) << "width " << width;
        EXPECT_GT(rms.pixels, rms.deep) << "width " << width << ": the test would see whole pixels";
        ::testing::Test::RecordProperty(
            "width_" + std::to_string(width),
            std::to_string(rms.deep) + " " + std::to_string(rms.pixels) + " " + std::to_string(rms.uncompressed));
    }
}

TEST(WideLookups, InADeepMapOfHairErrAsTheRaysDo) {
    std::ifstream file(std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / "scenarios" / "quickstart.json");
    json document = json::parse(file);
    document::set_value(document, "receivers.resolution=[128,96]");
    expect_close(document);
}

}  // namespace
}  // namespace shadowbench::bench
