// Loads the scenarios of variants, one after the other.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "bench/contender.h"
#include "document/document.h"
#include "scene/scenario.h"

namespace shadowbench::bench {

// Loads the scenarios of variants in turn. Variants that differ in neither scene nor lights share the scene that was
// loaded first.
class ScenarioLoader {
public:
    explicit ScenarioLoader(scene::SearchPath data);

    // The reference stays valid until the next call. A scene that is shared is not watched.
    const scene::Scenario& load(const document::Variant& variant, const scene::LoadWatch& watch = {});

    // Of the files that the last load() read; 0 if it shared a scene.
    std::uint64_t file_bytes() const { return file_bytes_; }

private:
    scene::SearchPath data_;
    scene::Scenario scenario_;
    std::uint64_t file_bytes_ = 0;
    std::shared_ptr<const nlohmann::json> loaded_;
};

// The techniques of a variant's scenario. Errors name their places in the original document.
std::vector<Contender> make_contenders(const scene::Scenario& scenario, const document::Variant& variant);

}  // namespace shadowbench::bench
