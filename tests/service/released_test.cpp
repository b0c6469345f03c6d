// What released versions wrote is read for ever, with the values that it had: see tests/released/README.md.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/read_text.h"
#include "results/program.h"
#include "results/report.h"
#include "service/run_cli.h"
#include "techniques/deep/deep_file.h"
#include "techniques/deep/deep_level.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const fs::path released = fs::path(SHADOWBENCH_SOURCE_DIR) / "tests/released";

std::vector<fs::path> versions() {
    std::vector<fs::path> folders;
    for (const auto& entry : fs::directory_iterator(released))
        if (entry.is_directory()) folders.push_back(entry.path());
    std::sort(folders.begin(), folders.end());
    return folders;
}

const results::Cell& cell_of(const results::Result& result, const std::string& technique) {
    const std::vector<results::Cell>& cells = result.variants.at(0).lights.at(0).cells;
    return *std::find_if(cells.begin(), cells.end(),
                         [&](const results::Cell& cell) { return cell.technique == technique; });
}

TEST(Released, has_files_of_this_version_too) {
    EXPECT_TRUE(fs::is_directory(released / results::this_program().version))
        << "each version adds what it writes: tests/released/README.md says how";
}

TEST(Released, maps_give_the_values_that_they_had) {
    for (const fs::path& folder : versions()) {
        SCOPED_TRACE(folder.string());
        const techniques::DeepFile file(folder / "map.dsm");
        EXPECT_EQ(file.channels(), 1);
        EXPECT_FLOAT_EQ(file.notes().tolerance, 0.01f);
        EXPECT_THAT(file.notes().text, HasSubstr("two_sheets"));
        ASSERT_EQ(file.levels().size(), 1u);
        EXPECT_EQ(file.levels()[0].width, 8);
        EXPECT_EQ(file.levels()[0].height, 8);
        const float first = file.notes().z_min, second = file.notes().z_max;
        std::vector<std::byte> bytes;
        std::size_t pixels = 0;
        for (std::size_t tile = 0; tile < file.tiles(); ++tile) {
            bytes.resize(file.tile_bytes(tile));
            file.read_tile(tile, bytes.data());
            for (std::size_t p = 0; p < file.tile_pixels(tile); ++p, ++pixels) {
                const techniques::DeepFunction function =
                    techniques::function_of(bytes.data(), file.tile_pixels(tile), 1, p);
                EXPECT_EQ(techniques::evaluate(function, 0, first - 0.05f), 1.0f);
                EXPECT_EQ(techniques::evaluate(function, 0, 0.5f * (first + second)), 0.5f);
                EXPECT_EQ(techniques::evaluate(function, 0, second + 0.05f), 0.375f);
            }
        }
        EXPECT_EQ(pixels, 64u);
        EXPECT_THAT(cli({"inspect", (folder / "map.dsm").string()}).out, HasSubstr("all checksums right"));
    }
}

TEST(Released, results_give_the_values_that_they_had) {
    for (const fs::path& folder : versions()) {
        const std::string file = (folder / "result.json").string();
        SCOPED_TRACE(file);
        const results::Result result = results::from_json(nlohmann::json::parse(base::read_text(file)), file);
        EXPECT_EQ(result.program.version, folder.filename());
        EXPECT_EQ(result.name, "two_sheets");
        const results::LightResult& light = result.variants.at(0).lights.at(0);
        EXPECT_EQ(light.name, "sun");
        EXPECT_EQ(light.rays, 256u) << "8 x 8 pixels with 4 rays each";
        EXPECT_EQ(light.segments, 512u) << "both sheets";
        ASSERT_EQ(light.cells.size(), 4u);
        const results::Cell& deep = cell_of(result, "deep");
        EXPECT_EQ(deep.parameters, "tolerance=0.01");
        EXPECT_EQ(deep.nodes.cells, 64u);
        EXPECT_EQ(deep.nodes.total, 256u) << "two steps a pixel";
        EXPECT_EQ(deep.lookup->norms.max, 0.0);
        EXPECT_EQ(deep.curve->norms.max, 0.0);
        EXPECT_EQ(deep.over_seeds.size(), 2u);
        EXPECT_EQ(deep.times->random_order.ns.raw.size(), 5u);
        const results::Cell& opaque = cell_of(result, "shadow_map");
        EXPECT_TRUE(opaque.outside_promise);
        EXPECT_EQ(opaque.lookup->norms.max, 0.5) << "it takes the first sheet for opaque";
    }
}

TEST(Released, results_are_taken_by_the_commands) {
    for (const fs::path& folder : versions()) {
        const std::string file = (folder / "result.json").string();
        EXPECT_EQ(cli({"validate", file}).out, "OK two_sheets: 1 variant of 1 light and 4 techniques\n") << file;
        const Outcome same = cli({"compare", file, file});
        EXPECT_EQ(same.code, 0) << same.out << same.err;
        const Outcome answer =
            cli({"recommend", "--from", folder.string(), "--error", "0.1", "--cheapest", "bytes"});
        EXPECT_EQ(answer.code, 0) << answer.err;
        EXPECT_THAT(answer.out, HasSubstr("deep"));
    }
}

}  // namespace
}  // namespace shadowbench::service
