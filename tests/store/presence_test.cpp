#include "service/store/presence.h"

#include <fstream>

#include <gtest/gtest.h>

#include "base/error.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;

TEST(Presences, NoticeWhatIsGoneOrAnother) {
    const TemporaryFolder folder;
    const fs::path state = folder.path() / "state", file = state / "jobs.db", away = folder.path() / "away";
    EXPECT_THROW(Presence({state}), base::Error);
    fs::create_directory(state);
    std::ofstream(file) << "x";
    const Presence presence({state, file});
    EXPECT_FALSE(presence.gone());
    EXPECT_NO_THROW(presence.check());
    std::ofstream(file, std::ios::app) << "more";
    EXPECT_FALSE(presence.gone()) << "what is in it does not matter";
    fs::rename(file, state / "jobs.old");
    EXPECT_EQ(presence.gone().value_or("").string(), file.string());
    std::ofstream(file) << "another";
    EXPECT_EQ(presence.gone().value_or("").string(), file.string());
    fs::rename(state / "jobs.old", file);
    EXPECT_FALSE(presence.gone()) << "it is back";
    fs::rename(state, away);
    EXPECT_EQ(presence.gone().value_or("").string(), state.string());
    EXPECT_THROW(presence.check(), base::Error);
    fs::create_directory(state);
    EXPECT_EQ(presence.gone().value_or("").string(), state.string()) << "a new one in its place";
}

}  // namespace
}  // namespace shadowbench::service
