#include "techniques/external/direct_calls.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <exception>
#include <limits>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/printable.h"
#include "techniques/cell_grid.h"

namespace shadowbench::techniques {
namespace {

using base::Error;
using base::ErrorCode;

// Queries, footprints and vertices cross the border as they are.
static_assert(sizeof(Query) == sizeof(shadowbench_query) && offsetof(Query, z) == offsetof(shadowbench_query, z) &&
              offsetof(Query, width) == offsetof(shadowbench_query, width));
static_assert(sizeof(Footprint) == sizeof(shadowbench_footprint) &&
              offsetof(Footprint, vx) == offsetof(shadowbench_footprint, vx));
static_assert(sizeof(curves::Vertex) == sizeof(shadowbench_vertex) &&
              offsetof(curves::Vertex, value) == offsetof(shadowbench_vertex, value));

constexpr std::size_t most_vertices = std::size_t{1} << 22, most_lines = std::size_t{1} << 22;
constexpr std::uint32_t most_nodes = std::uint32_t{1} << 22;
constexpr std::uint64_t most_bytes = std::uint64_t{1} << 48;  // sums of a few maps must not overflow
constexpr std::size_t longest_message = 400;

// The faults of one technique.
class Faults {
public:
    Faults(std::string file, std::string id) : file_(std::move(file)), id_(std::move(id)) {}

    [[noreturn]] void report(const std::string& what) const {
        throw Error(ErrorCode::internal, file_, fmt::format("technique {}: {}", id_, what));
    }

    // Calls a function of the library; what it throws becomes a fault.
    template <class Call>
    auto guard(const char* function, const Call& call) const {
        try {
            return call();
        } catch (const std::exception& error) {
            report(fmt::format("{}() threw an exception: {}", function,
                               base::printable(std::string_view(error.what()).substr(0, longest_message))));
        } catch (...) {
            report(fmt::format("{}() threw an exception", function));
        }
    }

    // The same for functions that return a message.
    template <class Call>
    void check(const char* function, const Call& call) const {
        const char* message = guard(function, call);
        if (message)
            report(fmt::format("{}() failed: {}", function,
                               base::printable({message, ::strnlen(message, longest_message)})));
    }

private:
    std::string file_, id_;
};

struct Declared {
    const shadowbench_technique& functions;
    Cells cells;
    std::vector<std::string> parameters;  // their names, as declared
    Faults faults;
};

// In the order of the declaration; the words are those of `values`.
std::vector<shadowbench_value> values_of(const Declared& declared, const ParameterValues& values) {
    std::vector<shadowbench_value> list;
    for (const std::string& name : declared.parameters) {
        const ParameterValues::Value& value = values.at(name);
        const double* number = std::get_if<double>(&value);
        list.push_back({number ? *number : 0.0, number ? nullptr : std::get<std::string>(value).c_str()});
    }
    return list;
}

shadowbench_layout layout_of(const rays::MapLayout& layout) {
    return {layout.width,       layout.height,        layout.samples_x, layout.samples_y, layout.tile_width,
            layout.tile_height, layout.media ? 1 : 0, layout.z_min,     layout.z_max};
}

shadowbench_rays rays_of(const rays::LightRays& tile) {
    return {tile.x0,
            tile.y0,
            tile.width,
            tile.height,
            tile.samples,
            tile.begin.data(),
            tile.z_front.data(),
            tile.z_back.empty() ? nullptr : tile.z_back.data(),
            tile.transmittance.data()};
}

// Lets a function write a list, for which it may need more room. `item` makes an empty item.
template <class Item, class Write>
void read_list(const Faults& faults, const char* function, std::size_t most, std::vector<Item>& out,
               const Write& write) {
    out.resize(std::max<std::size_t>(out.capacity(), 16));
    std::size_t count = faults.guard(function, [&] { return write(out.data(), out.size()); });
    const std::size_t first = count;
    if (count != SHADOWBENCH_FAILED && count > out.size() && count <= most) {
        out.resize(count);
        count = faults.guard(function, [&] { return write(out.data(), out.size()); });
    }
    if (count == SHADOWBENCH_FAILED) faults.report(fmt::format("{}() failed", function));
    if (first > most) faults.report(fmt::format("{}() returned {}; at most {} are read", function, first, most));
    if (count > out.size())
        faults.report(fmt::format("{}() returned {}, and with room for as many {}", function, first, count));
    out.resize(count);
}

class DirectMap final : public MapCalls {
public:
    DirectMap(std::shared_ptr<const Declared> declared, const ParameterValues& values, const rays::MapLayout& layout)
        : declared_(std::move(declared)), grid_(make_cells(layout, declared_->cells)) {
        const std::vector<shadowbench_value> list = values_of(*declared_, values);
        const shadowbench_layout given = layout_of(layout);
        faults().check("create", [&] { return functions().create(list.data(), list.size(), &given, &map_); });
        if (!map_) faults().report("create() made no map");
    }
    ~DirectMap() override {
        try {
            functions().destroy(map_);
        } catch (...) {  // the map is gone either way, and nobody waits for an answer
        }
    }
    DirectMap(const DirectMap&) = delete;
    DirectMap& operator=(const DirectMap&) = delete;

    void add(const rays::LightRays& tile) override {
        const shadowbench_rays given = rays_of(tile);
        faults().check("add", [&] { return functions().add(map_, &given); });
    }
    void finish() override {
        faults().check("finish", [&] { return functions().finish(map_); });
    }
    void lookup(std::span<const Query> queries, std::span<const Footprint> footprints,
                std::span<float> visibility) const override {
        const auto* asked = reinterpret_cast<const shadowbench_query*>(queries.data());
        const auto* shapes =
            footprints.empty() ? nullptr : reinterpret_cast<const shadowbench_footprint*>(footprints.data());
        faults().check("lookup",
                       [&] { return functions().lookup(map_, asked, shapes, queries.size(), visibility.data()); });
    }
    void touched(const Query& query, const Footprint* footprint, std::vector<const void*>& lines) const override {
        if (!functions().touched) return;
        std::vector<const void*> own;
        read_list(faults(), "touched", most_lines, own, [&](const void** out, std::size_t capacity) {
            return functions().touched(map_, reinterpret_cast<const shadowbench_query*>(&query),
                                       reinterpret_cast<const shadowbench_footprint*>(footprint), out, capacity);
        });
        for (const void* line : own)
            if (!line) faults().report("touched() gave a null pointer");
        lines.insert(lines.end(), own.begin(), own.end());
    }
    Bytes bytes() const override {
        Bytes bytes;
        faults().check("bytes", [&] { return functions().bytes(map_, &bytes.held, &bytes.working); });
        if (std::max(bytes.held, bytes.working) > most_bytes)
            faults().report(fmt::format("bytes() returned {} and {}; at most {} are believed", bytes.held,
                                        bytes.working, most_bytes));
        if (bytes.held > bytes.working)
            faults().report(
                fmt::format("bytes() says that the map holds {} bytes, and that building it never held more "
                            "than {}",
                            bytes.held, bytes.working));
        return bytes;
    }
    NodeStats nodes() const override {
        NodeStats stats;
        if (!functions().nodes || declared_->cells == Cells::none) return stats;
        for (int y = 0; y < grid_.height; ++y)
            for (int x = 0; x < grid_.width; ++x) {
                const std::uint32_t count = faults().guard("nodes", [&] { return functions().nodes(map_, x, y); });
                if (count > most_nodes)
                    faults().report(fmt::format("nodes() of cell ({}, {}) returned {}, which is more than {}", x, y,
                                                count, most_nodes));
                stats.add(count);
            }
        return stats;
    }
    void stored(int x, int y, std::span<const float> depths, curves::Curve& out) const override {
        if (!functions().stored) return out.clear();
        read_list(faults(), "stored", most_vertices, out, [&](curves::Vertex* vertices, std::size_t capacity) {
            return functions().stored(map_, x, y, depths.data(), depths.size(),
                                      reinterpret_cast<shadowbench_vertex*>(vertices), capacity);
        });
    }

private:
    const shadowbench_technique& functions() const { return declared_->functions; }
    const Faults& faults() const { return declared_->faults; }

    std::shared_ptr<const Declared> declared_;
    CellGrid grid_;
    void* map_ = nullptr;
};

// What a function says of a map before it is made.
template <class Function>
auto ask(const Declared& declared, const char* name, const Function& function, const ParameterValues& values,
         const rays::MapLayout& layout) {
    const std::vector<shadowbench_value> list = values_of(declared, values);
    const shadowbench_layout given = layout_of(layout);
    return declared.faults.guard(name, [&] { return function(list.data(), list.size(), &given); });
}

class DirectTechnique final : public TechniqueCalls {
public:
    DirectTechnique(const shadowbench_technique& technique, const Description& description, const std::string& file)
        : declared_(
              std::make_shared<Declared>(Declared{technique, description.cells, {}, Faults(file, description.id)})) {
        for (const OutsideParameter& parameter : description.parameters)
            declared_->parameters.push_back(parameter.name);
    }

    std::unique_ptr<MapCalls> create(const ParameterValues& values, const rays::MapLayout& layout) override {
        return std::make_unique<DirectMap>(declared_, values, layout);
    }
    double error_bound(const ParameterValues& values, const rays::MapLayout& layout) override {
        if (!declared_->functions.error_bound) return std::numeric_limits<double>::infinity();
        const double bound = ask(*declared_, "error_bound", declared_->functions.error_bound, values, layout);
        if (!(bound >= 0.0)) declared_->faults.report(fmt::format("error_bound() returned {}", bound));
        return bound;
    }
    std::uint64_t least_bytes(const ParameterValues& values, const rays::MapLayout& layout) override {
        if (!declared_->functions.least_bytes) return 0;
        const std::uint64_t least = ask(*declared_, "least_bytes", declared_->functions.least_bytes, values, layout);
        if (least > most_bytes)  // else the whole scenario would be refused for lack of memory
            declared_->faults.report(
                fmt::format("least_bytes() returned {}; at most {} are believed", least, most_bytes));
        return least;
    }

private:
    std::shared_ptr<Declared> declared_;
};

}  // namespace

std::shared_ptr<TechniqueCalls> call_directly(const shadowbench_technique& technique, const Description& description,
                                              const std::string& file) {
    return std::make_shared<DirectTechnique>(technique, description, file);
}

}  // namespace shadowbench::techniques
