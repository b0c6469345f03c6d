// The extension of a file's name chooses its reader.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace shadowbench::scene {

// In lower case, as ".vdb"; empty without one.
std::string extension_of(const std::filesystem::path& file);

// What is wrong with the name of a file that no reader takes: its extension, and those that `kind` of file may have:
// "the name of a hair file must end in .tfx, .hair, .txt or .pbrt; .abc is not read".
std::string unknown_extension(const std::filesystem::path& file, std::string_view kind,
                              const std::vector<std::string_view>& known);

}  // namespace shadowbench::scene
