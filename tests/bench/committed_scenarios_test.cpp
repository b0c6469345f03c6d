// The promises of techniques on committed scenarios, in which only the receivers and the timing are reduced.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <nlohmann/json.hpp>

#include "bench/run.h"
#include "document/document.h"

namespace shadowbench::bench {
namespace {

using nlohmann::json;

// The cells of one light in this order: deep with two tolerances, avsm with 4, 8 and 16 nodes, uncompressed,
// ray_traced.
results::LightResult measure(const std::string& name, const std::vector<std::string>& assignments) {
    const std::filesystem::path top = SHADOWBENCH_SOURCE_DIR;
    std::ifstream file(top / "scenarios" / (name + ".json"));
    json document = json::parse(file);
    document["techniques"] = json::parse(R"([
        {"type": "deep", "tolerance": "noise"}, {"type": "deep", "tolerance": 0.01},
        {"type": "avsm", "nodes": 4}, {"type": "avsm", "nodes": 8}, {"type": "avsm", "nodes": 16},
        {"type": "uncompressed"}, {"type": "ray_traced", "samples": 256}])");
    for (const char* assignment : {"timing.repetitions=1", "timing.lookups=64", "reference.queries=256",
                                   "reference.samples_per_pixel=256", "reference.spread_seeds=0"})
        document::set_value(document, assignment);
    for (const std::string& assignment : assignments) document::set_value(document, assignment);
    RunOptions options;
    if (const char* data = std::getenv("SHADOWBENCH_DATA")) options.data.folders.emplace_back(data);
    options.data.folders.push_back(top / ".." / "shared" / "data");
    return run(document, options, {}).variants.at(0).lights.at(0);
}

void check_promises(const results::LightResult& light) {
    ASSERT_EQ(light.cells.size(), 7u);
    for (const results::Cell& cell : light.cells)
        EXPECT_EQ(cell.status, results::CellStatus::ok) << cell.technique << cell.reason;
    ASSERT_TRUE(light.agreement);
    EXPECT_LE(light.agreement->other_crossings, 3u);

    const double noise = 0.25 / std::sqrt(static_cast<double>(light.layout.samples()));
    const auto curve_max = [&](std::size_t i) { return light.cells[i].curve->norms.max; };
    EXPECT_LE(curve_max(0), noise + 1e-6) << "every pixel, by the exact norm";
    EXPECT_LE(curve_max(1), 0.01 + 1e-6);
    EXPECT_LE(curve_max(5), 1e-6) << "uncompressed is exact, except for the rounding of floats";

    EXPECT_GT(light.cells[2].curve->norms.mean, light.cells[3].curve->norms.mean);
    EXPECT_GT(light.cells[3].curve->norms.mean, light.cells[4].curve->norms.mean) << "more nodes, less error";

    // There are as many shadow rays as rays of the truth. They are one jittered set, which is no less accurate.
    const metrics::ErrorNorms& traced = light.cells[6].lookup->norms;
    EXPECT_LE(traced.rms, std::sqrt(2.0) * light.reference.error_rms + 1e-4);
    EXPECT_LE(traced.max, 5 * std::sqrt(2.0) * light.reference.error_max + 1e-3);
}

TEST(CommittedScenarios, QuickstartKeepsWhatTheTechniquesPromise) {
    check_promises(measure("quickstart", {"receivers.resolution=[128,96]"}));
}

TEST(CommittedScenarios, MovingFanKeepsWhatTheTechniquesPromise) {
    check_promises(measure("moving_fan", {"receivers.resolution=[128,96]"}));
}

TEST(CommittedScenarios, SmokeVdbKeepsWhatTheTechniquesPromise) {
    const char* data = std::getenv("SHADOWBENCH_DATA");
    const auto file = std::filesystem::path("volumes") / "smoke.vdb";
    if (!std::filesystem::exists(std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / ".." / "shared" / "data" / file) &&
        !(data && std::filesystem::exists(std::filesystem::path(data) / file)))
        GTEST_SKIP() << "no data: " << file;
    check_promises(measure("smoke_vdb", {"rays.resolution=64", "receivers.resolution=[64,48]"}));
}

}  // namespace
}  // namespace shadowbench::bench
