// Mesh files as programs write them (tests/cases).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "scene/readers/files.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

const fs::path cases = fs::path(SHADOWBENCH_SOURCE_DIR) / "tests/cases";

std::vector<std::pair<std::string, std::uint64_t>> passed_over(const MeshFile& file) {
    std::vector<std::pair<std::string, std::uint64_t>> list;
    for (const PassedOver& each : file.passed_over) list.emplace_back(each.what, each.count);
    return list;
}

// A unit square: with a byte-order mark before its first vertex, with a face over two lines, and as a strip.
TEST(ReadMesh, ReadsMarksContinuedLinesAndStrips) {
    for (const char* name : {"bom.obj", "cont.obj", "strips.ply"}) {
        const MeshFile file = read_mesh(cases / name);
        EXPECT_EQ(file.mesh.triangles.size(), 2u) << name;
        EXPECT_EQ(test::area(file.mesh), 1.0) << name;
        EXPECT_THAT(passed_over(file), IsEmpty()) << name;
    }
    EXPECT_EQ(read_mesh(cases / "bom.obj").mesh.positions.size(), 5u);
}

// The fan of its first corner would cover 4.
TEST(ReadMesh, CoversAConcaveFaceOnce) {
    EXPECT_EQ(test::area(read_mesh(cases / "concave_bad.obj").mesh), 3.0);
}

TEST(ReadMesh, CountsAFaceOfTwoCorners) {
    const MeshFile file = read_mesh(cases / "edge.obj");
    EXPECT_EQ(test::area(file.mesh), 1.0);
    EXPECT_THAT(passed_over(file), ElementsAre(Pair("faces of fewer than 3 corners", 1)));
}

TEST(ReadMesh, ReadsVerticesAlone) {
    const MeshFile file = read_mesh(cases / "points.ply");
    EXPECT_EQ(file.mesh.positions.size(), 4u);
    EXPECT_THAT(file.mesh.triangles, IsEmpty());
}

}  // namespace
}  // namespace shadowbench::scene
