// NanoVDB files as the library writes them, against the values that it reads from its own grids.
#define NANOVDB_USE_ZIP
#define NANOVDB_USE_BLOSC
#include <nanovdb/util/GridBuilder.h>
#include <nanovdb/util/IO.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "scene/readers/files.h"
#include "scene/support.h"
#include "techniques/live_bytes.h"

namespace shadowbench::scene {
namespace {

using nanovdb::io::Codec;
using test::error_of;
using testing::AllOf;
using testing::HasSubstr;
using Handle = nanovdb::GridHandle<nanovdb::HostBuffer>;

// Index axis i runs along world axis order[i], by `step[i]` a voxel.
nanovdb::Map map_of(const std::array<int, 3>& order, const std::array<double, 3>& step) {
    nanovdb::Map map{};
    for (std::size_t i = 0; i < 3; ++i) map.mMatD[3 * static_cast<std::size_t>(order[i]) + i] = step[i];
    map.mVecD[0] = 10.0;
    return map;
}

const nanovdb::Map plain = map_of({0, 1, 2}, {1.0, 1.0, 1.0});

// Several leaves, with gaps between active voxels.
constexpr int first = 3, last = 17;
float density_at(const nanovdb::Coord& p) {
    return (p.x() + p.y() + p.z()) % 7 == 0 ? 0.0f : 1.0f + 0.01f * static_cast<float>(3 * p.x() + 5 * p.y() - p.z());
}

template <class Build = float>
Handle grid(const nanovdb::Map& map = plain, const std::string& name = "density",
            nanovdb::GridClass kind = nanovdb::GridClass::FogVolume) {
    using Value = typename nanovdb::BuildToValueMap<Build>::Type;
    nanovdb::GridBuilder<Value, Build> builder(Value(0), kind);
    builder([](const nanovdb::Coord& p) { return static_cast<Value>(density_at(p)); },
            nanovdb::CoordBBox(nanovdb::Coord(first), nanovdb::Coord(last)));
    return builder.template getHandle<>(map, name);
}

std::filesystem::path write(const std::vector<Handle*>& handles, Codec codec = Codec::NONE) {
    const std::filesystem::path path = test::fresh_path("a.nvdb");
    std::ofstream file(path, std::ios::binary);
    for (const Handle* handle : handles) nanovdb::io::writeGrid(file, *handle, codec);  // a segment each
    return path;
}

std::filesystem::path write(Handle handle, Codec codec = Codec::NONE) {
    return write(std::vector<Handle*>{&handle}, codec);
}

std::string message(const std::filesystem::path& file, const GridChoice& grid = {}) {
    const base::Error error = error_of([&] { read_nanovdb(file, grid); });
    EXPECT_EQ(error.code(), base::ErrorCode::bad_input);
    EXPECT_TRUE(error.where().starts_with(file.string()));
    return error.message();
}

template <class Build>
void expect_as_the_library_reads_it() {
    Handle handle = grid<Build>();
    const nanovdb::NanoGrid<Build>* written = handle.template grid<Build>();
    ASSERT_TRUE(written);
    auto accessor = written->getAccessor();
    const GridVolume volume = read_nanovdb(write(std::vector<Handle*>{&handle}), {});
    constexpr int side = last - first + 1;
    ASSERT_EQ(volume.size, Vec3i(side, side, side));
    ASSERT_EQ(volume.density.size(), static_cast<std::size_t>(side * side * side));
    EXPECT_EQ(volume.lower, Vec3d(10.0 + first - 0.5, first - 0.5, first - 0.5));
    EXPECT_EQ(volume.upper, Vec3d(10.0 + last + 0.5, last + 0.5, last + 0.5));
    std::size_t v = 0;
    for (int z = first; z <= last; ++z)
        for (int y = first; y <= last; ++y)
            for (int x = first; x <= last; ++x, ++v) {
                const auto wanted = static_cast<float>(accessor.getValue(nanovdb::Coord(x, y, z)));
                ASSERT_EQ(volume.density[v], wanted) << x << " " << y << " " << z;
            }
    EXPECT_TRUE(volume.notes.lines.empty());
}

TEST(ReadNanoVdb, GivesTheValuesOfEveryTypeOfGrid) {
    expect_as_the_library_reads_it<float>();
    expect_as_the_library_reads_it<double>();
    expect_as_the_library_reads_it<nanovdb::Fp4>();
    expect_as_the_library_reads_it<nanovdb::Fp8>();
    expect_as_the_library_reads_it<nanovdb::Fp16>();
    expect_as_the_library_reads_it<nanovdb::FpN>();
}

TEST(ReadNanoVdb, UnpacksFiles) {
    const GridVolume wanted = read_nanovdb(write(grid()), {});
    for (const Codec codec : {Codec::ZIP, Codec::BLOSC})
        EXPECT_EQ(read_nanovdb(write(grid(), codec), {}).density, wanted.density);
}

// The box of one voxel, (0, 0, 0) to (4, 9, 5), and a tile of 8^3 voxels that is not in a leaf.
TEST(ReadNanoVdb, FillsTilesAndWhatIsBetweenThem) {
    nanovdb::GridBuilder<float> builder(0.25f, nanovdb::GridClass::FogVolume);
    builder([](const nanovdb::Coord&) { return 0.5f; }, nanovdb::CoordBBox(nanovdb::Coord(0), nanovdb::Coord(7)));
    builder.getAccessor().setValue(nanovdb::Coord(12, 7, 0), 2.0f);
    const GridVolume volume = read_nanovdb(write(builder.getHandle<>(plain, "density")), {});
    EXPECT_EQ(volume.size, Vec3i(13, 8, 8));
    for (std::size_t v = 0; v < volume.density.size(); ++v) {
        const std::size_t x = v % 13, y = v / 13 % 8, z = v / 13 / 8;
        ASSERT_EQ(volume.density[v], x < 8 ? 0.5f : x == 12 && y == 7 && z == 0 ? 2.0f : 0.25f) << v;
    }
    EXPECT_THAT(volume.notes.lines, testing::ElementsAre(HasSubstr("background is 0.25, but outside")));
}

// In the file, places are in the bits of a key.
TEST(ReadNanoVdb, FindsVoxelsOnAllSidesOf0) {
    for (const nanovdb::Coord& at : {nanovdb::Coord(-1, -5000, 4100), nanovdb::Coord(1 << 24, -(1 << 24), 0)}) {
        nanovdb::GridBuilder<float> builder(0.0f, nanovdb::GridClass::FogVolume);
        builder.getAccessor().setValue(at, 1.0f);
        builder.getAccessor().setValue(at + nanovdb::Coord(0, 1, 0), 2.0f);
        const GridVolume volume = read_nanovdb(write(builder.getHandle<>(plain, "density")), {});
        EXPECT_THAT(volume.density, testing::ElementsAre(1.0f, 2.0f));
        EXPECT_EQ(volume.lower, Vec3d(10.0 + at[0] - 0.5, at[1] - 0.5, at[2] - 0.5));
    }
}

TEST(ReadNanoVdb, SwapsMirrorsAndTurnsAxes) {
    constexpr std::size_t side = last - first + 1;
    const GridVolume straight = read_nanovdb(write(grid()), {});
    const GridVolume volume = read_nanovdb(write(grid(map_of({1, 2, 0}, {0.5, -2.0, 1.0}))), {});
    EXPECT_EQ(volume.lower, Vec3d(10.0 + first - 0.5, 0.5 * first - 0.25, -2.0 * last - 1.0));
    EXPECT_EQ(volume.upper, Vec3d(10.0 + last + 0.5, 0.5 * last + 0.25, -2.0 * first + 1.0));
    for (std::size_t z = 0; z < side; ++z)
        for (std::size_t y = 0; y < side; ++y)
            for (std::size_t x = 0; x < side; ++x)
                ASSERT_EQ(volume.density[((side - 1 - y) * side + x) * side + z],
                          straight.density[(z * side + y) * side + x]);
    nanovdb::Map turned = plain;
    turned.mMatD[0] = turned.mMatD[4] = std::cos(0.5);
    turned.mMatD[3] = std::sin(0.5);
    turned.mMatD[1] = -turned.mMatD[3];
    const GridVolume askew = read_nanovdb(write(grid(turned)), {});
    ASSERT_TRUE(askew.frame);
    EXPECT_EQ(askew.density, straight.density);
    EXPECT_DOUBLE_EQ(askew.frame->to_world[0][1], std::sin(0.5));
}

TEST(ReadNanoVdb, TakesAGridByItsNameOrNumber) {
    Handle heat = grid(map_of({0, 1, 2}, {2.0, 2.0, 2.0}), "heat"), density = grid(), unnamed = grid(plain, "");
    Handle vectors = nanovdb::GridBuilder<nanovdb::Vec3f>(nanovdb::Vec3f(0)).getHandle<>(1.0, nanovdb::Vec3d(0), "v");
    const auto file = write({&heat, &density, &vectors});
    EXPECT_EQ(read_nanovdb(file, {}).upper.y, last + 0.5);
    EXPECT_EQ(read_nanovdb(file, "heat").upper.y, 2.0 * (last + 0.5));
    EXPECT_EQ(read_nanovdb(file, 0).upper.y, 2.0 * (last + 0.5));
    EXPECT_THAT(read_nanovdb(file, 0).notes.lines,
                testing::ElementsAre("the grid \"heat\" is read and 2 passed over: density, v"));
    EXPECT_THAT(message(file, "v"), AllOf(HasSubstr("grid of type 6"), HasSubstr("are read")));
    EXPECT_THAT(message(file, "smoke"), HasSubstr("the grids are: heat, density, v"));
    EXPECT_THAT(message(file, 3), HasSubstr("no grid number 3"));
    EXPECT_THAT(read_nanovdb(write({&unnamed}), {}).notes.lines, testing::ElementsAre(HasSubstr("the only one")));
    EXPECT_THAT(message(write({&heat, &unnamed})), HasSubstr("give \"grid\""));
}

TEST(ReadNanoVdb, TakesOrRefusesDensitiesBelow0) {
    nanovdb::GridBuilder<float> builder(0.0f, nanovdb::GridClass::FogVolume);
    builder.getAccessor().setValue(nanovdb::Coord(0), -0.5f);
    builder.getAccessor().setValue(nanovdb::Coord(1, 0, 0), 1.0f);
    const auto file = write(builder.getHandle<>(plain, "density"));
    EXPECT_THAT(read_nanovdb(file, {}).notes.lines, testing::ElementsAre(HasSubstr("1 of 2 densities are below 0")));
    EXPECT_THAT(error_of([&] { read_nanovdb(file, {}, Negative::refuse); }).message(), HasSubstr("below 0"));
}

TEST(ReadNanoVdb, RefusesOtherFilesAndKinds) {
    EXPECT_THAT(message(write(grid(plain, "density", nanovdb::GridClass::LevelSet))), HasSubstr("a level set"));
    EXPECT_THAT(message(test::write_file("b.nvdb", "something else")), HasSubstr("not a NanoVDB file"));
    EXPECT_THAT(message(test::write_file("b.nvdb", "")), HasSubstr("too short"));
    EXPECT_EQ(error_of([] { read_nanovdb("/nowhere/a.nvdb", {}); }).code(), base::ErrorCode::no_such_file);
    std::string old = test::read_bytes(write(grid()));
    old.replace(8, 4, test::bytes_of(std::uint32_t{29} << 21 | 3u << 10));
    EXPECT_THAT(message(test::write_file("old.nvdb", old)), HasSubstr("version 29.3 of NanoVDB"));
    EXPECT_THAT(error_of([] { read_nanovdb(write(grid()), {}, Negative::clamp, 3000); }).message(),
                HasSubstr("limit is 3000"));
    nanovdb::Map flat = plain, endless = plain;
    flat.mMatD[0] = 0.0;
    endless.mVecD[1] = std::numeric_limits<double>::infinity();
    EXPECT_THAT(message(write(grid(flat))), HasSubstr("flattens it"));
    EXPECT_THAT(message(write(grid(endless))), HasSubstr("not finite"));
}

// Before memory is taken for it.
TEST(ReadNanoVdb, RefusesSizesThatTheFileCannotHold) {
    for (const Codec codec : {Codec::NONE, Codec::ZIP, Codec::BLOSC})
        for (const std::uint64_t size : {std::uint64_t{1} << 62, std::uint64_t{1} << 32, std::uint64_t{100}}) {
            std::string bytes = test::read_bytes(write(grid(), codec));
            bytes.replace(16, 8, test::bytes_of(size));
            message(test::write_file("size.nvdb", bytes));
        }
}

TEST(ReadNanoVdb, RefusesAFileCutAnywhere) {
    for (const Codec codec : {Codec::NONE, Codec::ZIP, Codec::BLOSC}) {
        const std::string bytes = test::read_bytes(write(grid(), codec));
        for (std::size_t length = 0; length < bytes.size(); length += 1 + bytes.size() / 40)
            message(test::write_file("cut.nvdb", bytes.substr(0, length)));
    }
}

// The library follows every place in a file; here each must lie in the grid, and no node may have two parents, which
// would make a small file take any time.
TEST(ReadNanoVdb, SurvivesBitsFlippedAnywhere) {
    for (const Codec codec : {Codec::NONE, Codec::ZIP, Codec::BLOSC}) {
        const std::string bytes = test::read_bytes(write(grid<nanovdb::FpN>(), codec));
        const std::size_t heads = std::min<std::size_t>(bytes.size(), 1300);
        std::vector<std::size_t> bits;
        for (std::size_t bit = 0; bit < 8 * heads; bit += 107) bits.push_back(bit);
        for (std::size_t bit = 8 * heads; bit < 8 * bytes.size(); bit += 8 * bytes.size() / 30 + 1) bits.push_back(bit);
        for (const std::size_t bit : bits) {
            std::string flipped = bytes;
            flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
            const auto damaged = test::write_file("b.nvdb", flipped);
            try {
                const GridVolume volume = read_nanovdb(damaged, {}, Negative::clamp, 1 << 16);
                for (const float density : volume.density) ASSERT_TRUE(density >= 0.0f && density <= 1e18f) << bit;
            } catch (const base::Error& error) {
                ASSERT_EQ(error.code(), base::ErrorCode::bad_input) << bit;
            }
        }
    }
}

TEST(ReadNanoVdb, RefusesNodesThatLeadOutOrHaveSeveralParents) {
    nanovdb::GridBuilder<float> builder(0.0f, nanovdb::GridClass::FogVolume);
    for (const int x : {-1, 0}) builder.getAccessor().setValue(nanovdb::Coord(x, 0, 0), 1.0f);
    Handle handle = builder.getHandle<>(plain, "density");
    const std::string bytes = test::read_bytes(write(std::vector<Handle*>{&handle}));
    const std::size_t grid_at = bytes.size() - static_cast<std::size_t>(handle.size());
    const auto* root =
        reinterpret_cast<const nanovdb::NanoRoot<float>::DataType*>(&handle.grid<float>()->tree().root());
    const auto tiles_at =
        grid_at + static_cast<std::size_t>(reinterpret_cast<const std::uint8_t*>(root + 1) - handle.data());
    constexpr std::size_t child = 8, tile = 32;  // the place of `child` in a tile, and the bytes of one
    ASSERT_EQ(root->mTableSize, 2u);
    const auto with = [&](const std::string& way) {
        std::string other = bytes;
        other.replace(tiles_at + child, 8, way);
        return message(test::write_file("ways.nvdb", other));
    };
    for (const std::int64_t way :
         {std::int64_t{-1} << 62, std::int64_t{1} << 62, std::int64_t{1} << 30, std::int64_t{8}})
        EXPECT_THAT(with(test::bytes_of(way)), HasSubstr("damaged"));
    std::string doubled = bytes;
    doubled.replace(tiles_at + tile, 8, bytes.substr(tiles_at, 8));
    EXPECT_THAT(message(test::write_file("doubled.nvdb", doubled)), HasSubstr("two nodes at one place"));
    doubled[tiles_at + tile + 2] = 0x10;  // a bit of the key between those of z and of y
    EXPECT_THAT(message(test::write_file("doubled.nvdb", doubled)), HasSubstr("a node at no place"));
}

// The grid, packed or not, would be held beside its densities, which take as much. The parts of it that are held take
// 2.5 MB, whatever its size.
TEST(ReadNanoVdb, HoldsNoGridBesideItsDensities) {
    constexpr int side = 128;
    nanovdb::GridBuilder<float> builder(0.0f, nanovdb::GridClass::FogVolume);
    builder([](const nanovdb::Coord& p) { return 1.0f + 0.01f * static_cast<float>(p[0] + 2 * p[1] + 3 * p[2]); },
            nanovdb::CoordBBox(nanovdb::Coord(0), nanovdb::Coord(side - 1)));
    Handle handle = builder.getHandle<>(plain, "density");
    std::vector<float> first_densities;
    for (const Codec codec : {Codec::NONE, Codec::ZIP, Codec::BLOSC}) {
        const auto file = write(std::vector<Handle*>{&handle}, codec);
        techniques::testing::forget_peak();
        const std::size_t before = techniques::testing::live_bytes();
        const std::vector<float> densities = read_nanovdb(file, {}).density;
        const std::size_t bytes = sizeof(float) * side * side * side;
        EXPECT_LT(static_cast<double>(techniques::testing::peak_bytes() - before), 1.4 * static_cast<double>(bytes));
        ASSERT_EQ(densities.size() * sizeof(float), bytes);
        if (codec == Codec::NONE) first_densities = densities;
        EXPECT_EQ(densities, first_densities);
    }
    EXPECT_EQ(first_densities[(std::size_t{7} * side + 5) * side + 3], 1.0f + 0.01f * (3 + 10 + 21));
}

// More than one block of BLOSC and more than one window, the last of each in part.
TEST(ReadNanoVdb, UnpacksLargeGridsOfNodesOfAllLevels) {
    nanovdb::GridBuilder<float> builder(0.0f, nanovdb::GridClass::FogVolume);
    auto accessor = builder.getAccessor();
    for (int i = 0; i < 1000; ++i) accessor.setValue(nanovdb::Coord(5 * i, 3, 7), static_cast<float>(i));
    Handle handle = builder.getHandle<>(plain, "density");
    for (const Codec codec : {Codec::NONE, Codec::ZIP, Codec::BLOSC}) {
        const GridVolume volume = read_nanovdb(write(std::vector<Handle*>{&handle}, codec), {});
        ASSERT_EQ(volume.size, Vec3i(4996, 1, 1));
        for (std::size_t x = 0; x < volume.density.size(); ++x)
            ASSERT_EQ(volume.density[x], x % 5 == 0 ? static_cast<float>(x / 5) : 0.0f) << x;
    }
}

}  // namespace
}  // namespace shadowbench::scene
