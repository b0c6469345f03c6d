#include "bench/cell_runner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/run.h"
#include "errors.h"
#include "results/merge_cells.h"
#include "results/report.h"

namespace shadowbench::bench {
namespace {

using nlohmann::json;

json swept() {
    return json::parse(R"({
        "name": "swept",
        "scene": {"objects": [{"type": "sphere", "centre": [0, 0, 0], "radius": 1, "opacity": 0.5}]},
        "lights": [{"type": "directional", "name": "key", "direction": [0, -1, 0]},
                   {"type": "directional", "name": "fill", "direction": [0.3, -1, 0]}],
        "rays": {"resolution": 8, "samples_per_pixel": 4},
        "receivers": {"type": "probes", "count": 200},
        "reference": {"samples_per_pixel": 16, "queries": 20, "spread_seeds": 2},
        "timing": {"repetitions": 1, "lookups": 64},
        "techniques": [{"type": "deep"}, {"type": "ray_traced"}],
        "sweeps": {"/rays/samples_per_pixel": [1, 4], "/techniques/0/tolerance": [0.01, 0.1]}
    })");
}

TEST(CellRunner, ListsCellsByVariantThenLight) {
    std::vector<std::string> titles;
    for (const CellOfDocument& cell : cells_of(swept(), {})) titles.push_back(cell.title);
    EXPECT_EQ(titles, (std::vector<std::string>{
                          "swept /rays/samples_per_pixel=1 light key", "swept /rays/samples_per_pixel=1 light fill",
                          "swept /rays/samples_per_pixel=4 light key", "swept /rays/samples_per_pixel=4 light fill"}));
    EXPECT_EQ(cells_of(swept(), {}).back().place, (results::CellPlace{1, 1}));
    test::error_of([] { cells_of(swept(), {"avsm"}); }, base::ErrorCode::usage, "--only avsm");
}

// Each in a runner of its own, the last first: a cell must not depend on those before it.
TEST(CellRunner, MeasuresWhatARunDoes) {
    const std::vector<CellOfDocument> places = cells_of(swept(), {});
    std::vector<results::SweepCell> cells(places.size());
    for (std::size_t i = places.size(); i-- > 0;) cells[i] = CellRunner(swept(), {}).measure(places[i].place, {});
    nlohmann::ordered_json merged = results::to_json(results::merge_cells(cells)),
                           whole = results::to_json(run(swept(), {}, {}));
    results::strip_times(merged);
    results::strip_times(whole);
    EXPECT_EQ(merged, whole);
}

// A cell is a map: a point light has one for each face, and a light that casts no shadow has none.
TEST(CellRunner, CountsMapsAndARunSaysWhichLightHasNone) {
    json document = swept();
    document.erase("sweeps");
    document["lights"] = json::parse(R"([
        {"type": "directional", "name": "fill", "direction": [0, -1, 0], "casts_shadow": false},
        {"type": "point", "name": "lamp", "position": [0, 3, 0], "faces": ["-y", "+x"]}])");
    RunOptions untimed;
    untimed.times = false;
    const results::Result whole = run(document, untimed, {});
    ASSERT_EQ(whole.variants.at(0).lights.size(), 2u);
    EXPECT_EQ(whole.variants[0].lights[1].name, "lamp -y");
    EXPECT_EQ(std::count_if(whole.notes.begin(), whole.notes.end(),
                            [](const std::string& note) { return note.starts_with("/lights/0: \"fill\" casts no"); }),
              1);
    const std::vector<CellOfDocument> places = cells_of(document, {});
    ASSERT_EQ(places.size(), 2u);
    EXPECT_EQ(places[1].title, "swept light lamp -y");
    CellRunner runner(document, untimed);
    for (const CellOfDocument& cell : places) {
        const results::SweepCell measured = runner.measure(cell.place, {});
        EXPECT_EQ(measured.result.variants.at(0).lights.at(0).name, whole.variants[0].lights[cell.place.light].name);
    }
}

// None of the first variant's receivers is inside the map: known only once it runs.
TEST(CellRunner, MeasuresOtherCellsAfterOneThatFails) {
    json document = swept();
    document["sweeps"] = json::parse(R"({"/receivers": [{"type": "points", "positions": [[50, 0, 0]]},
                                                        {"type": "probes", "count": 200}]})");
    CellRunner runner(document, {});
    EXPECT_THROW(runner.measure({0, 0}, {}), base::Error);
    EXPECT_EQ(runner.measure({1, 0}, {}).result.variants.at(0).lights.at(0).cells.size(), 2u);
}

}  // namespace
}  // namespace shadowbench::bench
