// The variants of a document, one after the other, each with what its lights share.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/contender.h"
#include "bench/load.h"
#include "bench/queries.h"
#include "bench/run.h"
#include "document/document.h"
#include "rays/tracer.h"
#include "results/result.h"

namespace shadowbench::bench {

// Expands the document and keeps only the techniques of `only`, or all if it is empty. Throws Error: bad_input, or
// usage for `only`.
std::vector<document::Variant> variants_of(const nlohmann::json& document, const std::vector<std::string>& only);

// Adds the lines that are not there yet: variants may share a scene.
void add_missing(std::vector<std::string> lines, std::vector<std::string>& to);

// The same for the notes of the file readers.
void add_notes(const scene::Scenario& scenario, std::vector<std::string>& notes);

// The same for the lines of its data files.
void add_files(const document::Variant& variant, const scene::Scene& scene, std::vector<std::string>& files);

// Tells a progress of the objects that are loaded.
scene::LoadWatch load_watch(const std::string& place, const ProgressCallback& progress);

class VariantRuns {
public:
    // Throws what variants_of() throws.
    VariantRuns(const nlohmann::json& document, const RunOptions& options);

    // The result of a run of this document, without variants and notes.
    results::Result describe() const;
    const std::vector<document::Variant>& variants() const { return variants_; }

    // Loads a variant in place of the one before. The reference stays valid until the next call. Throws Error:
    // bad_input, no_such_file or io.
    const scene::Scenario& load(std::size_t variant, const ProgressCallback& progress);

    // Captures, checks and times one light of the variant that was loaded last. Throws what run_light() throws.
    results::LightResult measure(std::size_t light, const ProgressCallback& progress) const;

    // What only lookups in receiver pixels show: how many reach over the borders of a point light's maps. A line for
    // each such light, with the values of the sweeps that change lookups. Throws what measure() throws if a map has no
    // receiver.
    std::vector<std::string> seam_notes() const;

private:
    std::shared_ptr<const nlohmann::json> document_;
    RunOptions options_;
    std::vector<document::Variant> variants_;
    ScenarioLoader loader_;
    std::size_t loaded_ = 0;
    const scene::Scenario* scenario_ = nullptr;
    std::vector<Contender> contenders_;      // nothing is built
    std::unique_ptr<rays::Tracer> casters_;  // null for a deep image
    std::vector<CameraPoint> seen_;          // by the camera; none without one
};

}  // namespace shadowbench::bench
