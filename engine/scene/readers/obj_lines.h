// The lines of a Wavefront OBJ file, checked (Wavefront Technologies, Advanced Visualizer manual, appendix B1).
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scene/readers/files.h"

namespace shadowbench::scene {

struct ObjLines {
    std::string kept;                       // the lines "v", "vt" and "f", with nothing but their numbers
    std::vector<std::size_t> line_of_face;  // in the file, from 1
};

// Calls take() with the lines of the file, about a megabyte at a time; it may move them away. Counts in `file` what is
// passed over: faces of fewer than 3 corners, lines and points, free-form curves and surfaces, and words that OBJ does
// not know. Throws Error{bad_input} with file:line for a word that is not a number, an index that does not exist, and a
// line that does not begin with a word; also for a file without any of OBJ's own words. Faces may stand before their
// vertices, so only its return shows that all of these exist.
void check_obj(const std::string& text, const std::filesystem::path& name, MeshFile& file,
               const std::function<void(ObjLines& lines)>& take);

}  // namespace shadowbench::scene
