#include "claims/report.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "base/read_text.h"
#include "temporary_folder.h"

namespace shadowbench::claims {
namespace {

PaperReport report() {
    PaperReport r;
    r.id = "x2000";
    r.title = "A paper";
    r.conditions = "On paper.";
    r.documents = {"scene 0123"};
    r.claims = {
        {"section 1", "a | b is 2", "2.1 [2, 2.2]", judge_ratio(2, {2.1, 2.0, 2.2}), "So it is.", {{2.1, 2.0, 2.2}}},
        {"section 3", "d is 4", "5", judge_ratio(4, {5, 4, 7}), "It may be.", {exactly(5)}},
        {"section 2", "c is 3", "0.1", judge_ratio(3, exactly(0.1)), "So it is not.", {exactly(0.1)}}};
    r.tables = {{"Numbers", {"a", "b"}, {{"1", "2"}}}};
    r.plots = {{"x2000_figure1", "It's a title", "x", "y", true, true, {{"one", {{1, 1}, {10, 2}}, true}}}};
    return r;
}

const Conditions conditions{false, "a machine", "a build", "2000-01-01"};

TEST(Report, EveryClaimIsARowAndVerdictsAreCounted) {
    const std::vector<PaperReport> reports{report()};
    const std::string text = to_markdown(reports, conditions);
    EXPECT_NE(text.find("Of 3 claims: holds 1, holds in shape 0, does not hold here 1, undecided 1, not comparable 0, "
                        "by construction 0."),
              std::string::npos);
    EXPECT_NE(text.find("| section 1 | a \\| b is 2 | 2.1 [2, 2.2] | ratio: holds in [1.33, 3], in shape in [1, 6] | "
                        "**holds** | So it is. |"),
              std::string::npos)
        << "a bar must not end the cell";
    EXPECT_NE(text.find("| undecided (holds to holds in shape) | It may be. |"), std::string::npos);
    EXPECT_NE(text.find("| gain | A is r times better than B |"), std::string::npos) << "the table of rules";
    EXPECT_NE(text.find("| acceptable | not comparable |"), std::string::npos) << "the table of words";
    EXPECT_NE(text.find("| 1 | 2 |"), std::string::npos);
    EXPECT_NE(text.find("plots/x2000_figure1.svg"), std::string::npos);
    EXPECT_EQ(text.find("Quick run"), std::string::npos);
    EXPECT_NE(text.find("a machine; a build; 2000-01-01.\n\nOf 3 claims"), std::string::npos) << "no steal is known";
}

TEST(Report, AQuickOneSaysWhatItStandsBeside) {
    const std::vector<PaperReport> reports{report()};
    EXPECT_NE(to_markdown(reports, {true, "", "", ""}).find("no full report beside it"), std::string::npos);
    EXPECT_NE(to_markdown(reports, {true, "", "", "", "papers.json"}).find("not be that of papers.json"),
              std::string::npos);
    EXPECT_EQ(nlohmann::json::parse(to_json(reports, {true, "", "", "", "papers.json"}))["beside"], "papers.json");
}

TEST(Report, SaysHowMuchOfTheTimeTheHostTook) {
    std::vector<PaperReport> reports{report(), report()};
    reports[0].seconds = 300.0;
    reports[1].seconds = 100.0;
    reports[1].id = "y2001";
    EXPECT_EQ(steal_line(reports), "");
    reports[0].steal_seconds = 1.0;
    reports[1].steal_seconds = 2.0;  // the limit
    EXPECT_EQ(steal_line(reports),
              "The host of a virtual machine took 0.8 % of the time (steal), and at no paper more than 2 %.");
    reports[1].steal_seconds = 5.0;
    const std::string line = steal_line(reports);
    EXPECT_EQ(
        line,
        "The host of a virtual machine took 1.5 % of the time (steal), and more than 2 % at y2001 (5.0 %): measure "
        "again what is about times there.");
    const std::string text = to_markdown(reports, conditions);
    EXPECT_NE(text.find("a machine; a build; 2000-01-01.\n\n" + line + "\n"), std::string::npos) << text;
    const auto document = nlohmann::json::parse(to_json(reports, conditions));
    EXPECT_EQ(document["steal"], line);
    EXPECT_EQ(document["papers"][1]["steal_seconds"], 5.0);
    reports[1].steal_seconds.reset();
    EXPECT_TRUE(nlohmann::json::parse(to_json(reports, conditions))["papers"][1]["steal_seconds"].is_null());
}

TEST(Report, NumbersSurviveInJson) {
    const std::vector<PaperReport> reports{report()};
    const auto document = nlohmann::json::parse(to_json(reports, conditions));
    const auto& claim = document["papers"][0]["claims"][0];
    EXPECT_EQ(claim["verdict"], "holds");
    EXPECT_EQ(claim["rule"], "ratio");
    EXPECT_EQ(document["papers"][0]["claims"][1]["verdict"], "undecided");
    EXPECT_EQ(document["papers"][0]["claims"][2]["verdict"], "does not hold here");
    EXPECT_EQ(claim["values"][0]["high"], 2.2);
    EXPECT_EQ(document["papers"][0]["plots"][0]["series"][0]["points"][1][0], 10.0);
}

TEST(Report, PlotsAreDrawnAndWrittenBesideTheText) {
    const TemporaryFolder temporary;
    const std::filesystem::path& folder = temporary.path();
    const std::vector<PaperReport> reports{report()};
    write_reports(folder, "papers", reports, conditions);
    const std::string svg = base::read_text(folder / "plots/x2000_figure1.svg");
    EXPECT_NE(svg.find("<svg"), std::string::npos);
    EXPECT_NE(svg.find("s a title"), std::string::npos) << "a quote in the title does not end it";
    EXPECT_EQ(base::read_text(folder / "papers.md"), to_markdown(reports, conditions));
    EXPECT_EQ(base::read_text(folder / "papers.json"), to_json(reports, conditions));
}

}  // namespace
}  // namespace shadowbench::claims
