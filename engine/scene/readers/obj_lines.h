// The lines of a Wavefront OBJ file, checked (Wavefront Technologies, Advanced Visualizer manual, appendix B1).
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/readers/files.h"

namespace shadowbench::scene {

struct ObjLines {
    std::string kept;                       // lines "v", "vt" and "f", with their numbers and nothing else
    std::vector<std::size_t> line_of_face;  // in the file, from 1
};

// Counts in `file` what is passed over: faces of fewer than 3 corners, lines and points, free-form curves and surfaces,
// and words that OBJ does not know. Throws Error{bad_input} with file:line for a number that is none, an index of
// nothing, and a line that begins with no word at all; and for a file in which OBJ's own words are missing.
ObjLines check_obj(const std::string& text, const std::filesystem::path& name, MeshFile& file);

}  // namespace shadowbench::scene
