// What the headers of an OpenEXR file claim, held against its bytes before OpenImageIO reads it: OpenImageIO 2.4 ends
// the process on some headers, and the libraries take memory for what others claim.
#pragma once

#include <filesystem>

namespace shadowbench::scene {

// Walks over the headers of all parts. Throws Error: no_such_file, io, or bad_input with "file:offset" of what is
// damaged, cut short, over a limit or of a kind that is not read.
void check_exr(const std::filesystem::path& file);

}  // namespace shadowbench::scene
