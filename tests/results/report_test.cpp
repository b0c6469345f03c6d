#include "results/report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <sstream>

#include <nlohmann/json.hpp>

#include "errors.h"

namespace shadowbench::results {
namespace {

Result small_result() {
    Result result;
    result.name = "small";
    result.purpose = "says, \"why\"";
    result.document = R"({"name": "small"})";
    Cell good;
    good.technique = "deep";
    good.parameters = "tolerance=0.02";
    good.parameters_json = R"({"tolerance": 0.02})";
    good.error_bound = std::numeric_limits<double>::infinity();
    good.lookup = LookupErrors{{0.5, 0.25, 0.125, 0.4}, -0.1, RmsInterval{0.2, 0.3, true}, 0.0625};
    good.over_seeds = {{{0.5, 0.26, 0.125, 0.4}, 7}, {{0.5, 0.24, 0.125, 0.4}, 9}};
    good.on_bytes_front = metrics::OnFront::certainly;
    good.curve = CurveErrors{3, 1e-5, {0.5, 0.25, 0.125, 0.4}, 0.75, 1, 2, 0.0625, -0.03125};
    good.verdict = Verdict::degraded;
    good.verdict_why = "rises by up to 0.0625";
    good.nodes = {3, 7, 4, {0, 1, 1, 0, 1}};
    good.times = CellTimes{};
    good.times->build_ms = summarise({3.0, 1.0, 2.0});
    good.times->image_order.ns = summarise({2.5});
    good.times->random_order.ns = summarise({7.5});
    Cell bad = good;
    bad.status = CellStatus::failed;
    bad.reason = "cell (3, 4): it \"rises\", a lot";
    bad.verdict = Verdict::failed;
    bad.verdict_why = bad.reason;
    bad.times.reset();
    bad.lookup.reset();
    bad.over_seeds.clear();
    bad.on_bytes_front = metrics::OnFront::no;
    LightResult light;
    light.name = "key";
    light.cells = {good, bad};
    result.variants = {{{{"/rays/seed", "[1,2]"}}, {light}}};
    return result;
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

TEST(ResultJson, keeps_raw_times_and_shows_none_of_a_failed_cell) {
    const nlohmann::ordered_json json = to_json(small_result());
    const auto& cells = json["variants"][0]["lights"][0]["cells"];
    EXPECT_EQ(cells[0]["times"]["build_ms"]["median"], 2.0);
    EXPECT_EQ(cells[0]["times"]["build_ms"]["raw"], (std::vector<double>{3.0, 1.0, 2.0}));
    EXPECT_TRUE(cells[0]["promised_curve_error"].is_null()) << "JSON has no infinity";
    EXPECT_TRUE(cells[0]["times"]["lookup_random_order"]["floor_ns"].is_null());
    EXPECT_TRUE(cells[1]["times"].is_null());
    EXPECT_EQ(cells[1]["status"], "failed");
    EXPECT_EQ(json["variants"][0]["settings"]["/rays/seed"], (std::vector<int>{1, 2}));
}

TEST(ResultJson, gives_every_cell_a_verdict) {
    const nlohmann::ordered_json json = to_json(small_result());
    const auto& cells = json["variants"][0]["lights"][0]["cells"];
    EXPECT_EQ(cells[0]["verdict"], "degraded");
    EXPECT_EQ(cells[0]["verdict_why"], "rises by up to 0.0625");
    EXPECT_EQ(cells[1]["verdict"], "failed");
    EXPECT_EQ(cells[1]["verdict_why"], cells[1]["reason"]);
    EXPECT_EQ(json["schema_version"], 1) << "new keys do not change the meaning of old ones";
}

TEST(ResultJson, holds_the_clock_under_times_only) {
    Result one = small_result(), other = small_result();
    other.times = {"2026-01-01T00:00:00Z", 5.0, 8};
    LightResult& light = other.variants[0].lights[0];
    light.times = {1.0, 2.0, 3.0};
    light.cells[0].times->build_ms = summarise({30.0});
    light.cells[0].times->lookups = 64;
    light.cells[0].times->on_front = metrics::OnFront::certainly;
    nlohmann::ordered_json a = to_json(one), b = to_json(other);
    EXPECT_NE(a, b);
    strip_times(a);
    strip_times(b);
    EXPECT_EQ(a, b);
    EXPECT_EQ(a.dump().find("\"times\""), std::string::npos);
}

TEST(ResultJson, comes_back_as_the_same_result) {
    const nlohmann::ordered_json written = to_json(small_result());
    const Result read = from_json(nlohmann::json::parse(written.dump()), "");
    EXPECT_EQ(to_json(read), written);
    EXPECT_EQ(to_table(read), to_table(small_result()));
    EXPECT_EQ(to_csv(read), to_csv(small_result()));
}

TEST(ResultJson, says_how_certainly_a_cell_is_on_a_front) {
    Result result = small_result();
    Cell& cell = result.variants[0].lights[0].cells[0];
    cell.times->on_front = metrics::OnFront::perhaps;
    nlohmann::json json = to_json(result);
    nlohmann::json& written = json["variants"][0]["lights"][0]["cells"][0];
    EXPECT_EQ(written["times"]["on_time_error_front"], "perhaps");
    EXPECT_EQ(written["on_bytes_error_front"], "certainly");
    EXPECT_NE(to_table(result).find("  T? B  "), std::string::npos) << to_table(result);
    EXPECT_NE(to_csv(result).find(",perhaps,certainly,"), std::string::npos) << to_csv(result);
    // Earlier programs compared values without intervals.
    written["times"]["on_time_error_front"] = true;
    written["on_bytes_error_front"] = false;
    const Result read = from_json(json, "");
    EXPECT_EQ(read.variants[0].lights[0].cells[0].times->on_front, metrics::OnFront::perhaps);
    EXPECT_EQ(read.variants[0].lights[0].cells[0].on_bytes_front, metrics::OnFront::no);
    const nlohmann::json again = to_json(read);
    EXPECT_EQ(again["variants"][0]["lights"][0]["cells"][0]["on_bytes_error_front"], "no");
    EXPECT_EQ(nlohmann::json(to_json(from_json(again, ""))), again);
}

TEST(ResultJson, names_the_library_of_a_technique_from_outside) {
    Result result = small_result();
    Cell& cell = result.variants[0].lights[0].cells[0];
    cell.library = TechniqueLibrary{"libdeep.so", "0123456789abcdef", true};
    const nlohmann::ordered_json json = to_json(result);
    const auto& cells = json["variants"][0]["lights"][0]["cells"];
    EXPECT_EQ(cells[0]["library"].dump(), R"({"file":"libdeep.so","hash":"0123456789abcdef","isolated":true})");
    EXPECT_FALSE(cells[1].contains("library"));
    EXPECT_EQ(to_json(from_json(nlohmann::json::parse(json.dump()), "")), json);
    EXPECT_NE(
        to_table(result).find("    external: deep from libdeep.so, hash 0123456789abcdef, in processes of its own"),
        std::string::npos);
    EXPECT_NE(to_csv(result).find(",deep,0,0123456789abcdef,tolerance=0.02,"), std::string::npos);
}

TEST(ResultJson, gives_the_nodes_over_the_fewest_where_they_are_known) {
    Result result = small_result();
    Cell& cell = result.variants[0].lights[0].cells[0];
    cell.nodes.over_fewest = FewestNodes{1000, 2, 5000, 4000, {1.125, 1.375}};
    const nlohmann::ordered_json json = to_json(result);
    const auto& cells = json["variants"][0]["lights"][0]["cells"];
    EXPECT_EQ(cells[0]["nodes"]["over_fewest"].dump(),
              R"({"ratio":1.25,"interval95":[1.125,1.375],"cells":1000,"left_out":2,"nodes":5000,"fewest":4000})");
    EXPECT_FALSE(cells[1]["nodes"].contains("over_fewest"));
    EXPECT_EQ(to_json(from_json(nlohmann::json::parse(json.dump()), "")), json);
    EXPECT_NE(to_csv(result).find(",nodes_over_fewest,1,1.25,1.125,1.375,cells,"), std::string::npos) << to_csv(result);
    EXPECT_NE(to_table(result).find("  1.250  "), std::string::npos) << to_table(result);
    nlohmann::json none = nlohmann::json::parse(json.dump());
    none["variants"][0]["lights"][0]["cells"][0]["nodes"]["over_fewest"]["fewest"] = 0;
    test::error_of([&] { from_json(none, "a"); }, base::ErrorCode::bad_input,
                   "a: /variants/0/lights/0/cells/0/nodes/over_fewest/fewest");
}

TEST(ResultJson, of_an_earlier_program_has_no_intervals) {
    nlohmann::json json = to_json(small_result());
    nlohmann::json& cell = json["variants"][0]["lights"][0]["cells"][0];
    cell.erase("over_seeds");
    for (const char* key : {"rms_interval95", "rms_interval_covers", "truth_sd"}) cell["lookup_error"].erase(key);
    const Result read = from_json(json, "");
    EXPECT_FALSE(read.variants[0].lights[0].cells[0].lookup->interval);
    EXPECT_EQ(to_json(read)["variants"][0]["lights"][0]["cells"][0]["lookup_error"]["rms_interval95"], nullptr);
}

TEST(ResultTable, shows_the_interval_of_the_rms_and_what_it_covers) {
    Result result = small_result();
    EXPECT_NE(to_table(result).find("  0.2-0.3  "), std::string::npos) << to_table(result);
    RmsInterval& interval = *result.variants[0].lights[0].cells[0].lookup->interval;
    interval = {0.24, 0.26, false};
    EXPECT_NE(to_table(result).find("  0.24-0.26?  "), std::string::npos) << to_table(result);
    EXPECT_NE(to_csv(result).find(",0.24,0.26,truth,"), std::string::npos) << to_csv(result);
}

TEST(ResultJson, has_notes_and_lines_of_files_only_if_there_are_some) {
    Result result = small_result();
    EXPECT_FALSE(to_json(result).contains("notes"));
    EXPECT_FALSE(to_json(result).contains("files"));
    result.files = {"/scene/objects/0/file: a.obj: 3 vertices, 1 triangles"};
    result.notes = {"/scene/objects/0: passed over: lines (2)", "/scene/objects/1: \"b\""};
    const nlohmann::ordered_json written = to_json(result);
    EXPECT_EQ(written["notes"], result.notes);
    const Result read = from_json(nlohmann::json::parse(written.dump()), "");
    EXPECT_EQ(read.notes, result.notes);
    EXPECT_EQ(read.files, result.files);
    EXPECT_EQ(to_json(read), written);
}

TEST(ResultJson, of_the_wrong_form_is_refused_at_its_place) {
    const auto refused = [](const char* pointer, const nlohmann::json& value, const std::string& where) {
        nlohmann::json json = to_json(small_result());
        json[nlohmann::json::json_pointer(pointer)] = value;
        test::error_of([&] { from_json(json, "file"); }, base::ErrorCode::bad_input, "file: " + where);
    };
    const std::string light = "/variants/0/lights/0";
    refused("/variants/0/lights/0/cells/1/bytes", "many", light + "/cells/1/bytes");
    refused("/variants/0/lights/0/map", 3, light + "/map");
    refused("/variants", "none", "/variants");
    refused("/schema_version", 2, "/schema_version");
    refused("/notes", {"one", 2}, "/notes/1");
    refused("/files", {3}, "/files/0");
    refused("/variants/0/lights/0/cells/0/on_bytes_error_front", "maybe", light + "/cells/0/on_bytes_error_front");
    refused("/variants/0/lights/0/cells/0/lookup_error/rms_interval95", {1.0},
            light + "/cells/0/lookup_error/rms_interval95");
    refused("/variants/0/lights/0/cells/0/lookup_error/rms_interval_covers", "all",
            light + "/cells/0/lookup_error/rms_interval_covers");
    test::error_of([] { from_json(nlohmann::json::array(), ""); }, base::ErrorCode::bad_input, "");
}

std::size_t rows_with(const std::vector<std::string>& lines, const std::string& part) {
    return static_cast<std::size_t>(std::count_if(
        lines.begin(), lines.end(), [&](const std::string& l) { return l.find(part) != std::string::npos; }));
}

TEST(ResultCsv, has_a_row_a_measure_and_quotes_what_needs_it) {
    Result result = small_result();
    result.variants[0].lights[0].cells[1].curve.reset();
    const std::vector<std::string> lines = lines_of(to_csv(result));
    EXPECT_EQ(lines[0].rfind("scenario,", 0), 0u);
    EXPECT_TRUE(lines[0].ends_with(",quiet,measure,unit,value,low,high,interval_covers,narrow")) << lines[0];
    EXPECT_EQ(rows_with(lines, ",build_ms,ms,2,1,3,repetitions,"), 1u) << "the median and its interval";
    EXPECT_EQ(rows_with(lines, ",lookup_random_ns,ns,7.5,"), 1u);
    EXPECT_EQ(rows_with(lines, ",lookup_random_ratio,"), 0u) << "what was not measured has no row";
    EXPECT_EQ(rows_with(lines, ",lookup_error_rms,visibility,0.25,0.2,0.3,truth and rays,"), 1u);
    EXPECT_EQ(rows_with(lines, ",nodes_total,nodes,7,,,,"), 1u) << "an exact measure has no interval";
    EXPECT_EQ(rows_with(lines, ",failed,\"cell (3, 4): it \"\"rises\"\", a lot\","), 1u) << "a failed cell is not lost";
    EXPECT_TRUE(lines.back().ends_with(",,,,,,,")) << "and has no measure: " << lines.back();
    EXPECT_EQ(rows_with(lines, ",\"/rays/seed=[1,2]\",key,"), lines.size() - 1);
    // Outside quotes, every line has as many commas as the header.
    const auto commas = [](const std::string& line) {
        bool quoted = false;
        return std::count_if(line.begin(), line.end(), [&](char c) {
            if (c == '"') quoted = !quoted;
            return c == ',' && !quoted;
        });
    };
    for (const std::string& line : lines) EXPECT_EQ(commas(line), commas(lines[0])) << line;
}

TEST(ResultTable, shows_dashes_for_the_times_of_a_failed_cell) {
    const std::string table = to_table(small_result());
    const std::vector<std::string> lines = lines_of(table);
    const auto line = std::find_if(lines.begin(), lines.end(), [](const std::string& l) {
        return l.find("failed: cell (3, 4)") != std::string::npos;
    });
    ASSERT_NE(line, lines.end()) << table;
    EXPECT_NE(line->find(" -  "), std::string::npos) << *line;
    EXPECT_EQ(line->find("7.50"), std::string::npos) << *line;
}

TEST(ResultTable, shows_at_most_five_notes_under_the_heading) {
    Result result = small_result();
    for (int i = 0; i < 5; ++i) result.notes.push_back("note " + std::to_string(i));
    std::vector<std::string> lines = lines_of(to_table(result));
    EXPECT_EQ(lines[1], "  note: note 0");
    EXPECT_EQ(lines[5], "  note: note 4");
    EXPECT_EQ(lines[6], "/rays/seed = [1,2]");
    result.notes.insert(result.notes.end(), {"note 5", "note 6"});
    lines = lines_of(to_table(result));
    EXPECT_EQ(lines[5], "  note: note 4");
    EXPECT_EQ(lines[6], "  and 2 more: shadowbench validate shows them");
    EXPECT_EQ(lines[7], "/rays/seed = [1,2]");
}

TEST(ResultTable, warns_where_the_capture_and_embree_disagree) {
    Result result = small_result();
    LightResult& light = result.variants[0].lights[0];
    const auto agreed = [&] {
        return to_json(result)["variants"][0]["lights"][0]["capture"]["embree_check"]["agrees"].get<bool>();
    };
    light.agreement = Agreement{20000, 20, 3, {}};
    EXPECT_TRUE(agreed());
    EXPECT_EQ(to_table(result).find("WARNING"), std::string::npos);
    light.agreement->other_transmittance = 21;
    EXPECT_FALSE(agreed());
    EXPECT_NE(to_table(result).find("WARNING"), std::string::npos);
    light.agreement = Agreement{100, 3, 3, {}};
    EXPECT_TRUE(agreed()) << "three rays are few, whatever their share";
}

TEST(ResultTable, says_which_errors_cover_a_share_of_the_cells) {
    Result result = small_result();
    Cell& cell = result.variants[0].lights[0].cells[0];
    cell.curve = CurveErrors{};
    cell.curve->cells = cell.nodes.cells = 1000;
    EXPECT_EQ(to_table(result).find("a share"), std::string::npos);
    cell.nodes.cells = 4000;
    EXPECT_NE(to_table(result).find("covers a share of the cells: deep tolerance=0.02 (1,000 of 4,000)"),
              std::string::npos);
}

}  // namespace
}  // namespace shadowbench::results
