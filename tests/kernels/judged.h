// The map of a technique, built and checked against the technique's promises as in a run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/maps.h"
#include "kernels/kernel.h"
#include "rays/light_rays.h"
#include "techniques/technique.h"

namespace shadowbench::kernels {

// A row with default parameters except one, on a map of the mixed scene.
struct Setting {
    const techniques::Technique* row;
    std::string parameter;  // empty: none
    std::optional<double> value;
    int map, samples;  // pixels a side; rays a pixel
};
std::string name_of(const Setting& setting);  // "deep/tolerance:0.02/map:64/samples:16"

class Judged {
public:
    // Throws std::runtime_error that names the broken promise.
    explicit Judged(const Setting& setting);
    ~Judged();

    const Exact& exact() const;
    const bench::Maps& maps() const;
    const std::vector<rays::LightRays>& tiles() const;  // from which the map is built

    bench::Maps build() const;

    // side * side places over the whole map, row after row, at different depths; each seed gives other places.
    std::vector<techniques::Query> queries(std::size_t side, std::uint64_t seed) const;

    // Makes the pass twice. Throws unless both give the same answers, and these keep the promises.
    void check_answers(const std::vector<techniques::Query>& queries, const std::function<void()>& pass,
                       const std::vector<float>& answers) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};
using SharedJudged = std::shared_ptr<const Judged>;

// Kernels of one setting follow one another, so the last one is kept.
SharedJudged judge(const Setting& setting);

}  // namespace shadowbench::kernels
