// Makes a library for shadowbench --technique-library of C++ functions and classes: see shadowbench_technique.h.
//
// A technique of one function says which curve a cell of the map stores; storage, lookups, filter and counts are
// supplied:
//
//   shadowbench::Curve shade(const shadowbench::CellRays& rays, const shadowbench::Values& values) { ... }
//   SHADOWBENCH_TECHNIQUES(shadowbench::of_function<shade>({.id = "mine", .title = "...", .paper = "..."}))
//
// A technique with a storage of its own is a class: see of_class. Exceptions become the message of the fault.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "shadowbench_function_map.hpp"
#include "shadowbench_technique.h"

// Hidden: see shadowbench_function_map.hpp.
#pragma GCC visibility push(hidden)
namespace shadowbench {

// See shadowbench_promises.
struct Promises {
    bool monotone = true, unit_range = true, opaque_only = false, localised = true, approximate = false, early = false;
    double leak = 0.0;
};

// What a technique says of itself. All pointers are to constants.
struct About {
    const char* id = "";
    const char* title = "";
    const char* paper = "";
    int version = 1;
    std::vector<shadowbench_parameter> parameters = {};
    std::vector<shadowbench_trade> trades = {};
    Promises promises = {};
    double (*error_bound)(const shadowbench_value* values, size_t value_count,
                          const shadowbench_layout* layout) = nullptr;
};

inline shadowbench_parameter number(const char* name, const char* doc, double standard, double min, double max) {
    return {name, doc, SHADOWBENCH_NUMBER, standard, min, max, nullptr, nullptr, 0};
}
inline shadowbench_parameter integer(const char* name, const char* doc, double standard, double min, double max) {
    return {name, doc, SHADOWBENCH_INTEGER, standard, min, max, nullptr, nullptr, 0};
}

// One of these words, which are static: static constexpr const char* words[] = {"few", "many"};
template <std::size_t count>
shadowbench_parameter choice(const char* name, const char* doc, const char* standard,
                             const char* const (&words)[count]) {
    return {name, doc, SHADOWBENCH_CHOICE, 0.0, 0.0, 0.0, standard, words, count};
}

// A technique with its functions; what it says of itself is filled in last, by `list`.
struct Technique {
    About about;
    shadowbench_technique functions;
};

namespace detail {

// The message of the last fault of this thread.
inline std::string& message() {
    static thread_local std::string text;
    return text;
}

template <class Call>
const char* guard(const Call& call) {
    try {
        call();
        return nullptr;
    } catch (const std::exception& error) {
        message() = error.what();
    } catch (...) {
        message() = "an exception";
    }
    return message().c_str();
}

template <class Item, class Call>
std::size_t give(Item* out, std::size_t capacity, const Call& call) {
    try {
        const std::vector<Item> items = call();
        std::copy_n(items.begin(), std::min(items.size(), capacity), out);
        return items.size();
    } catch (...) {
        return SHADOWBENCH_FAILED;
    }
}

// One address in each line of 64 bytes.
inline std::vector<const void*> lines_of(std::vector<const void*> addresses) {
    const auto line = [](const void* at) { return reinterpret_cast<std::uintptr_t>(at) / 64; };
    std::sort(addresses.begin(), addresses.end());
    const auto same = [&](const void* a, const void* b) { return line(a) == line(b); };
    addresses.erase(std::unique(addresses.begin(), addresses.end(), same), addresses.end());
    return addresses;
}

template <class Map>
shadowbench_technique functions_of() {
    shadowbench_technique f{};
    f.create = [](const shadowbench_value* values, std::size_t count, const shadowbench_layout* layout, void** map) {
        return guard([&] { *map = std::make_unique<Map>(Values(values, values + count), *layout).release(); });
    };
    f.destroy = [](void* map) { delete static_cast<Map*>(map); };
    f.add = [](void* map, const shadowbench_rays* tile) { return guard([&] { static_cast<Map*>(map)->add(*tile); }); };
    f.finish = [](void* map) { return guard([&] { static_cast<Map*>(map)->finish(); }); };
    f.lookup = [](const void* map, const Query* queries, const Footprint* shapes, std::size_t count, float* out) {
        return guard([&] { static_cast<const Map*>(map)->lookup(queries, shapes, count, out); });
    };
    f.bytes = [](const void* map, std::uint64_t* held, std::uint64_t* working) {
        return guard([&] {
            *held = static_cast<const Map*>(map)->held();
            *working = static_cast<const Map*>(map)->working();
        });
    };
    f.nodes = [](const void* map, std::int32_t x, std::int32_t y) {
        std::uint32_t count = std::numeric_limits<std::uint32_t>::max();
        guard([&] { count = static_cast<const Map*>(map)->nodes(x, y); });
        return count;
    };
    f.stored = [](const void* map, std::int32_t x, std::int32_t y, const float* depths, std::size_t count, Vertex* out,
                  std::size_t capacity) {
        return give(out, capacity, [&] { return static_cast<const Map*>(map)->stored(x, y, depths, count); });
    };
    f.touched = [](const void* map, const Query* query, const Footprint* shape, const void** out,
                   std::size_t capacity) {
        return give(out, capacity, [&] {
            std::vector<const void*> read;
            static_cast<const Map*>(map)->touched(*query, shape, read);
            return lines_of(std::move(read));
        });
    };
    return f;
}

// What the techniques say of themselves, and their functions.
inline std::vector<shadowbench_technique> list(const std::vector<Technique>& techniques) {
    std::vector<shadowbench_technique> all;
    for (const Technique& technique : techniques) {
        const About& about = technique.about;
        shadowbench_technique f = technique.functions;
        f.id = about.id;
        f.title = about.title;
        f.paper = about.paper;
        f.version = about.version;
        const Promises& p = about.promises;
        f.promises = {p.monotone, p.unit_range, p.opaque_only, p.localised, p.approximate, p.early, p.leak};
        f.parameters = about.parameters.data();
        f.parameter_count = about.parameters.size();
        f.trades = about.trades.data();
        f.trade_count = about.trades.size();
        f.error_bound = about.error_bound;
        all.push_back(f);
    }
    return all;
}

}  // namespace detail

// A technique with a storage of its own: a class with the constructor Map(const Values&, const Layout&) and the
// members of FunctionMap: add, finish, lookup, touched, held, working, nodes, stored. `cells`: which rays its
// functions stand for, a SHADOWBENCH_CELL_ constant.
template <class Map>
Technique of_class(About about, int cells) {
    Technique technique{std::move(about), detail::functions_of<Map>()};
    technique.functions.cells = cells;
    return technique;
}

// A technique of one function: Curve(const CellRays&, const Values&). The cells are SHADOWBENCH_CELL_PIXEL, _SAMPLE
// or _CENTRE.
template <auto function, int cells = SHADOWBENCH_CELL_PIXEL>
Technique of_function(About about) {
    return of_class<FunctionMap<function, cells>>(std::move(about), cells);
}

}  // namespace shadowbench
#pragma GCC visibility pop

// Once in a library: its techniques, each made by of_function or of_class.
#define SHADOWBENCH_TECHNIQUES(...)                                                                     \
    const shadowbench_library* shadowbench_techniques() {                                               \
        static const std::vector<::shadowbench::Technique> techniques{__VA_ARGS__};                     \
        static const std::vector<shadowbench_technique> list = ::shadowbench::detail::list(techniques); \
        static const shadowbench_library library{SHADOWBENCH_TECHNIQUE_ABI, std::uint32_t(list.size()), \
                                                 sizeof(shadowbench_technique), list.data()};           \
        return &library;                                                                                \
    }
