// Kernels: one step of the engine each, on inputs that are the same in every run, for Google Benchmark.
//
// Rules that hold for all of them:
//  - a kernel is checked once, before it is timed; a wrong answer is never timed;
//  - `bytes`, `nodes` and the errors are exact: the same in every run, on any number of threads, on any machine;
//  - beside its time stands the floor of the same iteration: the same bytes are read, and nothing else is done;
//  - one thread, no file but those that it made itself.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace shadowbench::kernels {

// What is counted and not timed.
struct Exact {
    std::optional<double> bytes;         // held by the output
    std::optional<double> nodes;         // of the output: nodes, vertices, segments, elements
    std::optional<double> error;         // largest curve error of the output, over all depths and functions
    std::optional<double> lookup_error;  // RMS of the lookups against the truth
};

// A kernel made ready: its input is there, its answers have been checked.
struct Subject {
    Exact exact;
    double vertices = 0.0;  // that one pass goes over; 0: does not count
    double lookups = 0.0;   // of one pass; 0: none
    std::function<void()> pass;
    // Reads what a pass reads and does nothing else; the sum is returned so that the reads cannot be left out. Empty:
    // the kernel reads nothing that could be named.
    std::function<unsigned()> floor;
    double floor_share = 1.0;  // passes that the floor covers
};

struct Kernel {
    std::string name;                  // family/subject/argument:value/..., unlike any other
    std::function<Subject()> prepare;  // throws what is wrong with the answers
};
using Kernels = std::vector<Kernel>;

// The list.
Kernels all_kernels();

// The families, each in its own file.
void add_reference_kernels(Kernels& kernels);
void add_capture_kernels(Kernels& kernels);
void add_sweep_kernels(Kernels& kernels);
void add_compression_kernels(Kernels& kernels);
void add_technique_kernels(Kernels& kernels);
void add_load_kernels(Kernels& kernels);

// Appends an address in each 64-byte line of `count` bytes from `data` on.
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
