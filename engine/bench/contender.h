// One technique with its parameters and its state during a run: built, checked, timed.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "bench/maps.h"
#include "bench/ray_source.h"
#include "bench/reference.h"
#include "metrics/expected_error.h"
#include "results/result.h"

namespace shadowbench::bench {

struct Contender {
    const techniques::Technique* row = nullptr;
    techniques::ParameterValues values;
    techniques::RayNeeds needs;
    techniques::Promises promises;  // for these values; known once built
    results::Cell cell;
    Maps maps;                                  // finished by build_all(); none if the cell failed
    metrics::ErrorsOverSeeds seed_errors = {};  // at the judged queries, with the further seeds of the rays

    bool ok() const { return cell.status == results::CellStatus::ok; }
};

// Makes a contender from the request of a scenario. The cell's label names the parameters that differ from their
// defaults. Throws what read_parameters() throws, with `where` as its place.
Contender make_contender(const scene::TechniqueRequest& request, const std::string& where);

// Labels the contenders of these requests so that each label tells which one it is. A label names the parameters that
// differ from their defaults, those that sweeps set (`swept`, one list a contender), and those that the request writes
// and in which contenders of the same technique differ.
void label(std::span<Contender> contenders, std::span<const scene::TechniqueRequest> requests,
           std::span<const std::vector<std::string>> swept);

// The same technique for another light, with nothing built.
Contender unbuilt(const Contender& contender);

// Sets in the layout of the capture everything that the contenders need together.
void ask_for_needs(std::span<const Contender> contenders, rays::MapLayout& layout);

// The aprons that contenders need, each once.
std::vector<int> aprons_of(std::span<const Contender> contenders);

// Marks the cell as failed for this reason and drops its maps. Only the first reason is kept.
void fail(Contender& contender, const std::string& reason);

// Throws Error{bad_input} at the place of the first technique that cannot serve this layout. Begins each map for it and
// drops it again, so it is for small maps.
void check_served(std::span<const Contender> contenders, const techniques::BuildInput& input);

// Builds every map once, untimed, tiles in parallel, and fills in bytes and nodes. A technique that throws Error fails
// only its own cell; but an Error{bad_input} when it begins is rethrown, as by check_served(). A map that grows beyond
// `memory_limit` bytes fails too.
void build_all(std::span<Contender> contenders, const RaySource& source, const techniques::BuildInput& input,
               std::size_t memory_limit, const RaySource::Watch& watch);

// Compares every stored function with that of the light rays, and checks the promises of the technique.
void check_functions(std::span<Contender> contenders, const RaySource& source, const rays::MapLayout& layout,
                     const RaySource::Watch& watch);

// Fails the contender if its maps have a fault, or if an answer is not finite or, where that is promised, not in [0,
// 1]. Answers are stored channel after channel.
void check_answers(Contender& contender, const Asked& asked, std::span<const float> answers);

// Looks up the judged queries and fails the contender as check_answers() does. Otherwise returns answer minus truth,
// channel after channel.
std::vector<double> errors_of(Contender& contender, const Asked& judged, const Truth& truth);

// Compares the answers to the judged queries with the truth, and finds the interval of the RMS from these errors and
// those over seeds, which must be known before.
void check_lookups(std::span<Contender> contenders, const Asked& judged, const Truth& truth);

// For a light that sees no caster: fails every contender with an answer other than 1. To be called after
// check_lookups().
void check_lit(std::span<Contender> contenders);

}  // namespace shadowbench::bench
