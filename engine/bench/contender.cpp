#include "bench/contender.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/parallel.h"
#include "bench/curve_check.h"
#include "bench/shared_tile.h"

namespace shadowbench::bench {
namespace {

using techniques::Query;

constexpr std::size_t max_checked_cells = std::size_t{1} << 20;  // of one map: more take long and add little
constexpr float rounding = 1e-6f;  // by which an answer may leave [0, 1], or differ from 1

// A layout that a technique cannot serve is bad input, not a fault of the technique: the error names its place.
Maps begin_served(const Contender& contender, const techniques::BuildInput& input) {
    try {
        return begin_maps(*contender.row, contender.values, input);
    } catch (const base::Error& error) {
        if (error.code() != base::ErrorCode::bad_input) throw;
        throw base::Error(base::ErrorCode::bad_input, contender.cell.where, error.message());
    }
}

void begin_all(std::span<Contender> contenders, const techniques::BuildInput& input) {
    for (Contender& contender : contenders) {
        if (!contender.ok()) continue;
        try {
            contender.maps = begin_served(contender, input);
        } catch (const base::Error& error) {
            if (error.code() == base::ErrorCode::bad_input) throw;
            fail(contender, error.message());
        }
    }
}

// Adds a batch to every map that needs this apron. If several tiles fail, the reason of the first one is kept.
void add_batch(std::span<Contender> contenders, int apron, RaySource::Batch batch) {
    std::vector<Contender*> added;
    for (Contender& contender : contenders)
        if (contender.ok() && contender.needs.apron == apron) added.push_back(&contender);
    std::vector<std::vector<std::optional<std::string>>> faults(batch.size());  // of each tile, by contender
    base::parallel_for(batch.size(), [&](std::size_t i) {
        SharedTile tile(batch[i]);
        faults[i].resize(added.size());
        for (std::size_t a = 0; a < added.size(); ++a) {
            try {
                add(added[a]->maps, tile);
            } catch (const base::Error& error) {
                faults[i][a] = error.message();
            }
        }
    });
    for (const auto& of_tile : faults)
        for (std::size_t a = 0; a < added.size(); ++a)
            if (of_tile[a]) fail(*added[a], *of_tile[a]);
}

void refuse_too_large(std::span<Contender> contenders, std::size_t memory_limit) {
    for (Contender& contender : contenders)
        if (contender.ok() && std::max(bytes(contender.maps), working_bytes(contender.maps)) > memory_limit)
            fail(contender, "the map grew beyond the memory limit");
}

void finish_all(std::span<Contender> contenders, std::size_t memory_limit) {
    for (Contender& contender : contenders) {
        if (!contender.ok()) continue;
        try {
            finish(contender.maps);
        } catch (const base::Error& error) {
            fail(contender, error.message());
            continue;
        }
        contender.cell.bytes = bytes(contender.maps);
        contender.cell.working_bytes = working_bytes(contender.maps);
        const techniques::NodeStats counted = nodes(contender.maps);
        contender.cell.nodes = {counted.cells, counted.total, counted.max, counted.histogram};
    }
    refuse_too_large(contenders, memory_limit);
}

// Of the expected RMS, over the seeds and this one.
void find_interval(Contender& contender, std::span<const double> errors, const Truth& truth) {
    results::LookupErrors& result = *contender.cell.lookup;
    metrics::ErrorsOverSeeds all = contender.seed_errors;
    all.add(errors);
    std::vector<double> squares{result.norms.rms * result.norms.rms};
    for (const results::SeedErrors& seed : contender.cell.over_seeds)
        squares.push_back(seed.lookup.rms * seed.lookup.rms);
    const metrics::TruthNoise noise = all.truth_noise(truth.standard_error, truth.degrees == 0);
    const metrics::Interval interval = metrics::expected_rms(squares, noise);
    const bool random_rays = contender.maps.layout->jittered;
    result.interval = {interval.low, interval.high, all.seeds() > 1 || !random_rays};
    result.truth_sd = std::sqrt(noise.linear);
}

void judge(Contender& contender, const Asked& judged, const Truth& truth) {
    const std::vector<double> errors = errors_of(contender, judged, truth);
    if (!contender.ok()) return;
    results::LookupErrors& result = contender.cell.lookup.emplace();
    result.norms = metrics::error_norms(errors);
    for (const double error : errors) result.signed_mean += error;
    if (!errors.empty()) result.signed_mean /= static_cast<double>(errors.size());
    find_interval(contender, errors, truth);
}

}  // namespace

Contender make_contender(const scene::TechniqueRequest& request, const std::string& where) {
    Contender contender;
    contender.row = &techniques::find(request.type, where + "/type");
    contender.values =
        techniques::read_parameters(contender.row->parameters, nlohmann::json::parse(request.parameters), where);
    contender.needs = contender.row->create(contender.values)->needs();
    results::Cell& cell = contender.cell;
    cell.technique = contender.row->id;
    cell.version = contender.row->version;
    if (const techniques::Library& library = contender.row->library; !library.file.empty())
        cell.library = {library.file, library.hash, library.isolated};
    cell.parameters = techniques::to_string(contender.values, contender.row->parameters, false);
    cell.parameters_json = techniques::to_json(contender.values).dump();
    cell.defaults = cell.parameters.empty();
    cell.where = where;
    return contender;
}

void label(std::span<Contender> contenders, std::span<const scene::TechniqueRequest> requests,
           std::span<const std::vector<std::string>> swept) {
    const auto differs = [&](const Contender& contender, const std::string& name) {
        return std::any_of(contenders.begin(), contenders.end(), [&](const Contender& other) {
            return other.row == contender.row && other.values.at(name) != contender.values.at(name);
        });
    };
    for (std::size_t i = 0; i < contenders.size(); ++i) {
        techniques::Named named{swept[i], {}};
        const nlohmann::json written = nlohmann::json::parse(requests[i].parameters);
        for (const auto& [name, value] : written.items())
            if (differs(contenders[i], name)) named.in_place.push_back(name);
        contenders[i].cell.parameters =
            techniques::to_string(contenders[i].values, contenders[i].row->parameters, named);
    }
}

Contender unbuilt(const Contender& contender) {
    return {contender.row, contender.values, contender.needs, {}, contender.cell, {}, {}};
}

void ask_for_needs(std::span<const Contender> contenders, rays::MapLayout& layout) {
    for (const Contender& contender : contenders) {
        layout.apron = std::max(layout.apron, contender.needs.apron);
        layout.submission = layout.submission || contender.needs.submission;
    }
}

std::vector<int> aprons_of(std::span<const Contender> contenders) {
    std::set<int> aprons;
    for (const Contender& contender : contenders) aprons.insert(contender.needs.apron);
    return {aprons.begin(), aprons.end()};
}

void fail(Contender& contender, const std::string& reason) {
    if (!contender.ok()) return;
    contender.cell.status = results::CellStatus::failed;
    contender.cell.reason = reason;
    contender.maps = {};
}

void check_served(std::span<const Contender> contenders, const techniques::BuildInput& input) {
    for (const Contender& contender : contenders) {
        try {
            begin_served(contender, input);
        } catch (const base::Error& error) {
            if (error.code() == base::ErrorCode::bad_input) throw;
        }
    }
}

void build_all(std::span<Contender> contenders, const RaySource& source, const techniques::BuildInput& input,
               std::size_t memory_limit, const RaySource::Watch& watch) {
    for (Contender& contender : contenders) {
        contender.cell.error_bound = contender.row->error_bound(contender.values, input.layout);
        contender.promises = techniques::promises(*contender.row, contender.values);
        contender.cell.outside_promise = contender.promises.opaque_only && source.translucent();
    }
    begin_all(contenders, input);
    const std::vector<int> aprons = aprons_of(contenders);
    std::size_t tiles = 0;
    for (const int apron : aprons)
        source.for_each_batch(apron, [&](RaySource::Batch batch) {
            add_batch(contenders, apron, batch);
            refuse_too_large(contenders, memory_limit);
            tiles += batch.size();
            if (watch) watch(tiles / aprons.size());
        });
    finish_all(contenders, memory_limit);
}

void check_functions(std::span<Contender> contenders, const RaySource& source, const rays::MapLayout& layout,
                     const RaySource::Watch& watch) {
    std::vector<CheckedMap> checked;
    std::vector<Contender*> owners;
    for (Contender& contender : contenders) {
        if (!contender.ok()) continue;
        checked.push_back({&contender.maps, contender.promises, contender.cell.error_bound,
                           !contender.cell.outside_promise, contender.needs.apron, true});
        owners.push_back(&contender);
    }
    const std::vector<CurveVerdict> verdicts = check_curves(source, layout, checked, max_checked_cells, watch);
    for (std::size_t i = 0; i < owners.size(); ++i) {
        results::Cell& cell = owners[i]->cell;
        cell.curve = verdicts[i].errors;
        cell.nodes.over_fewest = over_fewest(verdicts[i].nodes, cell.nodes.cells);
        if (!verdicts[i].broken.empty()) fail(*owners[i], verdicts[i].broken);
    }
}

void check_answers(Contender& contender, const Asked& asked, std::span<const float> answers) {
    if (const std::string fault = bench::fault(contender.maps); !fault.empty()) return fail(contender, fault);
    const bool bounded = contender.promises.unit_range;
    for (std::size_t i = 0; i < answers.size(); ++i) {
        const float v = answers[i];
        if (bounded ? v >= -rounding && v <= 1.0f + rounding : std::isfinite(v)) continue;
        const Query& q = asked.queries[i % asked.queries.size()];
        return fail(contender, fmt::format("the lookup at ({}, {}, {}) answers {}, which is not {}", q.x, q.y, q.z, v,
                                           bounded ? "in [0, 1]" : "finite"));
    }
}

std::vector<double> errors_of(Contender& contender, const Asked& judged, const Truth& truth) {
    if (!contender.ok()) return {};
    const std::vector<float> visibility = lookup_all(contender.maps, judged);
    check_answers(contender, judged, visibility);
    if (!contender.ok()) return {};
    std::vector<double> errors(visibility.size());
    for (std::size_t i = 0; i < visibility.size(); ++i) errors[i] = visibility[i] - truth.value[i];
    return errors;
}

void check_lookups(std::span<Contender> contenders, const Asked& judged, const Truth& truth) {
    for (Contender& contender : contenders)
        if (contender.ok()) judge(contender, judged, truth);
}

void check_lit(std::span<Contender> contenders) {
    for (Contender& contender : contenders)
        if (contender.ok() && !(contender.cell.lookup->norms.max <= rounding))
            fail(contender,
                 fmt::format("the light sees nothing that casts a shadow, but an answer differs from 1 by {:.6g}",
                             contender.cell.lookup->norms.max));
}

}  // namespace shadowbench::bench
