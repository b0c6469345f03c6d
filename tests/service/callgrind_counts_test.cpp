#include "service/cli/callgrind_counts.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

class CallgrindCounts : public ::testing::Test {
protected:
    void write(int part, const std::string& trigger, const std::string& sum) const {
        std::ofstream(prefix().string() + "." + std::to_string(part))
            << "# callgrind format\nversion: 1\npart: " << part << "\n\ndesc: I1 cache: \ndesc: Trigger: " << trigger
            << "\n\npositions: line\nevents: Ir\n"
            << sum << "\n\nfn=(0) f\n0 14\n";
    }
    std::filesystem::path prefix() const { return folder_.path() / "counts"; }

    const TemporaryFolder folder_;
};

TEST_F(CallgrindCounts, StandUnderTheNamesThatTheyWereDumpedWith) {
    write(1, "Client Request: build/deep/map:64", "summary: 9175199");
    write(2, "Client Request: load/obj", "totals: 12");
    write(3, "Program termination", "summary: 7");
    EXPECT_EQ(callgrind_counts(prefix()),
              (std::map<std::string, std::uint64_t>{{"build/deep/map:64", 9175199}, {"load/obj", 12}}));
}

TEST_F(CallgrindCounts, OfNoDumpAreNone) {
    EXPECT_TRUE(callgrind_counts(prefix()).empty());
}

TEST_F(CallgrindCounts, ADumpWithoutANumberIsRefused) {
    write(1, "Client Request: load/obj", "summary: many");
    try {
        callgrind_counts(prefix());
        FAIL();
    } catch (const base::Error& error) {
        EXPECT_EQ(error.code(), base::ErrorCode::bad_input);
        EXPECT_NE(error.where().find("counts.1"), std::string::npos);
    }
}

}  // namespace
}  // namespace shadowbench::service
