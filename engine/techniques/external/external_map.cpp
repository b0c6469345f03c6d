#include "techniques/external/external_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"

namespace shadowbench::techniques {

using base::Error;
using base::ErrorCode;

namespace {

// What reads curves takes these for granted.
void check_vertices(int x, int y, const curves::Curve& curve) {
    for (std::size_t i = 0; i < curve.size(); ++i) {
        const bool finite = std::isfinite(curve[i].z) && std::isfinite(curve[i].value);
        if (finite && (i == 0 || curve[i].z >= curve[i - 1].z)) continue;
        throw Error(
            ErrorCode::internal, "",
            fmt::format("stored() of cell ({}, {}) gave vertex {}, ({}, {}), {}", x, y, i, curve[i].z, curve[i].value,
                        finite ? "whose depth is below that of the vertex before" : "which is not finite"));
    }
}

}  // namespace

ExternalMap::ExternalMap(std::shared_ptr<TechniqueCalls> technique, ParameterValues values, Cells cells)
    : technique_(std::move(technique)), values_(std::move(values)), cells_(cells) {}

template <class Call>
bool ExternalMap::attempt(const Call& call) const {
    if (faulty_) return false;
    try {
        call();
        return true;
    } catch (const Error& error) {
        const std::lock_guard lock(mutex_);
        if (fault_.empty()) fault_ = error.message();
        faulty_ = true;
        return false;
    }
}

void ExternalMap::begin(const BuildInput& input) {
    technique_->error_bound(values_, input.layout);  // throws, which the row's own does not
    least_bytes_ = technique_->least_bytes(values_, input.layout);
    map_ = technique_->create(values_, input.layout);
}

void ExternalMap::add(const rays::LightRays& tile) {
    map_->add(tile);
}

void ExternalMap::finish() {
    map_->finish();
    bytes_ = map_->bytes();
    if (bytes_.held < least_bytes_)
        throw Error(
            ErrorCode::internal, "",
            fmt::format("the map holds {} bytes, and least_bytes() says at least {}", bytes_.held, least_bytes_));
    nodes_ = map_->nodes();
}

std::string ExternalMap::fault() const {
    const std::lock_guard lock(mutex_);
    return fault_;
}

void ExternalMap::lookup(std::span<const Query> queries, std::span<float> visibility) const {
    lookup_shaped(queries, {}, visibility);
}

void ExternalMap::lookup_shaped(std::span<const Query> queries, std::span<const Footprint> footprints,
                                std::span<float> visibility) const {
    if (queries.empty()) return;
    constexpr float none = std::numeric_limits<float>::quiet_NaN();
    visibility[queries.size() - 1] = none;  // a library that answers too few leaves it
    const bool answered = attempt([&] { map_->lookup(queries, footprints, visibility.first(queries.size())); });
    if (!answered) std::fill(visibility.begin(), visibility.end(), none);
}

void ExternalMap::touched(const Query& query, std::vector<const void*>& lines) const {
    attempt([&] { map_->touched(query, nullptr, lines); });
}

void ExternalMap::touched_shaped(const Query& query, const Footprint& footprint,
                                 std::vector<const void*>& lines) const {
    attempt([&] { map_->touched(query, &footprint, lines); });
}

void ExternalMap::stored(int x, int y, int, std::span<const float> depths, curves::Curve& out) const {
    out.clear();
    const bool read = attempt([&] {
        map_->stored(x, y, depths, out);
        check_vertices(x, y, out);
    });
    if (!read) out.clear();
}

BrokenMap::BrokenMap(std::string file, std::string reason) : file_(std::move(file)), reason_(std::move(reason)) {}

void BrokenMap::begin(const BuildInput&) {
    throw Error(ErrorCode::internal, file_, reason_);
}

void BrokenMap::lookup(std::span<const Query>, std::span<float> visibility) const {
    std::fill(visibility.begin(), visibility.end(), std::numeric_limits<float>::quiet_NaN());
}

}  // namespace shadowbench::techniques
