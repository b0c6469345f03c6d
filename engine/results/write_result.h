// Writes a result to disk.
#pragma once

#include <filesystem>

#include "results/result.h"

namespace shadowbench::results {

// Writes result.json and result.csv into this folder. Throws Error{io}.
void write_result(const std::filesystem::path& folder, const Result& result);

}  // namespace shadowbench::results
