// How a technique from outside is called: in this process (library.h), or in another one. Each function throws
// Error{internal}, place: the library's file, if the technique fails.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "techniques/technique.h"

namespace shadowbench::techniques {

// One map, empty when made.
class MapCalls {
public:
    virtual ~MapCalls() = default;

    virtual void add(const rays::LightRays& tile) = 0;
    virtual void finish() = 0;

    // `footprints` has one for each query, or none.
    virtual void lookup(std::span<const Query> queries, std::span<const Footprint> footprints,
                        std::span<float> visibility) const = 0;
    // `footprint` may be null.
    virtual void touched(const Query& query, const Footprint* footprint, std::vector<const void*>& lines) const = 0;

    struct Bytes {
        std::uint64_t held = 0, working = 0;
    };
    virtual Bytes bytes() const = 0;
    virtual NodeStats nodes() const = 0;
    virtual void stored(int x, int y, std::span<const float> depths, curves::Curve& out) const = 0;
};

class TechniqueCalls {
public:
    virtual ~TechniqueCalls() = default;

    virtual std::unique_ptr<MapCalls> create(const ParameterValues& values, const rays::MapLayout& layout) = 0;
    virtual double error_bound(const ParameterValues& values, const rays::MapLayout& layout) = 0;
    virtual std::uint64_t least_bytes(const ParameterValues& values, const rays::MapLayout& layout) = 0;
};

}  // namespace shadowbench::techniques
