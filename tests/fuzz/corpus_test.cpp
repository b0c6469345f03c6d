// Runs every committed input of every fuzz target, without a fuzzer.
#include <gtest/gtest.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "base/read_text.h"
#include "fuzz/target.h"

namespace shadowbench::fuzz {
namespace {

namespace fs = std::filesystem;

struct Target {
    const char* name;
    void (*run)(std::string_view bytes);
};
constexpr Target targets[] = {{"alpha", alpha},
                              {"command_line", command_line},
                              {"dds_volume", dds_volume},
                              {"deep_file", deep_file},
                              {"deep_image", deep_image},
                              {"functions", functions},
                              {"gltf", gltf},
                              {"hair", hair},
                              {"metaimage", metaimage},
                              {"mitsuba_hair", mitsuba_hair},
                              {"mitsuba_volume", mitsuba_volume},
                              {"nanovdb", nanovdb},
                              {"nrrd", nrrd},
                              {"obj", obj},
                              {"pbrt", pbrt},
                              {"ply", ply},
                              {"pvm", pvm},
                              {"raw_volume", raw_volume},
                              {"request_head", request_head},
                              {"result", result},
                              {"scenario", scenario},
                              {"slc", slc},
                              {"stl", stl},
                              {"technique", technique},
                              {"tressfx", tressfx},
                              {"vdb", vdb}};

const fs::path corpus = fs::path(SHADOWBENCH_SOURCE_DIR) / "tests/fuzz/corpus";

TEST(Corpus, HasAFolderForEveryTarget) {
    std::vector<std::string> folders, names;
    for (const auto& entry : fs::directory_iterator(corpus)) folders.push_back(entry.path().filename().string());
    for (const Target& target : targets) names.emplace_back(target.name);
    std::sort(folders.begin(), folders.end());
    EXPECT_EQ(folders, names);
}

TEST(Corpus, EveryInputIsReadOrRefused) {
    for (const Target& target : targets) {
        std::size_t inputs = 0;
        for (const auto& entry : fs::directory_iterator(corpus / target.name)) {
            SCOPED_TRACE(entry.path().string());
            EXPECT_NO_THROW(target.run(base::read_bytes(entry.path())));
            ++inputs;
        }
        EXPECT_GT(inputs, 2u) << target.name;
    }
}

}  // namespace
}  // namespace shadowbench::fuzz
