#include "bench/run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <nlohmann/json.hpp>

#include "bench/load.h"
#include "document/document.h"
#include "errors.h"
#include "results/report.h"
#include "temporary_folder.h"

namespace shadowbench::bench {
namespace {

using base::ErrorCode;
using nlohmann::json;

json quickstart() {
    std::ifstream file(std::string(SHADOWBENCH_SOURCE_DIR) + "/scenarios/quickstart.json");
    json document = json::parse(file);
    for (const char* assignment : {"rays.resolution=32", "receivers.resolution=[32,24]", "reference.queries=64",
                                   "reference.samples_per_pixel=16", "timing.repetitions=1", "timing.lookups=256",
                                   "scene.objects.0.strands=200"})
        document::set_value(document, assignment);
    return document;
}

json two_layers() {
    return json::parse(R"({
        "name": "two_layers",
        "scene": {"objects": [
            {"type": "quad", "corner": [-1, 1, -1], "edge_u": [1, 0, 0], "edge_v": [0, 0, 2], "opacity": [0.2, 0.5, 0.8]},
            {"type": "quad", "corner": [-1, 0, -1], "edge_u": [2, 0, 0], "edge_v": [0, 0, 2], "opacity": 0.5}]},
        "lights": [{"type": "directional", "name": "sun", "direction": [0, -1, 0]}],
        "rays": {"resolution": 16, "samples_per_pixel": 4},
        "receivers": {"type": "probes", "count": 500},
        "reference": {"samples_per_pixel": 64, "queries": 100, "spread_seeds": 0},
        "timing": {"repetitions": 2, "lookups": 128},
        "techniques": [{"type": "deep", "tolerance": 0.01}, {"type": "uncompressed"}]
    })");
}

nlohmann::ordered_json without_times(const json& document, const RunOptions& options) {
    nlohmann::ordered_json result = to_json(run(document, options, {}));
    results::strip_times(result);
    return result;
}

TEST(Run, without_times_measures_everything_else_alike) {
    RunOptions untimed;
    untimed.times = false;
    const results::Result result = run(two_layers(), untimed, {});
    const results::LightResult& light = result.variants.at(0).lights.at(0);
    EXPECT_FALSE(light.timing.has_value());
    ASSERT_EQ(light.cells.size(), 2u);
    const results::Result timed = run(two_layers(), {}, {});
    for (std::size_t c = 0; c < light.cells.size(); ++c) {
        const results::Cell &cell = light.cells[c], &other = timed.variants.at(0).lights.at(0).cells[c];
        EXPECT_TRUE(cell.status == results::CellStatus::ok);
        EXPECT_FALSE(cell.times.has_value());
        EXPECT_TRUE(other.times.has_value());
        EXPECT_EQ(cell.bytes, other.bytes);
        EXPECT_EQ(cell.lookup->norms.rms, other.lookup->norms.rms);
        EXPECT_EQ(cell.curve->norms.max, other.curve->norms.max);
        EXPECT_EQ(cell.verdict_why, other.verdict_why);
    }
}

TEST(Run, names_every_value_of_a_sweep_even_the_default) {
    json document = two_layers();
    document["techniques"] = {{{"type", "avsm"}, {"cells", "centre"}}, {{"type", "deep"}, {"kernel", "tent"}}};
    document["sweeps"] = {{"/techniques/0/nodes", {4, 8, 16}},
                          {"/techniques/0/order", {"sorted"}},
                          {"/techniques/1/tolerance", {"noise", 0.01}}};
    const results::Result result = run(document, {}, {});
    const std::vector<std::string> expected{"avsm nodes=4 order=sorted cells=centre",
                                            "avsm nodes=8 order=sorted cells=centre",
                                            "avsm nodes=16 order=sorted cells=centre",
                                            "deep tolerance=noise kernel=tent", "deep tolerance=0.01 kernel=tent"};
    const std::vector<results::Cell>& cells = result.variants[0].lights[0].cells;
    const std::string table = to_table(result), csv = results::to_csv(result);
    const auto written = to_json(result)["variants"][0]["lights"][0]["cells"];
    ASSERT_EQ(cells.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(results::title(cells[i]), expected[i]);
        EXPECT_NE(table.find("    " + expected[i] + " "), std::string::npos) << expected[i];
        EXPECT_NE(csv.find("," + cells[i].parameters + ","), std::string::npos) << expected[i];
        EXPECT_EQ(written[i]["label"], cells[i].parameters);
    }
    RunOptions only;
    only.only = {"deep"};
    EXPECT_EQ(results::title(run(document, only, {}).variants[0].lights[0].cells[0]), expected[3]);
}

// Those of the rows that write the parameter in which they differ say so, even if the value is the default.
TEST(Run, tells_rows_of_one_technique_apart) {
    json document = two_layers();
    const auto labels = [&](const json& techniques) {
        document["techniques"] = techniques;
        const document::Variant variant = document::expand(document).front();
        ScenarioLoader loader({});
        std::vector<std::string> titles;
        for (const Contender& each : make_contenders(loader.load(variant), variant))
            titles.push_back(results::title(each.cell));
        return titles;
    };
    using Titles = std::vector<std::string>;
    const json avsm{{"type", "avsm"}};
    const auto nodes = [](int count) { return json{{"type", "avsm"}, {"nodes", count}}; };
    EXPECT_EQ(labels({nodes(4), nodes(8), nodes(16)}), (Titles{"avsm nodes=4", "avsm nodes=8", "avsm nodes=16"}));
    EXPECT_EQ(labels({avsm, nodes(8), nodes(16)}), (Titles{"avsm", "avsm nodes=8", "avsm nodes=16"}));
    EXPECT_EQ(labels(json::array({nodes(8)})), Titles{"avsm"});
    EXPECT_EQ(labels({nodes(8), nodes(8)}), (Titles{"avsm", "avsm"})) << "they are equal";
    EXPECT_EQ(labels({avsm, nodes(4)}), (Titles{"avsm", "avsm nodes=4"}));
    EXPECT_EQ(labels({{{"type", "avsm"}, {"nodes", 8}, {"cells", "centre"}}, nodes(4), {{"type", "deep"}}}),
              (Titles{"avsm nodes=8 cells=centre", "avsm nodes=4", "deep"}));
    EXPECT_EQ(labels({{{"type", "deep"}, {"tolerance", 0.02}}, {{"type", "deep"}, {"tolerance", 0.0200001}}}),
              (Titles{"deep tolerance=0.02", "deep tolerance=0.0200001"}));
}

TEST(Run, gives_the_same_numbers_on_one_thread_and_on_two) {
    RunOptions one, two;
    one.threads = 1;
    two.threads = 2;
    EXPECT_EQ(without_times(quickstart(), one), without_times(quickstart(), two));
}

TEST(Run, gives_the_same_numbers_if_rays_are_captured_again) {
    RunOptions kept, recaptured;
    recaptured.limits.kept_rays = 0;
    nlohmann::ordered_json a = without_times(quickstart(), kept), b = without_times(quickstart(), recaptured);
    EXPECT_EQ(a["variants"][0]["lights"][0]["rays_kept"], true);
    EXPECT_EQ(b["variants"][0]["lights"][0]["rays_kept"], false);
    for (auto* result : {&a, &b}) (*result)["variants"][0]["lights"][0].erase("rays_kept");
    EXPECT_EQ(a, b);
}

TEST(Run, checks_all_channels_of_a_coloured_scene_in_one_map_or_three) {
    const results::Result result = run(two_layers(), {}, {});
    const results::LightResult& light = result.variants[0].lights[0];
    EXPECT_EQ(light.layout.channels, 3);
    for (const results::Cell& cell : light.cells) {
        EXPECT_EQ(cell.status, results::CellStatus::ok) << cell.reason;
        const bool one_map = techniques::find(cell.technique, "").coloured;
        EXPECT_EQ(cell.curve->cells, (one_map ? 3 : 1) * cell.nodes.cells) << cell.technique;
        EXPECT_LE(cell.curve->norms.max, cell.error_bound + 1e-6) << cell.technique;
    }
    EXPECT_EQ(light.cells[0].technique, "deep");
    EXPECT_EQ(light.cells[0].nodes.cells, 16u * 16) << "one map of all channels";
    EXPECT_EQ(light.agreement->other_crossings, 0u);
    EXPECT_EQ(light.agreement->other_transmittance, 0u);
}

TEST(Run, expands_sweeps_and_records_their_settings) {
    json document = two_layers();
    document["sweeps"] = {{"/rays/samples_per_pixel", {1, 4}}, {"/techniques/0/tolerance", {0.01, 0.1}}};
    const results::Result result = run(document, {}, {});
    ASSERT_EQ(result.variants.size(), 2u);
    EXPECT_EQ(result.variants[1].settings[0].value, "4");
    ASSERT_EQ(result.variants[1].lights[0].cells.size(), 3u);
    EXPECT_EQ(result.variants[1].lights[0].cells[1].parameters, "tolerance=0.1");
    EXPECT_EQ(result.variants[0].lights[0].rays, 256u);
    EXPECT_EQ(result.variants[1].lights[0].rays, 1024u);
}

TEST(Run, reports_its_progress) {
    std::vector<std::string> stages;
    run(two_layers(), {}, [&](const Progress& progress) {
        EXPECT_LE(progress.done, progress.total);
        if (stages.empty() || stages.back() != progress.stage) stages.push_back(progress.stage);
    });
    ASSERT_GE(stages.size(), 3u);
    EXPECT_EQ(stages[0], "load");
    EXPECT_EQ(stages[1], "reference");
    EXPECT_EQ(stages.back(), "timing lookups");
}

TEST(Run, refuses_more_memory_than_allowed_before_it_works) {
    json document = two_layers();
    document["rays"] = {{"resolution", 4096}, {"samples_per_pixel", 64}};
    RunOptions options;
    options.limits.all = std::size_t{1} << 30;
    const std::string message = test::error_of([&] { run(document, options, {}); }, ErrorCode::bad_input, "/rays");
    EXPECT_NE(message.find("GiB"), std::string::npos) << message;
    test::error_of([&] { validate(document, options); }, ErrorCode::bad_input, "/rays");
}

TEST(Run, counts_the_maps_and_the_reference_against_the_memory_limit) {
    json document = two_layers();
    document["rays"] = {{"resolution", 16384}, {"samples_per_pixel", 1}};
    document["techniques"] = {{{"type", "shadow_map"}}};
    document["reference"]["samples_per_pixel"] = 65536;
    test::error_of([&] { validate(document, {}); }, ErrorCode::bad_input, "/rays");
    document["reference"]["samples_per_pixel"] = 16;
    EXPECT_NO_THROW(validate(document, {}));
    document["techniques"] = {{{"type", "avsm"}, {"nodes", 64}}};
    test::error_of([&] { validate(document, {}); }, ErrorCode::bad_input, "/rays");
}

TEST(Run, refuses_a_camera_that_sees_nothing_in_the_lights_map) {
    json document = two_layers();
    document["receivers"] = {{"type", "camera"}, {"position", {0, 5, 5}}, {"target", {0, 50, 5}}, {"up", {0, 0, 1}}};
    test::error_of([&] { run(document, {}, {}); }, ErrorCode::bad_input, "/receivers");
}

// Every technique, opaque and translucent, with an aperture of its own or none, meets a map without a single segment.
TEST(Run, finds_everything_lit_if_the_light_sees_nothing) {
    json document = json::parse(R"({
        "name": "nothing",
        "scene": {"objects": [
            {"type": "sphere", "centre": [0, 0, 0], "radius": 1, "opacity": [0.2, 0.5, 0.8]},
            {"type": "particles", "centres": [[0, -2, 0]], "radii": [0.9], "density": [1]}]},
        "lights": [{"type": "directional", "direction": [0, -1, 0], "target": [0.9, 0, 0.9], "extent": [0.1, 0.1]},
                   {"type": "spot", "position": [0.9, 4, 0.9], "target": [0.9, 0, 0.9], "angle": 1}],
        "rays": {"resolution": [8, 4], "samples_per_pixel": 4},
        "receivers": {"type": "probes", "count": 200, "filter_width": 2},
        "reference": {"samples_per_pixel": 16, "queries": 50, "spread_seeds": 2},
        "timing": {"repetitions": 1, "lookups": 64}
    })");
    for (const techniques::Technique& row : techniques::all()) document["techniques"].push_back({{"type", row.id}});
    const results::Result result = run(document, {}, {});
    for (const results::LightResult& light : result.variants[0].lights) {
        EXPECT_TRUE(results::sees_nothing(light));
        EXPECT_FALSE(light.translucent);
        EXPECT_EQ(light.reference.error_max, 0.0);
        for (const results::Cell& cell : light.cells) {
            EXPECT_EQ(cell.status, results::CellStatus::ok)
                << light.name << " " << cell.technique << ": " << cell.reason;
            ASSERT_TRUE(cell.lookup) << cell.technique;
            EXPECT_EQ(cell.lookup->norms.max, 0.0) << light.name << " " << cell.technique;
            EXPECT_EQ(cell.curve ? cell.curve->norms.max : 0.0, 0.0) << light.name << " " << cell.technique;
            ASSERT_TRUE(cell.times) << cell.technique;
            EXPECT_TRUE(std::isfinite(cell.times->ns_per_segment)) << cell.technique;
        }
    }
    EXPECT_NE(to_table(result).find("note: the light sees nothing"), std::string::npos);
}

// No light is left behind the ball, but a technique that takes its front for a wall errs inside it.
TEST(Run, does_not_count_a_medium_as_opaque_if_no_light_leaves_it) {
    json document = two_layers();
    document["scene"]["objects"] = {
        {{"type", "particles"}, {"centres", {{0, 0, 0}}}, {"radii", {4}}, {"density", {1e4}}}};
    document["lights"][0]["extent"] = {2, 2};
    document["techniques"] = {{{"type", "shadow_map"}}};
    const results::LightResult light = run(document, {}, {}).variants[0].lights[0];
    EXPECT_TRUE(light.translucent);
    EXPECT_EQ(light.cells[0].status, results::CellStatus::ok) << light.cells[0].reason;
    EXPECT_TRUE(light.cells[0].outside_promise);
    EXPECT_GT(light.cells[0].curve->norms.max, 0.9);
}

TEST(Run, takes_given_points_and_refuses_them_if_all_are_outside_the_map) {
    json document = two_layers();
    document["receivers"] = {{"type", "points"},
                             {"positions", {{-0.5, 0.5, 0}, {0.5, 0.5, 0}, {-0.5, 1.5, 0}, {0, 0, 9}}}};
    document["techniques"] = {{{"type", "uncompressed"}}};
    const results::LightResult light = run(document, {}, {}).variants[0].lights[0];
    EXPECT_EQ(light.receivers, 3u);
    EXPECT_EQ(light.dropped, 1u);
    EXPECT_EQ(light.reference.judged, 3u);
    EXPECT_LT(light.cells[0].lookup->norms.max, 1e-6) << "no edge is near them";
    document["receivers"]["positions"] = {{0, 0, 9}, {7, 0, 0}};
    const std::string message = test::error_of([&] { run(document, {}, {}); }, ErrorCode::bad_input, "/receivers");
    EXPECT_NE(message.find("none of the 2 receivers"), std::string::npos) << message;
}

TEST(Run, refuses_a_technique_that_a_deep_image_cannot_serve) {
    const std::filesystem::path data = std::string(SHADOWBENCH_SOURCE_DIR) + "/../shared/data";
    if (!std::filesystem::exists(data / "deep/leaves.exr")) GTEST_SKIP() << "deep/leaves.exr does not exist";
    const json document = json::parse(R"({"name": "deep", "scene": {"deep_image": {"file": "deep/leaves.exr"}},
        "receivers": {"type": "probes", "count": 100}, "techniques": [{"type": "deep"}, {"type": "ray_traced"}]})");
    RunOptions options;
    options.data = {data};
    test::error_of([&] { validate(document, options); }, ErrorCode::bad_input, "/techniques/1");
    test::error_of([&] { run(document, options, {}); }, ErrorCode::bad_input, "/techniques/1");
}

TEST(Run, tells_which_objects_are_loaded) {
    json document = two_layers();
    document["sweeps"] = {{"/scene/objects/1/opacity", {0.5, 0.25}}};
    std::vector<std::string> told;
    const auto note = [&](const Progress& progress) {
        if (std::string(progress.stage) == "load")
            told.push_back(progress.place + " " + std::to_string(progress.done) + "/" + std::to_string(progress.total));
    };
    run(document, {}, note);
    EXPECT_EQ(told, (std::vector<std::string>{"1/2 0/2", "1/2 1/2", "1/2 2/2", "2/2 0/2", "2/2 1/2", "2/2 2/2"}));
    told.clear();
    validate(document, {}, note);
    EXPECT_EQ(told.size(), 6u);
}

TEST(ScenarioLoader, reads_files_once_for_variants_of_one_scene) {
    const TemporaryFolder folder;
    const std::string file = folder.path("loader.obj");
    std::ofstream(file) << "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n";
    json document = two_layers();
    document["scene"] = {{"objects", {{{"type", "mesh"}, {"file", file}}}}};
    document["sweeps"] = {{"/rays/seed", {1, 2}}};
    const std::vector<document::Variant> variants = document::expand(document);
    ScenarioLoader loader({});
    const base::Vec3d target = loader.load(variants[0]).lights[0].target;
    std::remove(file.c_str());
    const scene::Scenario& second = loader.load(variants[1]);
    EXPECT_EQ(second.rays.seed, 2u);
    EXPECT_EQ(second.scene.objects.size(), 1u);
    EXPECT_EQ(second.lights[0].target, target) << "which depends on the scene's bounds";
}

TEST(Run, writes_results_that_read_back_unchanged) {
    json document = quickstart();
    document["sweeps"] = {{"/rays/samples_per_pixel", {4, 9}}};
    const results::Result result = run(document, {}, {});
    const results::Result read = results::from_json(json::parse(to_json(result).dump()), "");
    EXPECT_EQ(to_json(read), to_json(result));
    EXPECT_EQ(to_table(read), to_table(result));
}

TEST(Run, repeats_between_the_least_and_the_most_repetitions) {
    const auto repetitions = [](const json& timing) {
        json document = two_layers();
        document["timing"] = timing;
        const results::LightResult light = run(document, {}, {}).variants[0].lights[0];
        std::vector<std::size_t> counts;
        for (const results::Cell& cell : light.cells)
            for (const results::Sample* sample :
                 {&cell.times->build_ms, &cell.times->image_order.ns, &cell.times->random_order.ns})
                counts.push_back(sample->raw.size());
        EXPECT_EQ(light.timing->goal, timing.value("goal", 0.05));
        EXPECT_EQ(light.timing->builds.passes, counts[0] + counts[3]);
        EXPECT_EQ(light.timing->lookups.passes, 2 * (counts[1] + counts[2] + counts[4] + counts[5])) << "with floors";
        EXPECT_EQ(counts[0], counts[3]) << "all techniques are in all rounds";
        EXPECT_EQ(counts[1], counts[4]);
        EXPECT_EQ(counts[1], counts[2]);
        return std::vector<std::size_t>{counts[0], counts[1]};
    };
    const std::vector<std::size_t> two{2, 2}, five{5, 5}, eight{8, 8};
    EXPECT_EQ(repetitions({{"repetitions", 2}, {"lookups", 64}}), two) << "so few are fixed";
    EXPECT_EQ(repetitions({{"repetitions", 5}, {"most_repetitions", 5}, {"lookups", 64}}), five);
    EXPECT_EQ(repetitions({{"repetitions", 5}, {"seconds", 0}, {"lookups", 64}}), five);
    // Lookups in random order vary by more than a billionth; builds may be too short to show it.
    const json strict{{"repetitions", 5}, {"most_repetitions", 8}, {"goal", 1e-9}, {"seconds", 86400}, {"lookups", 64}};
    EXPECT_EQ(repetitions(strict)[1], eight[1]);
}

TEST(Run, says_what_the_readers_of_files_left_out) {
    const TemporaryFolder folder;
    std::ofstream(folder.path() / "a.obj") << "V 0 1 0\nv 0 1 0\nv 1 1 0\nv 1 1 -1\nv 0 1 -1\nf 1 2 3 4\nf 1 2\n";
    json document = two_layers();
    document["scene"]["objects"][0] = {{"type", "mesh"}, {"file", "a.obj"}};
    document["sweeps"] = {{"/scene/objects/1/opacity", {0.5, 0.25}}};
    const RunOptions options{{folder.path()}, {}, 0, {}};
    const results::Result result = run(document, options, {});
    ASSERT_EQ(result.notes.size(), 1u) << "both variants have the same";
    EXPECT_EQ(
        result.notes[0],
        "/scene/objects/0: passed over: lines of the unknown keyword \"V\" (1), faces of fewer than 3 corners (1)");
    EXPECT_EQ(result.notes, validate(document, options).notes);
    ASSERT_EQ(result.files.size(), 1u) << "both variants have the same";
    EXPECT_EQ(result.files[0], "/scene/objects/0/file: a.obj: 4 vertices, 2 triangles; box [0, 1, -1] to [1, 1, 0]");
    EXPECT_EQ(result.files, validate(document, options).files);
    EXPECT_NE(to_table(result).find("  note: " + result.notes[0] + "\n"), std::string::npos);
    EXPECT_EQ(results::from_json(json::parse(to_json(result).dump()), "").notes, result.notes);
}

TEST(Validate, estimates_the_cost_of_a_run) {
    json document = two_layers();
    const Validated small = validate(document, {});
    EXPECT_EQ(small.largest_side, 16);
    EXPECT_EQ(small.most_samples, 64) << "the truth's";
    EXPECT_GT(small.least_bytes, 0.0);
    EXPECT_GT(small.seconds, 0.0);
    document["rays"] = {{"resolution", {512, 256}}, {"samples_per_pixel", 100}};
    const Validated large = validate(document, {});
    EXPECT_EQ(large.largest_side, 512);
    EXPECT_EQ(large.most_samples, 100);
    EXPECT_GT(large.least_bytes, 10 * small.least_bytes);
    EXPECT_GT(large.seconds, 10 * small.seconds);
    document["sweeps"] = {{"/rays/seed", {1, 2, 3}}};
    EXPECT_NEAR(validate(document, {}).seconds, 3 * large.seconds, 1e-9 * large.seconds);
    EXPECT_EQ(validate(document, {}).least_bytes, large.least_bytes) << "one variant at a time";
}

// A run gives kept rays up, so a limit between what it needs and that with all rays refuses nothing.
TEST(Validate, refuses_only_what_does_not_fit_without_kept_rays) {
    json document = two_layers();
    document["rays"] = {{"resolution", {512, 512}}, {"samples_per_pixel", 64}};
    RunOptions options;
    options.threads = 1;      // the more threads, the more rays are in flight
    options.only = {"deep"};  // whose map is smaller than the rays
    const auto need = static_cast<std::size_t>(validate(document, options).least_bytes);
    constexpr std::size_t all_rays = std::size_t{512} * 512 * 64 * 12;
    ASSERT_LT(need, all_rays) << "of which only some are in flight";
    options.limits.all = all_rays;
    EXPECT_NO_THROW(validate(document, options));
    options.limits.all = need + 1;
    EXPECT_NO_THROW(validate(document, options));
    options.limits.all = need - 1;
    try {
        validate(document, options);
        FAIL() << "less than the rays in flight and the maps";
    } catch (const base::Error& error) {
        EXPECT_EQ(error.where(), "/rays");
    }
}

}  // namespace
}  // namespace shadowbench::bench
