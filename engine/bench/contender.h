// One technique with its parameters on its way through a run: built, checked, timed.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "bench/maps.h"
#include "bench/ray_source.h"
#include "bench/reference.h"
#include "results/result.h"

namespace shadowbench::bench {

struct Contender {
    const techniques::Technique* row = nullptr;
    techniques::ParameterValues values;
    techniques::RayNeeds needs;
    techniques::Promises promises;  // of these values; known once built
    results::Cell cell;
    Maps maps;  // finished once warmed up; none when the cell failed

    bool ok() const { return cell.status == results::CellStatus::ok; }
};

// From the request of a scenario; the cell's label names the `swept` parameters, whatever their values. Throws what
// read_parameters throws, with `where` as its place.
Contender make_contender(const scene::TechniqueRequest& request, const std::string& where,
                         std::span<const std::string> swept = {});

// The same technique before anything was built for it: for another light.
Contender unbuilt(const Contender& contender);

// Makes the layout of the capture ask for what all of them need together.
void ask_for_needs(std::span<const Contender> contenders, rays::MapLayout& layout);

// The aprons that contenders ask for, each once.
std::vector<int> aprons_of(std::span<const Contender> contenders);

// The cell failed for this reason; its maps are given back. Only the first reason stays.
void fail(Contender& contender, const std::string& reason);

// Throws Error{bad_input} at the place of the first technique that cannot serve this layout. Begins each map for it and
// drops it again: for small maps.
void check_served(std::span<const Contender> contenders, const techniques::BuildInput& input);

// Builds every map once, untimed, tiles in parallel; a technique that throws Error fails its own cell alone, but for
// Error{bad_input} when it begins, which is thrown on as check_served does. A map that grows beyond `memory_limit`
// bytes fails too. Fills in bytes and nodes.
void build_all(std::span<Contender> contenders, const RaySource& source, const techniques::BuildInput& input,
               std::size_t memory_limit, const RaySource::Watch& watch);

// Compares every stored function with the light rays' own and holds the technique to its promises.
void check_functions(std::span<Contender> contenders, const RaySource& source, const rays::MapLayout& layout,
                     const RaySource::Watch& watch);

// Fails for an answer that is not finite, or not in [0, 1] where that is promised. Answers stand channel after channel.
void check_answers(Contender& contender, const Asked& asked, std::span<const float> answers);

// Compares the answers to the judged queries with the truth, after check_answers.
void check_lookups(std::span<Contender> contenders, const Asked& judged, const Truth& truth);

// After check_lookups, for a light that sees nothing that casts a shadow: an answer other than 1 fails.
void check_lit(std::span<Contender> contenders);

}  // namespace shadowbench::bench
