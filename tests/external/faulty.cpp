// A library that does wrong what it is asked for: a technique by its parameter `fault`, the library itself by
// $SHADOWBENCH_TEST_FAULT. It adds a line to the file $SHADOWBENCH_TEST_OPENED. With the fault "none" the map is sound:
// everything is lit, and nothing casts a shadow.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>

#include "shadowbench_technique.h"

namespace {

const char* const words[] = {"none",  "create", "no_map",     "add",      "finish",  "lookup",   "throw",
                             "nan",   "few",    "rises",      "vertices", "endless", "unsorted", "nodes",
                             "bytes", "least",  "null_lines", "bound",    "second",  "crash",    "loop",
                             "print", "heavy",  "immense",    "greedy"};

struct Map {
    std::string fault;
};

int maps_made = 0;

bool has(const void* map, const char* fault) {
    return static_cast<const Map*>(map)->fault == fault;
}
const char* fails(const void* map, const char* fault) {
    return has(map, fault) ? "as it was asked to" : nullptr;
}

const char* create(const shadowbench_value* values, size_t count, const shadowbench_layout*, void** map) {
    const std::string fault = count == 1 && values[0].word ? values[0].word : "no value";
    if (fault == "create") return "line one\nline two";
    if (fault == "second" && ++maps_made > 1) return "only one map is made";
    if (fault != "no_map") *map = new Map{fault};
    return nullptr;
}
void destroy(void* map) {
    delete static_cast<Map*>(map);
}
const char* add(void* map, const shadowbench_rays*) {
    if (has(map, "throw")) throw std::runtime_error("over the border");
    return fails(map, "add");
}
const char* finish(void* map) {
    if (has(map, "greedy")) {
        static volatile char* taken = new char[size_t{4} << 30];
        taken[0] = 1;
    }
    if (has(map, "print")) std::puts("printed by a library"), std::fflush(stdout);
    return fails(map, "finish");
}
const char* lookup(const void* map, const shadowbench_query*, const shadowbench_footprint*, size_t count, float* out) {
    if (has(map, "crash")) std::raise(SIGSEGV);
    if (has(map, "loop"))
        for (volatile bool on = true; on;) {
        }
    for (size_t i = 0; i < count - (has(map, "few") ? 1 : 0); ++i)
        out[i] = has(map, "nan") ? std::numeric_limits<float>::quiet_NaN() : 1.0f;
    return fails(map, "lookup");
}
const char* bytes(const void* map, uint64_t* held, uint64_t* working) {
    *held = has(map, "heavy") ? uint64_t{1} << 63 : 8;
    *working = has(map, "bytes") ? 4 : *held;
    return nullptr;
}
uint32_t nodes(const void* map, int32_t, int32_t) {
    return has(map, "nodes") ? 4000000000u : 0u;
}
size_t stored(const void* map, int32_t, int32_t, const float*, size_t, shadowbench_vertex* out, size_t capacity) {
    if (has(map, "endless")) return std::numeric_limits<size_t>::max() / 2;
    if (has(map, "vertices")) return capacity + 1;
    if (!has(map, "rises") && !has(map, "unsorted")) return 0;
    out[0] = {2.0f, 0.5f};
    out[1] = {has(map, "unsorted") ? 1.0f : 3.0f, 1.0f};
    return 2;
}
size_t touched(const void* map, const shadowbench_query*, const shadowbench_footprint*, const void** lines,
               size_t capacity) {
    if (!has(map, "null_lines") || capacity == 0) return 0;
    lines[0] = nullptr;
    return 1;
}
double error_bound(const shadowbench_value* values, size_t, const shadowbench_layout*) {
    return std::strcmp(values[0].word, "bound") == 0 ? -1.0 : std::numeric_limits<double>::infinity();
}
uint64_t least_bytes(const shadowbench_value* values, size_t, const shadowbench_layout*) {
    if (std::strcmp(values[0].word, "immense") == 0) return uint64_t{1} << 60;
    return std::strcmp(values[0].word, "least") == 0 ? 16 : 0;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const shadowbench_library* shadowbench_techniques() {
    const char* set = std::getenv("SHADOWBENCH_TEST_FAULT");
    const std::string fault = set ? set : "";
    if (const char* opened = std::getenv("SHADOWBENCH_TEST_OPENED"))
        if (std::FILE* file = std::fopen(opened, "a")) std::fputs("opened\n", file), std::fclose(file);
    if (fault == "hang")
        for (volatile bool on = true; on;) {
        }
    static shadowbench_parameter parameter;
    static shadowbench_technique techniques[2];
    static shadowbench_library library;
    parameter = {"fault", "what goes wrong", SHADOWBENCH_CHOICE, 0, 0, 0, "none", words, sizeof words / sizeof *words};
    shadowbench_technique good{};
    good.id = "faulty";
    good.title = "does wrong what it is asked for";
    good.paper = "a test";
    good.version = 3;
    good.cells = SHADOWBENCH_CELL_PIXEL;
    good.promises = {1, 1, 0, 0, 1, 0, 1.0};  // monotone, in [0, 1]; off by up to 1 behind everything
    good.parameters = &parameter;
    good.parameter_count = 1;
    good.create = create;
    good.destroy = destroy;
    good.add = add;
    good.finish = finish;
    good.lookup = lookup;
    good.bytes = bytes;
    good.nodes = nodes;
    good.stored = stored;
    good.touched = touched;
    good.error_bound = error_bound;
    good.least_bytes = least_bytes;
    techniques[0] = techniques[1] = good;
    library = {SHADOWBENCH_TECHNIQUE_ABI, 1, sizeof(shadowbench_technique), techniques};
    if (fault == "throw") throw 1;
    if (fault == "crash") std::raise(SIGSEGV);
    if (fault == "null") return nullptr;
    if (fault == "abi") library.abi = 7;
    if (fault == "size") library.technique_size = 8;
    if (fault == "empty") library.technique_count = 0;
    if (fault == "twice") library.technique_count = 2;
    if (fault == "many") library.technique_count = 4000000000u;
    if (fault == "no_list") library.techniques = nullptr;
    if (fault == "id") techniques[0].id = "Faulty!";
    if (fault == "null_title") techniques[0].title = nullptr;
    if (fault == "taken") techniques[0].id = "deep";
    if (fault == "incomplete") techniques[0].lookup = nullptr;
    if (fault == "no_stored") techniques[0].stored = nullptr;
    if (fault == "cells") techniques[0].cells = 9;
    if (fault == "standard") parameter.standard_word = "fine";
    if (fault == "kind") parameter.kind = -1;
    return &library;
}
