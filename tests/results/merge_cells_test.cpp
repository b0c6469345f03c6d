#include "results/merge_cells.h"

#include <gtest/gtest.h>

#include <vector>

#include <nlohmann/json.hpp>

#include "base/hash_text.h"
#include "errors.h"
#include "results/report.h"
#include "results/sweep_cell.h"

namespace shadowbench::results {
namespace {

constexpr base::ErrorCode bad = base::ErrorCode::bad_input;

Cell row(const std::string& technique, bool stores_functions) {
    Cell cell;
    cell.technique = technique;
    cell.parameters = "tolerance=0.02";
    cell.parameters_json = R"({"tolerance":0.02})";
    cell.bytes = 460;
    cell.nodes = {3, 7, 4, {0, 1, 1, 0, 1}};
    cell.lookup = LookupErrors{{0.5, 0.25, 0.125, 0.4}, -0.1, RmsInterval{0.2, 0.3, true}, 0.0625};
    if (stores_functions) cell.curve = CurveErrors{3, 1e-5, {0.5, 0.25, 0.125, 0.4}, 0.75, 1, 2, 0.0, 0.0};
    cell.times = CellTimes{};
    cell.times->build_ms = summarise({2.0});
    cell.times->image_order.ns = summarise({2.5});
    cell.times->random_order.ns = summarise({7.5});
    return cell;
}

// A cell as one machine measures it: two techniques, of which the second stores no functions.
SweepCell made(std::size_t variant, std::size_t light, const std::string& node = "n1", const std::string& cpu = "A") {
    SweepCell cell{{variant, light}, node, {}};
    Result& result = cell.result;
    result.name = "made";
    result.document = R"({"name":"made"})";
    result.hash = base::hash_text(result.document);
    result.program = {"0.2.0", "abc", "GNU", "Release"};
    result.machine.cpu = cpu;
    result.machine.logical_cores = 8;
    result.times = {"2026-11-30T03:00:00Z", 2.0, 4};
    LightResult one;
    one.name = light == 0 ? "key" : "fill";
    one.cells = {row("deep", true), row("ray_traced", false)};
    result.variants = {{{{"/rays/seed", std::to_string(variant)}}, {one}}};
    return cell;
}

Cell& first_row(SweepCell& cell) {
    return cell.result.variants[0].lights[0].cells[0];
}

nlohmann::json file_of(const SweepCell& cell) {
    return nlohmann::json::parse(to_json(cell).dump(1));
}

TEST(SweepCell, ComesBackAsTheSameCell) {
    const SweepCell cell = made(3, 1);
    const SweepCell read = cell_from_json(file_of(cell), "c.json");
    EXPECT_EQ(to_json(read), to_json(cell));
    EXPECT_EQ(read.place, cell.place);
    EXPECT_EQ(read.node, "n1");
}

TEST(SweepCell, OfADamagedFileIsRefused) {
    const auto refused = [](const nlohmann::json& file, const std::string& where) {
        test::error_of([&] { cell_from_json(file, "c.json"); }, bad, "c.json: " + where);
    };
    nlohmann::json file = file_of(made(0, 0));
    file["variants"][0]["lights"][0]["cells"][0]["bytes"] = 461;
    refused(file, "/cell/checksum");
    file = file_of(made(0, 0));
    file["cell"]["variant"] = 1;
    refused(file, "/cell/checksum");
    file.erase("cell");
    refused(file, "");
    SweepCell other = made(0, 0);
    other.result.hash = "0123456789abcdef";
    refused(file_of(other), "/scenario_hash");
    other = made(0, 0);
    other.result.variants.push_back(other.result.variants[0]);
    refused(file_of(other), "/variants");
}

TEST(SweepCell, IsNamedByItsScenarioTechniquesAndPlaceAlone) {
    SweepCell other = made(0, 0, "n2", "B");
    other.result.program.commit = "def";
    EXPECT_EQ(cell_hash(other), cell_hash(made(0, 0)));
    EXPECT_NE(cell_hash(made(1, 0)), cell_hash(made(0, 0)));
    EXPECT_NE(cell_hash(made(0, 1)), cell_hash(made(1, 0)));
    other.result.only = {"deep"};
    EXPECT_NE(cell_hash(other), cell_hash(made(0, 0)));
    other = made(0, 0);
    other.result.hash = "0123456789abcdef";
    EXPECT_NE(cell_hash(other), cell_hash(made(0, 0)));
}

TEST(SweepCell, NamesItsMachineAsFarAsItIsKnown) {
    EXPECT_EQ(machine_text(made(0, 0)), "n1, A, 8 cores");
    EXPECT_EQ(machine_text(Machine{"A", 1}), "A, 1 core");
    EXPECT_EQ(machine_text(Machine{"", 2}), "2 cores") << "not every system names its processor";
}

TEST(MergeCells, JoinsThemInTheOrderOfARun) {
    std::vector<SweepCell> cells{made(0, 0), made(0, 1), made(1, 0), made(1, 1)};
    cells[0].result.notes = {"a"};
    cells[2].result.notes = {"a", "b"};
    cells[1].result.files = {"f"};
    cells[3].result.files = {"f", "g"};
    cells[3].result.times = {"2026-11-30T02:00:00Z", 5.0, 2};
    const Merged merged = merge_cells(cells);
    const Result& result = merged.result;
    ASSERT_EQ(result.variants.size(), 2u);
    for (std::size_t v = 0; v < 2; ++v) {
        EXPECT_EQ(result.variants[v].settings.at(0).value, std::to_string(v));
        ASSERT_EQ(result.variants[v].lights.size(), 2u);
        EXPECT_EQ(result.variants[v].lights[1].name, "fill");
    }
    EXPECT_EQ(result.notes, (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(result.files, (std::vector<std::string>{"f", "g"}));
    EXPECT_EQ(result.times.started, "2026-11-30T02:00:00Z");
    EXPECT_EQ(result.times.seconds, 11.0);
    EXPECT_EQ(result.machine.cpu, "A");
    EXPECT_EQ(machines_text(merged), "") << "one machine needs no list";
    nlohmann::ordered_json json = to_json(merged);
    EXPECT_EQ(json["times"]["cells"].size(), 4u);
    EXPECT_EQ(json["times"]["cells"][3]["started"], "2026-11-30T02:00:00Z");
    EXPECT_EQ(to_json(from_json(nlohmann::json::parse(json.dump()), "")), to_json(result)) << "read as any result";
}

TEST(MergeCells, KeepsTheMachineOfEachCell) {
    const std::vector<SweepCell> cells{made(0, 0, "n1", "A"), made(1, 0, "n2", "B")};
    const Merged merged = merge_cells(cells);
    const nlohmann::ordered_json json = to_json(merged);
    EXPECT_EQ(json["machine"]["cpu"], several_machines);
    EXPECT_EQ(json["times"]["cells"][1]["node"], "n2");
    EXPECT_EQ(json["times"]["cells"][1]["machine"]["cpu"], "B");
    EXPECT_EQ(machines_of(nlohmann::json::parse(json.dump())).size(), 2u);
    EXPECT_NE(machines_text(merged).find("  n2, B, 8 cores: 1 cell\n"), std::string::npos) << machines_text(merged);
    const std::string csv = to_csv(merged);
    EXPECT_NE(csv.find(",key,\"n1, A, 8 cores\","), std::string::npos) << csv;
    EXPECT_NE(csv.find(",key,\"n2, B, 8 cores\","), std::string::npos) << csv;
    EXPECT_NE(to_csv(cells[0].result).find(",key,\"A, 8 cores\","), std::string::npos) << "a run has it too";
}

// Two computers of one model are two machines, but one model.
TEST(MergeCells, TellsComputersOfOneModelApart) {
    const Merged merged = merge_cells(std::vector<SweepCell>{made(0, 0, "n1"), made(1, 0, "n2")});
    EXPECT_EQ(merged.result.machine.cpu, "A");
    EXPECT_EQ(machines_of(nlohmann::json::parse(to_json(merged).dump())).size(), 2u);
    EXPECT_TRUE(machines_of(nlohmann::json::parse(to_json(merged.result).dump())).empty());
}

// The second machine is ten times as fast. If its cell were ranked with that of the first, it would beat it.
TEST(MergeCells, RanksNoTimesOfDifferentMachines) {
    std::vector<SweepCell> cells{made(0, 0, "n1", "A"), made(1, 0, "n2", "B")};
    for (SweepCell& cell : cells) first_row(cell).times->on_front = metrics::OnFront::certainly;
    first_row(cells[1]).times->random_order.ns = summarise({0.75});
    const Merged merged = merge_cells(cells);
    for (const VariantResult& variant : merged.result.variants)
        EXPECT_EQ(variant.lights[0].cells[0].times->on_front, metrics::OnFront::certainly);
}

TEST(Disagreement, NamesTheTechniqueAndTheMeasure) {
    SweepCell other = made(0, 0, "n2");
    first_row(other).times->build_ms = summarise({99.0});
    other.result.times.seconds = 99.0;
    EXPECT_FALSE(disagreement(made(0, 0), other)) << "times may differ";
    first_row(other).bytes = 461;
    const auto found = disagreement(made(0, 0), other);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->measure, "deep tolerance=0.02: /bytes");
    EXPECT_EQ(found->one, "460");
    EXPECT_EQ(found->other, "461");
    other = made(0, 0);
    other.result.variants[0].lights[0].rays = 5;
    EXPECT_EQ(disagreement(made(0, 0), other)->measure, "/rays");
    other = made(0, 0);
    other.result.variants[0].lights[0].cells.pop_back();
    EXPECT_EQ(disagreement(made(0, 0), other)->measure, "/cells");
}

TEST(Disagreement, AllowsTheLastDigitsOnlyBetweenModels) {
    const auto differs = [](const std::string& cpu, double factor) {
        SweepCell other = made(0, 0, "n2", cpu);
        first_row(other).lookup->norms.rms *= factor;
        return disagreement(made(0, 0), other).has_value();
    };
    EXPECT_FALSE(differs("A", 1.0));
    EXPECT_TRUE(differs("A", 1.0 + 1e-9)) << "one model gives the same bits";
    EXPECT_FALSE(differs("B", 1.0 + 1e-9));
    EXPECT_TRUE(differs("B", 1.0 + 1e-5));
}

// Embree chooses its code by the processor.
TEST(Disagreement, LeavesOutWhatEmbreeAnswersOnAnotherModel) {
    const auto differs = [](const std::string& cpu) {
        SweepCell other = made(0, 0, "n2", cpu);
        other.result.variants[0].lights[0].cells[1].lookup->norms.rms = 0.2;
        return disagreement(made(0, 0), other).has_value();
    };
    EXPECT_TRUE(differs("A"));
    EXPECT_FALSE(differs("B"));
}

}  // namespace
}  // namespace shadowbench::results
