// The map of a technique from outside. It checks what its library gives back.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "techniques/external/calls.h"
#include "techniques/technique.h"

namespace shadowbench::techniques {

class ExternalMap final : public Map {
public:
    ExternalMap(std::shared_ptr<TechniqueCalls> technique, ParameterValues values, Cells cells);

    // These throw Error{internal} with the fault of the library.
    void begin(const BuildInput& input) override;
    void add(const rays::LightRays& tile) override;
    void finish() override;

    std::string fault() const override;
    void lookup(std::span<const Query> queries, std::span<float> visibility) const override;
    void lookup_shaped(std::span<const Query> queries, std::span<const Footprint> footprints,
                       std::span<float> visibility) const override;
    void touched(const Query& query, std::vector<const void*>& lines) const override;
    void touched_shaped(const Query& query, const Footprint& footprint, std::vector<const void*>& lines) const override;
    std::size_t bytes() const override { return static_cast<std::size_t>(bytes_.held); }
    std::size_t working_bytes() const override { return static_cast<std::size_t>(bytes_.working); }
    NodeStats nodes() const override { return nodes_; }
    Cells cells() const override { return cells_; }
    void stored(int x, int y, int channel, std::span<const float> depths, curves::Curve& out) const override;

private:
    // Calls the library, unless the map has a fault. Returns false for one, old or new.
    template <class Call>
    bool attempt(const Call& call) const;

    std::shared_ptr<TechniqueCalls> technique_;
    ParameterValues values_;
    Cells cells_;
    std::unique_ptr<MapCalls> map_;
    std::uint64_t least_bytes_ = 0;
    MapCalls::Bytes bytes_;
    NodeStats nodes_;
    mutable std::atomic<bool> faulty_ = false;
    mutable std::mutex mutex_;
    mutable std::string fault_;  // the first one
};

// The map of a library that cannot be used: it does not begin.
class BrokenMap final : public Map {
public:
    BrokenMap(std::string file, std::string reason);

    void begin(const BuildInput&) override;
    void add(const rays::LightRays&) override {}
    void finish() override {}
    void lookup(std::span<const Query>, std::span<float> visibility) const override;
    void touched(const Query&, std::vector<const void*>&) const override {}
    std::size_t bytes() const override { return 0; }
    std::size_t working_bytes() const override { return 0; }
    NodeStats nodes() const override { return {}; }
    Cells cells() const override { return Cells::none; }
    void stored(int, int, int, std::span<const float>, curves::Curve& out) const override { out.clear(); }

private:
    std::string file_, reason_;
};

}  // namespace shadowbench::techniques
