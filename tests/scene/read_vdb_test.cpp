#include <openvdb/openvdb.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "scene/readers/files.h"
#include "scene/support.h"

namespace shadowbench::scene {
namespace {

using test::error_of;
using testing::AllOf;
using testing::HasSubstr;

// A box of 3 x 2 x 1 voxels from (-1, 0, 5), the value 1 + x + 10 y in each, of voxels 0.5 wide.
openvdb::FloatGrid::Ptr small_grid() {
    openvdb::initialize();
    openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0.0f);
    grid->setName("density");
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    for (int x = -1; x <= 1; ++x)
        for (int y = 0; y <= 1; ++y) grid->tree().setValue({x, y, 5}, static_cast<float>(2 + x + 10 * y));
    return grid;
}

std::filesystem::path write(const openvdb::GridPtrVec& grids) {
    const std::filesystem::path path = test::fresh_path("a.vdb");
    openvdb::io::File file(path.string());
    file.write(grids);
    file.close();
    return path;
}

TEST(ReadVdb, GivesTheActiveBoxXFastestWithItsWorldBounds) {
    const GridVolume volume = read_vdb(write({small_grid()}), "density");
    EXPECT_EQ(volume.size, Vec3i(3, 2, 1));
    EXPECT_THAT(volume.density, testing::ElementsAre(1, 2, 3, 11, 12, 13));
    // Voxel centres are whole index coordinates: the box reaches half a voxel further.
    EXPECT_EQ(volume.lower, Vec3d(-0.75, -0.25, 2.25));
    EXPECT_EQ(volume.upper, Vec3d(0.75, 0.75, 2.75));
}

TEST(ReadVdb, ReadsHalfFloats) {
    const openvdb::FloatGrid::Ptr grid = small_grid();
    grid->setSaveFloatAsHalf(true);
    EXPECT_THAT(read_vdb(write({grid}), "density").density, testing::ElementsAre(1, 2, 3, 11, 12, 13));
}

TEST(ReadVdb, FollowsScaleAndTranslation) {
    openvdb::FloatGrid::Ptr grid = small_grid();
    grid->transform().postScale(openvdb::Vec3d(2.0, 1.0, 4.0));
    grid->transform().postTranslate(openvdb::Vec3d(10.0, 0.0, 0.0));
    const GridVolume volume = read_vdb(write({grid}), "density");
    EXPECT_EQ(volume.lower, Vec3d(8.5, -0.25, 9.0));
    EXPECT_EQ(volume.upper, Vec3d(11.5, 0.75, 11.0));
}

TEST(ReadVdb, ListsTheGridsWhenNoGridHasTheName) {
    openvdb::FloatGrid::Ptr second = small_grid();
    second->setName("heat");
    const auto file = write({small_grid(), second});
    const base::Error error = error_of([&] { read_vdb(file, "smoke"); });
    EXPECT_EQ(error.code(), base::ErrorCode::bad_input);
    EXPECT_EQ(error.where(), file.string());
    EXPECT_THAT(error.message(), AllOf(HasSubstr("smoke"), HasSubstr("density, heat")));
    EXPECT_NO_THROW(read_vdb(file, "heat"));
}

// Two grids of one name are "density[0]" and "density[1]" in the file; index 1 is a grid of vectors.
openvdb::GridPtrVec several_grids() {
    openvdb::FloatGrid::Ptr first = small_grid(), third = small_grid();
    openvdb::Vec3SGrid::Ptr vectors = openvdb::Vec3SGrid::create();
    vectors->setName("velocity");
    third->tree().setValue({0, 0, 5}, 50.0f);
    return {first, vectors, third};
}

TEST(ReadVdb, TakesAGridByItsNumberAndRefusesANameThatSeveralHave) {
    const auto file = write(several_grids());
    EXPECT_EQ(read_vdb(file, 0).density[1], 2.0f);
    EXPECT_EQ(read_vdb(file, 2).density[1], 50.0f);
    EXPECT_EQ(read_vdb(file, "density[0]").density[1], 2.0f);
    EXPECT_EQ(read_vdb(file, "density[1]").density[1], 50.0f);
    EXPECT_THAT(read_vdb(file, 2).notes.lines,
                testing::ElementsAre("the grid \"density[1]\" is read and 2 passed over: density[0], velocity"));
    for (const GridChoice& several : {GridChoice(), GridChoice("density")})
        EXPECT_THAT(error_of([&] { read_vdb(file, several); }).message(),
                    AllOf(HasSubstr("2 grids are called \"density\""), HasSubstr("density[0], velocity, density[1]")));
    EXPECT_THAT(error_of([&] { read_vdb(file, 1); }).message(), HasSubstr("not float"));
    // Named as another grid is shown.
    openvdb::GridPtrVec grids = several_grids();
    openvdb::FloatGrid::Ptr fourth = small_grid();
    fourth->setName("density[1]");
    fourth->tree().setValue({0, 0, 5}, 70.0f);
    grids.push_back(fourth);
    const auto confusing = write(grids);
    EXPECT_EQ(read_vdb(confusing, 0).density[1], 2.0f);
    EXPECT_EQ(read_vdb(confusing, 3).density[1], 70.0f);
    EXPECT_EQ(read_vdb(confusing, 2).density[1], 50.0f);
    for (const int number : {-1, 4})
        EXPECT_THAT(error_of([&] { read_vdb(confusing, number); }).message(), HasSubstr("no grid number"));
}

TEST(ReadVdb, TakesTheOnlyGridOfFloatsUnderAnyNameOrNone) {
    for (const char* name : {"", "smoke"}) {
        openvdb::GridPtrVec grids = several_grids();
        grids.pop_back();
        grids[0]->setName(name);
        const GridVolume volume = read_vdb(write(grids), {});
        EXPECT_THAT(volume.density, testing::ElementsAre(1, 2, 3, 11, 12, 13));
        ASSERT_EQ(volume.notes.lines.size(), 1u);
        EXPECT_THAT(volume.notes.lines[0], AllOf(HasSubstr(*name ? name : "(no name)"), HasSubstr("velocity")));
        EXPECT_THAT(read_vdb(write({grids[0]}), GridChoice()).notes.lines[0], HasSubstr("the only one"));
        EXPECT_EQ(read_vdb(write({grids[0]}), name).density, volume.density);
    }
    openvdb::GridPtrVec grids = several_grids();
    grids[0]->setName("");
    grids[2]->setName("heat");
    EXPECT_THAT(error_of([&] { read_vdb(write(grids), {}); }).message(),
                AllOf(HasSubstr("give \"grid\""), HasSubstr("(no name), velocity, heat")));
    EXPECT_EQ(read_vdb(write(grids), 2).density[1], 50.0f);
    EXPECT_EQ(read_vdb(write(grids), "").density[1], 2.0f);
    EXPECT_THAT(error_of([&] { read_vdb(write({grids[1]}), {}); }).message(), HasSubstr("no grid of float values"));
    EXPECT_TRUE(read_vdb(write({small_grid()}), {}).notes.lines.empty());
}

// Grids may share a tree; the file then holds the name of the grid that has it. If that grid is missing, the library
// takes one with a similar name, which is not checked.
TEST(ReadVdb, ReadsGridsThatShareATreeAndRefusesThemWithoutIt) {
    openvdb::FloatGrid::Ptr first = small_grid();
    openvdb::FloatGrid::Ptr second = openvdb::FloatGrid::create(first->treePtr());
    second->setName("half");
    second->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
    const auto file = write({first, second});
    EXPECT_EQ(read_vdb(file, "half").density, read_vdb(file, "density").density);
    EXPECT_EQ(read_vdb(file, "half").upper.x, 0.5 * read_vdb(file, "density").upper.x);

    std::string bytes = test::read_bytes(file);
    const std::string name = test::bytes_of(7u) + "density";
    const std::size_t parent = bytes.rfind(name, bytes.rfind("Tree_float") + 100);
    ASSERT_GT(parent, bytes.rfind("Tree_float"));
    bytes.replace(parent, name.size(), test::bytes_of(7u) + "densit[");
    const auto damaged = test::write_file("orphan.vdb", bytes);
    EXPECT_THAT(error_of([&] { read_vdb(damaged, "half"); }).message(), HasSubstr("shares the tree"));
}

TEST(ReadVdb, TakesDensitiesBelow0As0AndCountsThemOrRefusesThem) {
    openvdb::FloatGrid::Ptr grid = small_grid();
    grid->tree().setValue({0, 0, 5}, -1e-6f);
    grid->tree().setValue({1, 1, 5}, -2.5f);
    const auto file = write({grid});
    const GridVolume volume = read_vdb(file, "density");
    EXPECT_THAT(volume.density, testing::ElementsAre(1, 0, 3, 11, 12, 0));
    EXPECT_THAT(volume.notes.lines, testing::ElementsAre("2 of 6 densities are below 0, the least -2.5: taken as 0"));
    EXPECT_THAT(error_of([&] { read_vdb(file, "density", Negative::refuse); }).message(), HasSubstr("below 0"));
    EXPECT_EQ(read_vdb(write({small_grid()}), "density", Negative::refuse).density.size(), 6u);
}

// Voxels that are not active have the background in the box of those that are. Left at 0 it would be thinner.
TEST(ReadVdb, FillsTheBoxWithTheBackgroundAndNothingOutside) {
    const auto between = [](float background) {
        openvdb::initialize();
        openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(background);
        grid->setName("density");
        grid->tree().setValue({0, 0, 0}, 1.0f);
        grid->tree().setValue({2, 0, 0}, 3.0f);
        return read_vdb(write({grid}), "density");
    };
    const GridVolume above = between(0.25f), below = between(-0.25f);
    EXPECT_THAT(above.density, testing::ElementsAre(1, 0.25f, 3));
    EXPECT_EQ(above.lower, Vec3d(-0.5, -0.5, -0.5));
    EXPECT_EQ(above.upper, Vec3d(2.5, 0.5, 0.5));
    EXPECT_THAT(above.notes.lines, testing::ElementsAre(HasSubstr("background is 0.25, but outside")));
    EXPECT_THAT(below.density, testing::ElementsAre(1, 0, 3));
    EXPECT_THAT(below.notes.lines, testing::ElementsAre(HasSubstr("1 of 3 densities are below 0, the least -0.25")));
    EXPECT_TRUE(between(0.0f).notes.lines.empty());
}

TEST(ReadVdb, RefusesABoxOverTheLimitBeforeItIsFilled) {
    openvdb::FloatGrid::Ptr grid = small_grid();
    grid->tree().setValue({20000, 20000, 20000}, 1.0f);
    EXPECT_THAT(error_of([&] { read_vdb(write({grid}), "density"); }).message(), HasSubstr("limit is 1000000000"));
}

TEST(ReadVdb, RefusesValuesThatAreNoDensity) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), infinity, -infinity, 1e19f, -1e19f}) {
        openvdb::FloatGrid::Ptr grid = small_grid();
        grid->tree().setValue({0, 0, 5}, bad);
        EXPECT_EQ(error_of([&] { read_vdb(write({grid}), "density"); }).code(), base::ErrorCode::bad_input) << bad;
    }
}

TEST(ReadVdb, RefusesOtherKindsOfGrid) {
    openvdb::Vec3SGrid::Ptr vectors = openvdb::Vec3SGrid::create();
    vectors->setName("density");
    EXPECT_THAT(error_of([&] { read_vdb(write({vectors}), "density"); }).message(), HasSubstr("not float"));
    openvdb::FloatGrid::Ptr level_set = small_grid();
    level_set->setGridClass(openvdb::GRID_LEVEL_SET);
    EXPECT_THAT(error_of([&] { read_vdb(write({level_set}), "density"); }).message(), HasSubstr("level set"));
    openvdb::FloatGrid::Ptr empty = openvdb::FloatGrid::create();
    empty->setName("density");
    EXPECT_THAT(error_of([&] { read_vdb(write({empty}), "density"); }).message(), HasSubstr("no active voxels"));
}

TEST(ReadVdb, RefusesAFileCutAnywhereAndOtherFiles) {
    const std::string bytes = test::read_bytes(write({small_grid()}));
    test::expect_cuts_refused(bytes, "cut.vdb", bytes.size(), [](const auto& file) { read_vdb(file, "density"); });
    EXPECT_EQ(error_of([] { read_vdb(test::write_file("b.vdb", "something else"), "density"); }).code(),
              base::ErrorCode::bad_input);
    EXPECT_EQ(error_of([] { read_vdb("/nowhere/a.vdb", "density"); }).code(), base::ErrorCode::no_such_file);
}

// The error of read_vdb for the small grid's file with `from`, which it must contain, replaced by `to`.
std::string message_with(const std::string& from, const std::string& to) {
    std::string bytes = test::read_bytes(write({small_grid()}));
    const std::size_t at = bytes.find(from);
    EXPECT_NE(at, std::string::npos);
    if (at != std::string::npos) bytes.replace(at, from.size(), to);
    const auto file = test::write_file("claims.vdb", bytes);
    const base::Error error = error_of([&] { read_vdb(file, "density"); });
    EXPECT_EQ(error.code(), base::ErrorCode::bad_input);
    EXPECT_THAT(error.where(), testing::StartsWith(file.string() + ":"));
    return error.message();
}

TEST(ReadVdb, RefusesClaimsBeforeMemoryIsTakenForThem) {
    const std::string box = "file_bbox_max" + test::bytes_of(5u) + "vec3i" + test::bytes_of(12u);
    EXPECT_THAT(message_with(box + test::bytes_of(1, 1, 5), box + test::bytes_of(20000, 20000, 20000)),
                HasSubstr("limit is 1000000000"));
    // One buffer, background, tiles, children, and where the first child is.
    EXPECT_THAT(message_with(test::bytes_of(1, 0.0f, 0u, 2u, -4096, 0, 0),
                             test::bytes_of(1, 0.0f, 0u, 0x7fffffffu, -4096, 0, 0)),
                HasSubstr("2147483647 nodes"));
}

TEST(ReadVdb, RefusesTwoNodesAtOnePlace) {
    EXPECT_THAT(message_with(test::bytes_of(1, 0.0f, 0u, 2u, -4096, 0, 0), test::bytes_of(1, 0.0f, 0u, 2u, 0, 0, 0)),
                HasSubstr("same place"));
}

// The library trusts the sizes in a file: if a chunk is larger than its node, it would read over the memory behind the
// node, and it would allocate memory for any count of children.
TEST(ReadVdb, SurvivesEveryBitFlipped) {
    for (const std::uint32_t compression : {0u, 1u, 2u, 3u, 4u, 6u}) {
        const std::filesystem::path path = test::fresh_path("a.vdb");
        openvdb::io::File file(path.string());
        file.setCompression(compression);
        file.write({small_grid()});
        file.close();
        const std::string bytes = test::read_bytes(path);
        const std::size_t stride = 8 * bytes.size() / 4000 + 1;
        for (std::size_t bit = compression; bit < 8 * bytes.size(); bit += stride) {
            std::string flipped = bytes;
            flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
            const auto damaged = test::write_file("b.vdb", flipped);
            try {
                // A far leaf makes a large box.
                const GridVolume volume = read_vdb(damaged, "density", Negative::clamp, 1 << 20);
                for (const float density : volume.density) ASSERT_TRUE(density >= 0.0f && density <= 1e18f) << bit;
            } catch (const base::Error& error) {
                ASSERT_EQ(error.code(), base::ErrorCode::bad_input) << bit;
                ASSERT_TRUE(error.where().starts_with(damaged.string())) << error.what();
            }
        }
    }
}

// The library makes no such map, but reads any.
TEST(ReadVdb, RefusesTransformsThatAreFlatTooLargeOrNotFinite) {
    const std::string name = "UniformScaleMap", bytes = test::read_bytes(write({small_grid()}));
    const std::size_t scale_at = bytes.find(name) + name.size();  // three factors, then three sizes of a voxel
    ASSERT_LT(scale_at, bytes.size());
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const double scale : {0.0, 1e-30, 1e30, infinity, std::numeric_limits<double>::quiet_NaN()}) {
        std::string damaged = bytes;
        damaged.replace(scale_at, 48, test::bytes_of(scale, scale, scale, scale, scale, scale));
        const auto file = test::write_file("map.vdb", damaged);
        const base::Error error = error_of([&] { read_vdb(file, "density"); });
        EXPECT_EQ(error.code(), base::ErrorCode::bad_input) << scale;
        EXPECT_EQ(error.where(), file.string()) << scale;
    }
}

TEST(ReadVdb, SaysThatAFileIsEmpty) {
    EXPECT_EQ(error_of([] { read_vdb(test::write_file("empty.vdb", ""), "density"); }).message(), "the file is empty");
}

TEST(ReadVdb, ReadsTheSmokeWholeOrNotAtAll) {
    SHADOWBENCH_NEED_DATA(file, "volumes/smoke.vdb");
    const GridVolume volume = read_vdb(file, "density");
    EXPECT_EQ(volume.size, Vec3i(111, 222, 112));
    EXPECT_NEAR(*std::max_element(volume.density.begin(), volume.density.end()), 5.71, 0.01);
    const std::string bytes = test::read_bytes(file);
    for (const double part : {0.1, 0.5, 0.9, 0.99999}) {
        const auto cut =
            test::write_file("cut.vdb", bytes.substr(0, static_cast<std::size_t>(part * double(bytes.size()))));
        EXPECT_EQ(error_of([&] { read_vdb(cut, "density"); }).code(), base::ErrorCode::bad_input) << part;
    }
}

}  // namespace
}  // namespace shadowbench::scene
