// The commands that look at data files before a scenario has them.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "scene/data_file.h"

namespace shadowbench::service {

struct FileArguments {
    std::vector<std::string> files;
    // What to read of files that hold several things; empty: what a scenario without these keys reads.
    std::string grid, part;  // a name, or a number, from 0
    std::string layer;
};

struct NewArguments : FileArguments {
    std::string out;       // file; empty: standard output
    std::string up = "y";  // or z
    bool force = false;    // write over an existing file
};

// Shows progress on `err`.
scene::DataFile read_data(const FileArguments& arguments, const std::string& file, std::ostream& err);

// Describes each file, also tiled deep shadow maps.
void inspect_command(const FileArguments& arguments, std::ostream& out, std::ostream& err);

// Writes a scenario around the files.
void new_command(const NewArguments& arguments, std::ostream& out, std::ostream& err);

}  // namespace shadowbench::service
