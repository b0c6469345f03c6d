// What a wide lookup loses when the rays of each pixel are kept as one function: little against the truth, as long as
// pixels at the footprint's border weigh what it covers of them.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include <nlohmann/json.hpp>

#include "bench/run.h"
#include "document/document.h"

namespace shadowbench::bench {
namespace {

using nlohmann::json;

// Of what the same rays kept one by one err, where much lies inside a pixel, as hair does. Both err by the noise of the
// rays inside the footprint; whole pixels err by up to half a pixel at each side besides. (A lone edge of something
// opaque is another matter: a pixel that both the edge and the footprint's border cut knows only its share of light, by
// which the answer is off by f (1 - f) / width at most, f the share that the edge leaves.)
constexpr double close = 1.5;

struct Errors {
    double deep, pixels, uncompressed;  // RMS of lookups
};

// The RMS errors of lossless deep maps, by area and by the paper's whole pixels, and of the rays themselves.
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

TEST(WideLookups, OfADeepMapOfHairErrAsThoseOfItsRays) {
    std::ifstream file(std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / "scenarios" / "quickstart.json");
    json document = json::parse(file);
    document::set_value(document, "receivers.resolution=[128,96]");
    expect_close(document);
}

}  // namespace
}  // namespace shadowbench::bench
