// The folder of the files that kernels write and load.
#pragma once

#include <filesystem>

namespace shadowbench::kernels {

// A folder of this process for the files that kernels load. Removed with its contents when the program ends.
const std::filesystem::path& scratch_folder();

}  // namespace shadowbench::kernels
