#include <memory>
#include <ostream>
#include <string>

#include <CLI/CLI.hpp>

#include "service/cli/file_commands.h"
#include "service/cli/options.h"

namespace shadowbench::service {
namespace {

constexpr const char* data_formats =
    "Data files are meshes (.obj, .ply, .stl, .gltf, .glb), point clouds (.ply), hair (.tfx, .hair, .txt), volumes "
    "(.vdb, .nvdb, .nrrd, .nhdr, .mhd, .mha, .vol, .slc, .pvm, .dds, .raw, .gz), scenes (.pbrt), deep images (.exr), "
    "and images as alpha textures (.png, .jpg, .jpeg, .tif, .tiff, .tga, .dds, .exr). Raw values, which gzip may have "
    "packed (.gz), form a cube of uint8 or float32, or have their size and type in the name of the file, as in "
    "ball_32x32x24_int16.raw.";

void add_data_options(CLI::App& command, FileArguments& arguments, const char* files) {
    command.add_option("FILE", arguments.files, files)->required();
    command.add_option("--grid", arguments.grid,
                       "The grid to read from .vdb and .nvdb files: its name or number, from 0");
    command.add_option("--part", arguments.part, "The part to read from deep images: its name, or its number, from 0");
    command.add_option("--layer", arguments.layer, "The layer to read from deep images");
}

}  // namespace

void add_inspect(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<FileArguments>();
    CLI::App* inspect = app.add_subcommand("inspect", "Describe data files, and what loads each in a scenario");
    set_help(*inspect, command_groups::files,
             {"inspect hair.tfx tree.obj smoke.vdb", "inspect fire.vdb --grid temperature", "inspect map.dsm"},
             std::string("Prints what a file is, its counts, its box, the range of its values, what the reader passed "
                         "over, and an object of a scenario that loads it. A .dsm file, a tiled deep shadow map, is "
                         "checked and described.\n") +
                 data_formats);
    add_data_options(*inspect, *arguments, "Data files, or .dsm files");
    commands.push_back({inspect, [arguments](std::ostream& out, std::ostream& err) {
                            inspect_command(*arguments, out, err);
                            return 0;
                        }});
}

void add_new(CLI::App& app, Commands& commands) {
    const auto arguments = std::make_shared<NewArguments>();
    CLI::App* made = app.add_subcommand("new", "Make a scenario around data files, to start from");
    set_help(*made, command_groups::files,
             {"new tree.obj --out tree.json", "new leaves.obj leaves.png trunk.obj --out tree.json",
              "new scan.stl --up z --out scan.json"},
             std::string("Places a ground, a light and a camera by the boxes of the files, and takes techniques that "
                         "fit them. The optical depth is about 2 through a volume's densest column, along the axis "
                         "where that is least, and through a point of a cloud; media of pbrt keep theirs. The opacity "
                         "of hair is 0.6. An image becomes the alpha texture of the mesh before it, if that has "
                         "texture coordinates, and else a quad. A deep image stands alone.\n") +
                 data_formats);
    add_data_options(*made, *arguments, "Data files");
    made->add_option("--out", arguments->out,
                     "Write the scenario to this file, with names of data files relative to its folder [standard "
                     "output, with the names as given, which hold for a scenario in the current folder]");
    made->add_flag("--force", arguments->force, "Write over the file of --out if it exists");
    made->add_option("--up", arguments->up, "The axis that points up: y or z")
        ->check(CLI::IsMember({"y", "z"}))
        ->capture_default_str();
    commands.push_back({made, [arguments](std::ostream& out, std::ostream& err) {
                            new_command(*arguments, out, err);
                            return 0;
                        }});
}

}  // namespace shadowbench::service
