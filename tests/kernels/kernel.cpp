#include "kernels/kernel.h"

#include <stdexcept>
#include <utility>

#include "bench/floor.h"

namespace shadowbench::kernels {

Kernels all_kernels() {
    Kernels kernels;
    for (const auto add : {add_reference_kernels, add_capture_kernels, add_march_kernels, add_sweep_kernels,
                           add_compression_kernels, add_insert_kernels, add_technique_kernels, add_load_kernels})
        add(kernels);
    return kernels;
}

void append_lines(const void* data, std::size_t bytes, std::vector<const void*>& lines) {
    constexpr std::size_t line = 64;
    for (std::size_t at = 0; at < bytes; at += line) lines.push_back(static_cast<const char*>(data) + at);
}

std::function<unsigned()> floor_of(std::vector<const void*> lines) {
    return [lines = std::move(lines)] { return bench::read_lines(lines); };
}

void check(bool holds, const std::string& what) {
    if (!holds) throw std::runtime_error(what);
}

}  // namespace shadowbench::kernels
