// Kernels: each runs one step of the engine, on inputs that are the same in every run, for Google Benchmark.
//
// Rules for all kernels:
//  - a kernel is checked once before it is timed; wrong answers are never timed;
//  - `bytes`, `nodes` and the errors are exact: the same in every run, on any number of threads, on any machine;
//  - each iteration also times the floor: it reads the same bytes and does nothing else;
//  - a kernel uses one thread, and no files except those that it wrote.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace shadowbench::kernels {

// Exact counts, which are not timed.
struct Exact {
    std::optional<double> bytes;         // held by the output
    std::optional<double> nodes;         // of the output: nodes, vertices, segments, elements
    std::optional<double> error;         // largest curve error of the output, over all depths and functions
    std::optional<double> lookup_error;  // RMS of the lookups against the truth
};

// A prepared kernel: its input exists, and its answers have been checked.
struct Subject {
    Exact exact;
    double vertices = 0.0;  // processed in one pass; 0: not counted
    double lookups = 0.0;   // in one pass; 0: none
    std::function<void()> pass;
    // Reads the memory that a pass reads, and does nothing else. Returns a sum, so that the compiler cannot remove the
    // reads. Empty if the kernel reads no memory that can be named.
    std::function<unsigned()> floor;
    double floor_share = 1.0;  // number of passes that the floor covers
};

struct Kernel {
    std::string name;                  // family/subject/argument:value/..., unique
    std::function<Subject()> prepare;  // throws if the answers are wrong
};
using Kernels = std::vector<Kernel>;

// All kernels.
Kernels all_kernels();

// The families, each in its own file.
void add_reference_kernels(Kernels& kernels);
void add_capture_kernels(Kernels& kernels);
void add_march_kernels(Kernels& kernels);
void add_sweep_kernels(Kernels& kernels);
void add_compression_kernels(Kernels& kernels);
void add_insert_kernels(Kernels& kernels);
void add_technique_kernels(Kernels& kernels);
void add_load_kernels(Kernels& kernels);

// Appends an address in each 64-byte line of the `count` bytes from `data` on.
void append_lines(const void* data, std::size_t bytes, std::vector<const void*>& lines);
template <class T>
void append_lines(const std::vector<T>& values, std::vector<const void*>& lines) {
    append_lines(values.data(), values.size() * sizeof(T), lines);
}

// A floor that reads these lines.
std::function<unsigned()> floor_of(std::vector<const void*> lines);

// Throws std::runtime_error{what} unless it holds.
void check(bool holds, const std::string& what);

}  // namespace shadowbench::kernels
