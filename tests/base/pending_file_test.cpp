#include "base/pending_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "base/read_text.h"
#include "temporary_folder.h"

namespace shadowbench::base {
namespace {

namespace fs = std::filesystem;

class PendingFiles : public ::testing::Test {
protected:
    std::size_t files() const {
        return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
    }
    const TemporaryFolder temporary;
    const fs::path folder = temporary.path();
};

TEST_F(PendingFiles, AppearWholeAtTheirPlace) {
    const fs::path place = folder / "a.dsm";
    std::ofstream(place) << "old";
    {
        PendingFile file(place);
        EXPECT_EQ(file.temporary().extension(), ".dsm");
        std::ofstream(file.temporary()) << "new";
        EXPECT_EQ(read_text(place), "old");
        file.commit();
    }
    EXPECT_EQ(read_text(place), "new");
    EXPECT_EQ(files(), 1u);
}

TEST_F(PendingFiles, LeaveNothingWhenTheyAreNotFinished) {
    const fs::path place = folder / "a.dsm";
    std::ofstream(place) << "old";
    {
        PendingFile file(place), other(folder / "b.dsm");
        std::ofstream(file.temporary()) << "half";
        EXPECT_EQ(files(), 3u);
    }
    EXPECT_EQ(read_text(place), "old");
    EXPECT_EQ(files(), 1u);
}

TEST_F(PendingFiles, AreRefusedBeforeTheWorkWhereNothingCanBeWritten) {
    const auto code = [](const fs::path& place) {
        try {
            PendingFile file(place);
        } catch (const Error& error) {
            EXPECT_EQ(error.where(), place.string());
            return error.code();
        }
        return ErrorCode{};
    };
    EXPECT_EQ(code(folder), ErrorCode::io);
    EXPECT_EQ(code(folder / ""), ErrorCode::io);
    EXPECT_EQ(code(folder / "no_folder" / "a.dsm"), ErrorCode::io);
    EXPECT_EQ(files(), 0u);
}

}  // namespace
}  // namespace shadowbench::base
