#include "claims/paper.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "bench/disturbance.h"
#include "temporary_folder.h"

namespace shadowbench::claims {
namespace {

results::Result two_variants() {
    results::Result result;
    for (const char* value : {"1", "2"}) {
        results::VariantResult variant;
        variant.settings = {{"/rays/samples_per_pixel", value}};
        results::LightResult light;
        light.name = value;
        results::Cell cell;
        cell.technique = "avsm";
        cell.parameters_json = R"({"type":"avsm","nodes":8,"order":"sorted"})";
        light.cells.push_back(cell);
        cell.parameters_json = R"({"type":"avsm","nodes":4,"order":"sorted"})";
        cell.status = results::CellStatus::failed;
        cell.reason = "it fell over";
        light.cells.push_back(cell);
        variant.lights.push_back(light);
        result.variants.push_back(variant);
    }
    return result;
}

TEST(Paper, CellsAreFoundBySettingsAndParameters) {
    const results::Result result = two_variants();
    EXPECT_EQ(light_of(result, {"/rays/samples_per_pixel=2"}).name, "2");
    const results::LightResult& light = light_of(result);
    EXPECT_EQ(&cell_of(light, "avsm", {"nodes=8", "order=sorted"}), &light.cells[0]);
    EXPECT_THROW(light_of(result, {"/rays/samples_per_pixel=3"}), base::Error);
    EXPECT_THROW(cell_of(light, "avsm", {"nodes=16"}), base::Error);
    EXPECT_THROW(cell_of(light, "deep"), base::Error);
}

TEST(Paper, ACellThatFailedIsNotMeasured) {
    const results::Result result = two_variants();
    try {
        cell_of(light_of(result), "avsm", {"nodes=4"});
        FAIL();
    } catch (const base::Error& error) {
        EXPECT_EQ(error.message(), "it fell over");
    }
}

TEST(Paper, DocumentsAreFoundByTheNamesThatListsShow) {
    const TemporaryFolder folder;
    std::ofstream(folder.path("file.json")) << R"({"name": "own", "purpose": "a"})";
    Context context;
    context.scenarios = folder.path();
    EXPECT_EQ(context.document("own", {"purpose=b"})["purpose"], "b");
    EXPECT_EQ(context.document("file")["name"], "own");
    try {
        context.document("other");
        FAIL();
    } catch (const base::Error& error) {
        EXPECT_EQ(error.code(), base::ErrorCode::no_such_file);
        EXPECT_EQ(error.where(), "other");
    }
}

TEST(Paper, ItsReportSaysHowLongItTookAndWhatTheHostTookMeanwhile) {
    const Paper paper{"x2000", "A paper", [](const Context& context) { context.report->conditions = "On paper."; }};
    const PaperReport report = measure(paper, {});
    EXPECT_EQ(report.id, "x2000");
    EXPECT_EQ(report.conditions, "On paper.");
    EXPECT_GT(report.seconds, 0.0);
    EXPECT_EQ(report.steal_seconds.has_value(), bench::steal_seconds().has_value());
    EXPECT_GE(report.steal_seconds.value_or(0.0), 0.0);
}

TEST(Paper, PapersHaveDifferentNames) {
    std::set<std::string> names;
    for (const Paper& paper : all_papers()) names.insert(paper.id);
    EXPECT_EQ(names.size(), all_papers().size());
    EXPECT_EQ(names.size(), 5u);
}

}  // namespace
}  // namespace shadowbench::claims
