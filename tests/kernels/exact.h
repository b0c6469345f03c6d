// What kernels count, without a clock.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "kernels/inject.h"
#include "kernels/kernel.h"

namespace shadowbench::kernels {

// Prepares and checks the kernels in whose names `filter` is found, and writes what they count in the shape of Google
// Benchmark's JSON: the same text in every run, whatever the machine. Returns how many gave wrong answers; they stand
// there with error_occurred and error_message. Throws std::runtime_error when the file cannot be written.
std::size_t write_exact(std::span<const Kernel> kernels, const std::string& filter,
                        std::span<const Injection> injections, const std::filesystem::path& file);

}  // namespace shadowbench::kernels
