// Results on disk.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/result.h"

namespace shadowbench::bench {

// A file and all that it will hold.
struct NewFile {
    std::filesystem::path path;
    std::string content;
};

// Writes all files under temporary names beside their places, then renames them: a reader sees the old or the new
// content of each, never half of one. Missing folders are made. When writing fails, nothing that was made stays, and
// what was there before is as it was. Throws Error{io}.
void write_files(const std::vector<NewFile>& files);

// Throws Error{io} when files could not be made in this folder, before hours are spent on what goes there.
void check_writable(const std::filesystem::path& folder);

// result.json and result.csv, in this folder. Throws Error{io}.
void write_result(const std::filesystem::path& folder, const Result& result);

}  // namespace shadowbench::bench
