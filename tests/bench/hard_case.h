// A committed scenario of scenarios/hard with its maps built, to be asked where a closed form knows the answer.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/contender.h"
#include "bench/load.h"
#include "bench/reference.h"
#include "rays/capture.h"
#include "rays/tracer.h"

namespace shadowbench::bench {

class HardCase {
public:
    // `assignments` as in --set: what cuts a scenario down. Sweeps are taken at their first values.
    explicit HardCase(const std::string& name, const std::vector<std::string>& assignments = {}, std::size_t light = 0);
    HardCase(const HardCase&) = delete;
    HardCase& operator=(const HardCase&) = delete;

    const rays::LightView& view() const { return view_; }
    const rays::MapLayout& layout() const { return layout_; }
    const RaySource& source() const { return *source_; }
    std::span<const Contender> contenders() const { return contenders_; }

    // The query at a place in the world, or at a place in the map.
    techniques::Query at(const base::Vec3d& world, float width = 1.0f) const;

    using Queries = std::vector<techniques::Query>;
    using Answers = std::vector<long double>;  // to all queries in channel 0, then to all in channel 1, ...

    // Holds every technique that bounds its error for these rays, and shadow rays, to a closed form. `slack` is allowed
    // beyond each bound: what floats at these depths cannot tell. Techniques that bound nothing have to answer with
    // numbers, and where they promise it in [0, 1].
    void expect_of_techniques(const Queries& queries, const Answers& expected, double slack = 2e-6) const;
    // The same of the truth that lookups are judged against.
    void expect_of_truth(const Queries& queries, const Answers& expected, double slack = 2e-6) const;
    void expect(const Queries& queries, const Answers& expected, double slack = 2e-6) const;  // both

private:
    ScenarioLoader loader_;
    const scene::Scenario* scenario_ = nullptr;
    rays::LightView view_;
    rays::MapLayout layout_;
    std::unique_ptr<rays::Tracer> casters_;
    std::unique_ptr<rays::Capture> capture_;
    std::unique_ptr<RaySource> source_;
    std::vector<Contender> contenders_;
};

}  // namespace shadowbench::bench
