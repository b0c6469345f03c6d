// A result on disk.
#pragma once

#include <filesystem>

#include "results/result.h"

namespace shadowbench::results {

// result.json and result.csv, in this folder. Throws Error{io}.
void write_result(const std::filesystem::path& folder, const Result& result);

}  // namespace shadowbench::results
