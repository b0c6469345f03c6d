// A committed scenario of scenarios/hard with its maps built, to be compared with closed forms.
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
    // `assignments` reduce the scenario, as --set does. Sweeps take their first values.
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

    // Compares every technique that bounds its error for these rays, and shadow rays, with a closed form. `slack`, the
    // resolution of floats at these depths, is allowed beyond each bound. Techniques without a bound must answer with
    // numbers, in [0, 1] if they promise it.
    void expect_of_techniques(const Queries& queries, const Answers& expected, double slack = 2e-6) const;
    // The same for the truth that lookups are judged against.
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
