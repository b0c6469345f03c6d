// Checks what the headers of an OpenEXR file claim against its bytes, before OpenImageIO reads it: OpenImageIO 2.4 ends
// the process on some headers, and the libraries allocate memory for what others claim.
#pragma once

#include <filesystem>

namespace shadowbench::scene {

// Walks over the headers of all parts. Throws Error: no_such_file, io, or bad_input with the byte of a header that is
// damaged, cut short, over a limit or of an unsupported kind.
void check_exr(const std::filesystem::path& file);

}  // namespace shadowbench::scene
