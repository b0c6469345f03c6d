// The counts of kernels, without a clock.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "kernels/inject.h"
#include "kernels/kernel.h"

namespace shadowbench::kernels {

// Prepares and checks the kernels in whose names `filter` is found, and writes their counts in the form of Google
// Benchmark's JSON: the same text in every run, on every machine. Returns the number of kernels with wrong answers;
// their entries have error_occurred and error_message. Throws std::runtime_error if the file cannot be written.
std::size_t write_exact(std::span<const Kernel> kernels, const std::string& filter,
                        std::span<const Injection> injections, const std::filesystem::path& file);

}  // namespace shadowbench::kernels
