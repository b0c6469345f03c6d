// The papers whose claims are measured, one row for each.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/progress.h"
#include "claims/claim.h"
#include "results/result.h"
#include "scene/scenario.h"

namespace shadowbench::claims {

// Whether a run times builds and lookups. Claims whose ratios need narrow intervals time them in turn: see turns.h.
enum class Times { skipped, taken };

// The input of a paper's measurements.
struct Context {
    std::filesystem::path scenarios;  // folder of the papers' scenarios
    scene::SearchPath data;
    bool quick = false;  // smaller sizes, for a first look
    int threads = 0;     // 0: all processors
    bench::ProgressCallback progress;
    PaperReport* report = nullptr;  // receives the results, and the scenarios that run

    // The scenario of this name in the folder, with these changes ("path=value"). Throws Error{no_such_file}.
    nlohmann::json document(const std::string& name, const std::vector<std::string>& set = {}) const;

    // Runs that document, and also with `smaller` if quick. Cells have no times if they are skipped.
    results::Result run(const std::string& name, const std::vector<std::string>& set,
                        const std::vector<std::string>& smaller, Times times = Times::skipped) const;
};

// Notes in the report, once, that this scenario was measured.
void note_document(const Context& context, const std::string& name, const nlohmann::json& document);

// The light of the only variant whose settings begin with these values ("pointer=value"), or the first if there are
// several. Throws Error{internal} if there is none.
const results::LightResult& light_of(const results::Result& result, const std::vector<std::string>& settings = {});

// The cell of a technique whose parameters have these values ("nodes=8"). Throws Error{internal} if there is none, or
// if it failed, with its reason.
const results::Cell& cell_of(const results::LightResult& light, const std::string& technique,
                             const std::vector<std::string>& parameters = {});

// The ratio of two cells' times of lookups in image order, or of builds, in one run whose times were taken: its
// repetitions pass over all cells.
Value time_ratio(const results::Cell& one, const results::Cell& other);
Value build_ratio(const results::Cell& one, const results::Cell& other);

struct Paper {
    const char* id;  // "lokovic2000"
    const char* title;
    // Fills claims, tables, plots and conditions of context.report.
    void (*measure)(const Context& context);
};

std::span<const Paper> all_papers();

// The report of one paper. Throws what running its scenarios throws.
PaperReport measure(const Paper& paper, Context context);

void measure_reeves(const Context& context);
void measure_lokovic(const Context& context);
void measure_pagot(const Context& context);
void measure_volume(const Context& context);
void measure_salvi(const Context& context);

}  // namespace shadowbench::claims
