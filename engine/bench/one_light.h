// One light of one scenario, for commands that need what a run drops: its light rays, or the map of one technique.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/contender.h"
#include "bench/functions.h"
#include "bench/load.h"
#include "bench/prepared_light.h"
#include "bench/progress.h"
#include "bench/ray_source.h"
#include "bench/run.h"
#include "document/document.h"
#include "document/technique_choice.h"
#include "rays/tracer.h"

namespace shadowbench::bench {

std::vector<std::string> names_of(const std::vector<scene::Light>& lights);

// The index of a light given by its name or by its number, from 0 on; empty: the first. Throws Error{usage}, place:
// `prefix` and the name, as in "--light moon".
std::size_t find_light(const std::vector<std::string>& names, const std::string& name, const std::string& prefix);

// The scenario of a document without choices. Throws Error{usage} for sweeps that leave a choice of scenarios.
document::Variant only_variant(const nlohmann::json& document);

class OneLight {
public:
    // `light` is a name or a number from 0 on; empty: the first. Throws what run() throws for a document, and
    // Error{usage} for a light that does not exist and for sweeps that leave a choice of scenarios.
    OneLight(const nlohmann::json& document, const RunOptions& options, const std::string& light);
    OneLight(const OneLight&) = delete;
    OneLight& operator=(const OneLight&) = delete;

    const scene::Scenario& scenario() const { return *scenario_; }
    const scene::Light& light() const { return *light_; }
    const rays::MapLayout& layout() const { return prepared_.layout; }

    // Calls body with all light rays, some tiles at a time, in order. Throws Error{bad_input} for a light that sees no
    // caster, or that needs more than the memory limit.
    void for_each_batch(const std::function<void(RaySource::Batch)>& body, const ProgressCallback& progress) const;

    // The finished map. Throws the same, Error{bad_input} if the technique cannot serve the light, and Error{internal}
    // if it fails.
    Contender build(const document::TechniqueChoice& technique, const ProgressCallback& progress) const;

private:
    using Visit = std::function<void(const RaySource& source, const PreparedLight& light)>;
    void capture(std::span<Contender> contenders, const Visit& visit) const;

    RunOptions options_;
    ScenarioLoader loader_;
    const scene::Scenario* scenario_ = nullptr;
    const scene::Light* light_ = nullptr;
    std::size_t index_ = 0;                  // of the light
    PreparedLight prepared_;                 // prepared for no technique
    std::unique_ptr<rays::Tracer> casters_;  // null for a deep image
};

}  // namespace shadowbench::bench
