// Writes a file that survives a kill of the program and a loss of power.
#pragma once

#include <filesystem>
#include <string>

namespace shadowbench::base {

// Writes a temporary file beside its place, syncs it to the disk, moves it to its place, and syncs the folder, which
// must exist, if its file system can. A reader sees the old or the new content, never half of one. Programs on several
// computers that share the folder may write the same file: the last wins. Throws Error{io}, place the file; then what
// was there before stays, unless only the folder could not be synced.
void write_durable(const std::filesystem::path& file, const std::string& content);

}  // namespace shadowbench::base
