#include "base/durable_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "base/read_text.h"
#include "errors.h"
#include "temporary_folder.h"

namespace shadowbench::base {
namespace {

namespace fs = std::filesystem;

TEST(DurableFile, ReplacesWhatWasThereAndLeavesNothingElse) {
    const TemporaryFolder temporary;
    const fs::path file = temporary.path() / "cell.json";
    write_durable(file, "old");
    const std::string content = std::string(100'000, 'x') + '\0' + "new";
    write_durable(file, content);
    EXPECT_EQ(read_bytes(file), content);
    EXPECT_EQ(std::distance(fs::directory_iterator(temporary.path()), {}), 1) << "no temporary file stays";
}

TEST(DurableFile, NamesTheFileThatCannotBeWritten) {
    const TemporaryFolder temporary;
    const fs::path below = temporary.path() / "missing/cell.json";
    test::error_of([&] { write_durable(below, "x"); }, ErrorCode::io, below.string());
    test::error_of([&] { write_durable(temporary.path(), "x"); }, ErrorCode::io, temporary.path().string());
}

}  // namespace
}  // namespace shadowbench::base
