#include "claims/quick.h"

#include <gtest/gtest.h>

#include <fstream>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "claims/report.h"
#include "temporary_folder.h"

namespace shadowbench::claims {
namespace {

// A report of one claim for each of these errors of a curve, which fits up to 0.02, and roughly up to 0.05.
PaperReport report_of(const std::vector<Value>& errors) {
    PaperReport report;
    report.id = "x2000";
    for (const Value& error : errors)
        report.claims.push_back({fmt::format("section {}", report.claims.size() + 1),
                                 "it fits",
                                 to_text(error),
                                 judge_fit(error),
                                 "It is so.",
                                 {error}});
    return report;
}

FullReport written(const TemporaryFolder& folder, const PaperReport& report) {
    std::ofstream(folder.path("papers.json")) << to_json({&report, 1}, {false, "", "", "2000-01-01"});
    return read_full_report(folder.path("papers.json"));
}

TEST(Quick, DiffersFromTheFullReportOnlyWhereItSaysUndecided) {
    const Value good = exactly(0.01), shape = exactly(0.03), bad = exactly(0.1), open{0.02, 0.01, 0.03};
    const Value all[] = {good, shape, bad, open};
    std::vector<Value> of_full, of_quick;
    for (const Value& one : all)
        for (const Value& other : all) {
            of_full.push_back(one);
            of_quick.push_back(other);
        }
    const TemporaryFolder folder;
    const PaperReport full = report_of(of_full);
    PaperReport quick = report_of(of_quick);
    stand_beside(written(folder, full), quick);
    for (std::size_t i = 0; i < full.claims.size(); ++i) {
        const Verdict own = judge_fit(of_quick[i]).verdict, theirs = full.claims[i].judged.verdict;
        EXPECT_EQ(quick.claims[i].judged.verdict, own == theirs ? own : Verdict::undecided) << i;
        EXPECT_EQ(quick.claims[i].why == "It is so.", own == theirs) << i;
    }
    EXPECT_EQ(quick.claims[2].why,
              "It is so. At these smaller sizes it would be \"does not hold here\"; the full report has \"holds\".");
}

TEST(Quick, AClaimThatTheFullReportDoesNotHaveKeepsItsVerdict) {
    const TemporaryFolder folder;
    const FullReport full = written(folder, report_of({exactly(0.1)}));
    EXPECT_EQ(full.date, "2000-01-01");
    PaperReport quick = report_of({exactly(0.1), exactly(0.01)}), other = quick;
    stand_beside(full, quick);
    EXPECT_EQ(quick.claims[0].judged.verdict, Verdict::fails);
    EXPECT_EQ(quick.claims[1].judged.verdict, Verdict::holds);
    EXPECT_EQ(quick.claims[1].why, "It is so. The full report has no such claim.");
    other.id = "y2000";
    stand_beside(full, other);
    EXPECT_EQ(other.claims[0].why, "It is so. The full report has no such claim.");
}

TEST(Quick, AnotherFileIsNoReport) {
    const TemporaryFolder folder;
    for (const char* text : {"{}", R"({"date": 1, "papers": []})", R"({"date": "", "papers": [{"claims": []}, 1]})"}) {
        std::ofstream(folder.path("papers.json")) << text;
        try {
            read_full_report(folder.path("papers.json"));
            ADD_FAILURE() << text;
        } catch (const base::Error& error) {
            EXPECT_EQ(error.code(), base::ErrorCode::bad_input) << text;
        }
    }
}

}  // namespace
}  // namespace shadowbench::claims
