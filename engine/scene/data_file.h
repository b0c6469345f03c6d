// Data files without a scenario, for those who look before they run. The table of all formats is in data_file.cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/readers/files.h"
#include "scene/readers/vdb_facts.h"
#include "scene/scene.h"

namespace shadowbench::scene {

// What to read of a file that holds several things.
struct FileChoice {
    GridChoice grid;  // of .vdb and .nvdb
    DeepChoice deep;  // of deep .exr
};

struct DataFile;

// The loader of files that objects of several types load, each its own part.
inline constexpr std::string_view several_objects = "objects";

// Several formats may share an extension; the first whose `is` holds is the one.
struct FileFormat {
    std::string_view extension;  // in lower case: ".vdb"
    std::string_view title;      // what it is: "OpenVDB grid"
    std::string_view
        loader;  // what loads it in a scenario: "volume", the type of an object, "deep_image", or the above
    bool (*is)(const std::filesystem::path& file);  // null: always
    void (*read)(DataFile& data);                   // reads data.file into the other members
};

std::span<const FileFormat> file_formats();
// The first format of the name's extension, in any case of letters; null: none has it.
const FileFormat* format_of_name(const std::filesystem::path& name);

// A file as its reader gives it. An image is the alpha texture of a quad of height 1 that stands on the origin. Raw and
// DDS volumes, whose files have no box, get one that begins at the origin, with voxels of edge 1.
struct DataFile {
    std::filesystem::path file;
    FileChoice choice;
    const FileFormat* format = nullptr;
    std::uint64_t bytes = 0;
    // One object, which may hold nothing that casts a shadow; or several, whose media have names; or a deep image.
    Scene scene;
    // The file has no width of its hair or points. For that of n strands, 1 / (20 sqrt(n)) of the diagonal stands in, a
    // 2000th at least and a 50th at most, so that few strands are seen too; for that of points, half the distance at
    // which as many would be spread over a sphere of that size.
    bool guessed_radius = false;
    std::uint64_t short_strands = 0;  // hair: strands without length, which are left out
    bool no_box = false;              // volume: the file has no box
    std::string raw_type;             // raw values: as in a scenario, "uint8"
    std::optional<VdbFacts> vdb;
    std::vector<std::string> facts;  // volume: what else the file says of itself, in lines
};

// Throws Error: no_such_file, io, or bad_input for what the reader refuses and for extensions that no format has.
DataFile read_data_file(const std::filesystem::path& file, const FileChoice& choice);

struct RawLayout {
    Vec3i size{0, 0, 0};
    std::string type;
    bool type_stated = false;  // by the name
};

// The layout of raw values: the size and the type that the name states, as in "ball_32x32x24_int16.raw". Without a size
// it is a cube; without a type, uint8 or float32, whichever fills the file. Throws Error{bad_input} if the values are
// not as many as the unpacked bytes of the file, `bytes`, hold.
RawLayout raw_layout(const std::filesystem::path& file, std::uint64_t bytes);

// The box of what casts shadows; of a mesh without triangles, that of its vertices. Empty for a deep image.
Box3d bounds(const DataFile& data);

// Whether a light could meet anything in the file, or in one of its objects.
bool casts_shadow(const DataFile& data);
bool casts_shadow(const Object& object);

}  // namespace shadowbench::scene
