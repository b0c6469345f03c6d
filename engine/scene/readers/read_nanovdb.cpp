#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <new>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "base/error.h"
#include "scene/readers/active_box.h"
#include "scene/readers/densities.h"
#include "scene/readers/files.h"
#include "scene/readers/nanovdb_bytes.h"
#include "scene/readers/nanovdb_file.h"
#include "scene/readers/nanovdb_tree.h"
#include "scene/readers/place_grid.h"
#include "scene/readers/vdb_facts.h"

namespace shadowbench::scene {
namespace {

// "NanoVDB0", and "NanoVDB1" since NanoVDB 32.6.
constexpr std::uint64_t grid_magics[] = {NANOVDB_MAGIC_NUMBER, 0x314244566f6e614e};

GridPlace place_of(const nanovdb::Map& map, const ActiveBox& box, const NanoVdbPlaces& places) {
    GridPlace place{{}, Vec3d(0, 0, 0)};
    for (std::size_t w = 0; w < 3; ++w) {
        double& first = (*place.first)[static_cast<int>(w)];
        first = map.mVecD[w];
        for (std::size_t i = 0; i < 3; ++i) {
            const double step = map.mMatD[3 * w + i];
            place.steps[i][static_cast<int>(w)] = step;
            first += step * static_cast<double>(box.lower[i]);
        }
        if (!std::isfinite(first)) places.damaged("its transform is not finite");
    }
    for (const Vec3d& step : place.steps)
        if (step == Vec3d(0, 0, 0)) places.damaged("its transform flattens it");
    return place;
}

struct Wanted {
    const std::filesystem::path& file;
    Negative negative;
    std::uint64_t most_voxels;
};

template <class Build>
GridVolume convert(const FileReader& file, const NanoVdbGrid& grid, NanoVdbPlaces& places, const Wanted& wanted,
                   VdbFacts& facts) {
    const nanovdb::Map map = places.at<nanovdb::GridData>(0).mMap;
    constexpr std::uint64_t tree_at = sizeof(nanovdb::GridData);
    const std::uint64_t root_at = tree_at + places.at<nanovdb::TreeData<3>>(tree_at).mNodeOffset[3];
    NanoVdbWalk<Build> walk(places, root_at);
    using Leaf = typename NanoVdbWalk<Build>::Leaf;
    constexpr std::uint32_t voxels_of_leaf = 512;
    ActiveBox box;
    walk.run(box, [&](const Vec3i& corner, const Leaf& leaf) {
        if (leaf.mValueMask.isOn()) return box.tile(corner, leaf_side, 0.0f, true);
        for (std::uint32_t n = 0; n < voxels_of_leaf; ++n)
            box.tile(entry_corner(corner, n, 3, 1), 1, 0.0f, leaf.mValueMask.isOn(n));
    });
    if (box.count == 0) file.fail(grid.begin, "the grid has no active voxels");
    if (box.voxels() > static_cast<double>(wanted.most_voxels))
        file.fail(grid.begin,
                  fmt::format("the active box has {} voxels; the limit is {}", box.voxels(), wanted.most_voxels));

    Vec3i size(0, 0, 0);
    for (int a = 0; a < 3; ++a) {
        const auto axis = static_cast<std::size_t>(a);
        size[a] = static_cast<int>(box.upper[axis] - box.lower[axis] + 1);
    }
    const GridPlace place = place_of(map, box, places);
    const std::optional<GridAxes> found = find_axes(place.steps, size);
    const GridAxes axes = found.value_or(GridAxes());
    facts.grid = shown(grid.name);
    facts.active = box.count;
    facts.axes = text_of(found, place);

    GridVolume volume;
    note_grid(grid.name, grid.passed_over, walk.background(), volume.notes);
    volume.size = turned(size, axes);
    volume.density.assign(static_cast<std::size_t>(box.voxels()), walk.background());
    BoxFilling filling{box, turned_steps(size, axes), volume.density};
    walk.run(filling, [&](const Vec3i& corner, const Leaf& leaf) {
        std::array<float, voxels_of_leaf> values;
        for (std::uint32_t n = 0; n < voxels_of_leaf; ++n) values[n] = as_float(leaf.getValue(n));
        filling.leaf(corner, values.data());
    });
    check_densities(volume, wanted.negative, wanted.file);
    if (const std::optional<std::string> fault = place_grid(volume, found, place))
        file.fail(grid.begin, *fault + ": mend its transform");
    return volume;
}

GridVolume convert_any(FileReader& file, const NanoVdbGrid& grid, const Wanted& wanted, VdbFacts& facts) {
    NanoVdbBytes bytes(file, grid);
    NanoVdbPlaces places(file, grid, bytes);
    const auto& data = places.at<nanovdb::GridData>(0);
    if (std::find(std::begin(grid_magics), std::end(grid_magics), data.mMagic) == std::end(grid_magics))
        places.damaged("it has not the mark of a grid of NanoVDB");
    if (data.mGridClass == nanovdb::GridClass::LevelSet)
        file.fail(grid.begin, fmt::format("the grid \"{}\" is a level set, not a fog volume", shown(grid.name)));
    switch (data.mGridType) {
        case nanovdb::GridType::Float:
            return convert<float>(file, grid, places, wanted, facts);
        case nanovdb::GridType::Double:
            return convert<double>(file, grid, places, wanted, facts);
        case nanovdb::GridType::Fp4:
            return convert<nanovdb::Fp4>(file, grid, places, wanted, facts);
        case nanovdb::GridType::Fp8:
            return convert<nanovdb::Fp8>(file, grid, places, wanted, facts);
        case nanovdb::GridType::Fp16:
            return convert<nanovdb::Fp16>(file, grid, places, wanted, facts);
        case nanovdb::GridType::FpN:
            return convert<nanovdb::FpN>(file, grid, places, wanted, facts);
        default:
            places.damaged("its type differs from the one that the file's header gives");
    }
}

}  // namespace

GridVolume read_nanovdb(const std::filesystem::path& file, const GridChoice& grid, Negative negative,
                        std::uint64_t most_voxels) {
    VdbFacts unused;
    return read_nanovdb(file, grid, negative, most_voxels, unused);
}

GridVolume read_nanovdb(const std::filesystem::path& file, const GridChoice& grid, Negative negative,
                        std::uint64_t most_voxels, VdbFacts& facts) {
    // A voxel takes up to 8 bytes; nodes that are almost empty take more.
    constexpr std::uint64_t bytes_a_voxel = 8, bytes_of_nodes = std::uint64_t{1} << 26;
    FileReader reader(file);
    try {
        const NanoVdbGrid chosen = find_nanovdb_grid(reader, file, grid, bytes_a_voxel * most_voxels + bytes_of_nodes);
        return convert_any(reader, chosen, {file, negative, most_voxels}, facts);
    } catch (const std::bad_alloc&) {
        reader.fail(0, "the file is damaged or too large: there is not enough memory for what it says it holds");
    }
}

}  // namespace shadowbench::scene
