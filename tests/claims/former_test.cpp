#include "claims/former.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "base/error.h"
#include "claims/paper.h"

namespace shadowbench::claims {
namespace {

// A report with every claim that the rows of a paper name.
PaperReport report_of(const std::string& paper) {
    PaperReport report;
    report.id = paper;
    std::set<std::pair<std::string, std::string>> seen;
    for (const Former& former : former_verdicts())
        if (former.paper == paper && seen.insert({former.place, former.now}).second)
            report.claims.push_back({former.place, std::string(former.now) + " and so on", "0.5", judge_fit(exactly(0.01)), "", {}});
    return report;
}

TEST(Former, NamesPapersThatAreMeasuredAndVerdictsThatWereNotHolds) {
    for (const Former& former : former_verdicts()) {
        EXPECT_TRUE(std::any_of(all_papers().begin(), all_papers().end(),
                                [&](const Paper& paper) { return std::string(paper.id) == former.paper; }))
            << former.paper;
        EXPECT_TRUE(former.verdict == std::string("holds in shape") || former.verdict == std::string("does not hold here"));
    }
    EXPECT_EQ(former_verdicts().size(), 27u) << "the first report had 21 and 6";
}

TEST(Former, StandsBesideTodaysVerdict) {
    const std::string table = former_table(std::vector{report_of("volume")});
    EXPECT_NE(table.find("| and it is faster | does not hold here: 0.977 to 0.993 | holds: 0.5 |"), std::string::npos) << table;
    EXPECT_EQ(table.find("AVSM"), table.find("AVSM of 2 and 4 nodes")) << "another paper's rows";
    PaperReport other;
    other.id = "other";
    EXPECT_EQ(former_table(std::vector{other}), "");
}

TEST(Former, AClaimThatIsGoneOrTwiceIsAnError) {
    PaperReport twice = report_of("volume"), gone = twice;
    twice.claims.push_back(twice.claims.front());
    gone.claims.pop_back();
    EXPECT_THROW(former_table(std::vector{twice}), base::Error);
    EXPECT_THROW(former_table(std::vector{gone}), base::Error);
}

}  // namespace
}  // namespace shadowbench::claims
