#include "results/report_verdicts.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "base/markdown.h"
#include "base/table.h"

namespace shadowbench::results {
namespace {

constexpr const char* rule =
    "**Failed**: the technique broke a promise. **Kept**: every promise holds, and the technique either promises a "
    "bound on its curve error in this case or its error is within the noise tolerance of the light rays, 0.5/sqrt(N) "
    "for N rays a pixel. **Degraded**: every promise holds, but none bounds the error in this case, and the error is "
    "above the noise tolerance.\n\n"
    "The error that decides is the largest curve error (*curve max*: the stored function against the uncompressed "
    "function of the same rays). A technique that stores no function is judged by its lookup error against the truth, "
    "as RMS. A technique for opaque scenes promises no bound where light passes through surfaces or media. A technique "
    "that is exact only before and behind all casters is held to that, and promises nothing in between.\n\n"
    "A verdict compares stored functions with their own rays; *kept* does not say that pictures are right. In the "
    "summary, \\* marks a scenario where some lookup error against the truth (RMS) is above the noise tolerance, "
    "whether from sampling, bias or the filter. Beyond its promise a curve may err by 1e-6 for rounding and, where "
    "media are approximated by lines, by a sixteenth of the promise.\n\n";

char letter(Verdict verdict) {
    return verdict == Verdict::kept ? 'K' : verdict == Verdict::degraded ? 'D' : 'F';
}

template <class Visit>
void for_each_cell(const Result& result, const Visit& visit) {
    for (const VariantResult& variant : result.variants)
        for (const LightResult& light : variant.lights)
            for (const Cell& cell : light.cells) visit(variant, light, cell);
}

struct Worst {
    Verdict verdict = Verdict::kept;
    bool noisy_lookups = false;  // their error is above the noise tolerance
};

// The worst verdict of each technique with default parameters, over the variants and lights of a scenario.
std::map<std::string, Worst> worst_of_defaults(const Result& result) {
    std::map<std::string, Worst> worst;
    for_each_cell(result, [&](const VariantResult&, const LightResult& light, const Cell& cell) {
        if (!cell.defaults) return;
        Worst& entry = worst[cell.technique];
        entry.verdict = std::max(entry.verdict, cell.verdict);
        entry.noisy_lookups =
            entry.noisy_lookups || (cell.lookup && !(cell.lookup->norms.rms <= light.reference.noise_tolerance));
    });
    return worst;
}

struct Matrix {
    std::vector<std::string> header{"scenario"};
    std::vector<std::vector<std::string>> rows;
};

Matrix matrix_of(std::span<const ScenarioOutcome> outcomes, std::span<const std::string> techniques) {
    std::vector<std::map<std::string, Worst>> worst;
    for (const ScenarioOutcome& outcome : outcomes) worst.push_back(worst_of_defaults(outcome.result));
    Matrix matrix;
    for (const std::string& id : techniques)
        if (std::any_of(worst.begin(), worst.end(), [&](const auto& entry) { return entry.contains(id); }))
            matrix.header.push_back(id);
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        std::vector<std::string> line{outcomes[i].result.name};
        for (std::size_t c = 1; c < matrix.header.size(); ++c) {
            const auto found = worst[i].find(matrix.header[c]);
            line.push_back(!outcomes[i].error.empty() ? "not run"
                           : found == worst[i].end()
                               ? "-"
                               : letter(found->second.verdict) + std::string(found->second.noisy_lookups ? "*" : ""));
        }
        matrix.rows.push_back(std::move(line));
    }
    return matrix;
}

std::string counts(std::span<const ScenarioOutcome> outcomes) {
    std::size_t count[3] = {0, 0, 0}, not_run = 0;
    for (const ScenarioOutcome& outcome : outcomes) {
        not_run += !outcome.error.empty();
        for_each_cell(outcome.result, [&](const VariantResult&, const LightResult&, const Cell& cell) {
            ++count[static_cast<int>(cell.verdict)];
        });
    }
    std::string text = fmt::format("{} scenario{}: {} verdicts kept, {} degraded, {} failed", outcomes.size(),
                                   outcomes.size() == 1 ? "" : "s", count[0], count[1], count[2]);
    if (not_run > 0) text += fmt::format("; {} could not be run", not_run);
    return text + ".\n";
}

// "rays.seed = 1, light key"; empty if there is one variant of one light.
std::string place_of(const Result& result, const VariantResult& variant, const LightResult& light) {
    std::string text;
    for (const document::Setting& setting : variant.settings)
        text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", setting.pointer, setting.value);
    const bool lights = std::any_of(result.variants.begin(), result.variants.end(),
                                    [](const VariantResult& entry) { return entry.lights.size() > 1; });
    if (lights) text += fmt::format("{}light {}", text.empty() ? "" : ", ", light.name);
    return text;
}

std::string figure(double value) {
    return std::isfinite(value) ? fmt::format("{:.3g}", value) : "-";
}

std::vector<std::string> verdict_row(const Cell& cell) {
    const std::string word = to_string(cell.verdict);
    return {title(cell),
            cell.verdict == Verdict::failed ? "**" + word + "**" : word,
            cell.curve ? figure(cell.curve->norms.max) : "-",
            cell.lookup ? figure(cell.lookup->norms.rms) : "-",
            cell.lookup ? figure(cell.lookup->norms.max) : "-",
            fmt::format("{}", cell.bytes),
            fmt::format("{:.1f}", cell.nodes.mean()),
            fmt::format("{}", cell.nodes.max),
            cell.verdict_why};
}

std::string light_section(const Result& result, const VariantResult& variant, const LightResult& light) {
    const std::string place = place_of(result, variant, light);
    std::string text = place.empty() ? "" : place + "\n\n";
    text += fmt::format("Map {} x {}, {} ray{} a pixel, {} segments; noise tolerance {:.3g}.{}{}\n\n",
                        light.layout.width, light.layout.height, light.layout.samples(),
                        light.layout.samples() == 1 ? "" : "s", light.segments, light.reference.noise_tolerance,
                        sees_nothing(light) ? " The light sees nothing that casts a shadow: everything is lit." : "",
                        light.dropped == 0 ? ""
                                           : fmt::format(" {} of {} receivers are outside the map.", light.dropped,
                                                         light.dropped + light.receivers));
    std::vector<std::vector<std::string>> rows;
    for (const Cell& cell : light.cells) rows.push_back(verdict_row(cell));
    return text + base::markdown_table({"technique", "verdict", "curve max", "lookup rms", "lookup max", "bytes",
                                        "nodes mean", "nodes max", "why"},
                                       rows);
}

}  // namespace

std::string verdicts_markdown(std::span<const ScenarioOutcome> outcomes, std::span<const std::string> techniques) {
    std::string text = "# Verdicts\n\n" + std::string(rule) + counts(outcomes) + "\n";
    const Matrix matrix = matrix_of(outcomes, techniques);
    text +=
        "## Techniques with default parameters\n\nK kept, D degraded, F failed, - not in the scenario, \\* lookup "
        "error above the noise tolerance. Each entry is the worst over the scenario's variants and lights.\n\n";
    text += base::markdown_table(matrix.header, matrix.rows);
    for (const ScenarioOutcome& outcome : outcomes) {
        const Result& result = outcome.result;
        text += fmt::format("## {}\n\n", result.name);
        if (!result.purpose.empty()) text += result.purpose + "\n\n";
        if (!outcome.error.empty()) text += "Could not be run: " + outcome.error + "\n\n";
        for (const std::string& note : result.notes) text += "- note: " + base::markdown_escaped(note) + "\n";
        if (!result.notes.empty()) text += "\n";
        for (const VariantResult& variant : result.variants)
            for (const LightResult& light : variant.lights) text += light_section(result, variant, light);
    }
    text.pop_back();  // the file ends with one line break
    return text;
}

std::string verdicts_text(std::span<const ScenarioOutcome> outcomes, std::span<const std::string> techniques) {
    const Matrix matrix = matrix_of(outcomes, techniques);
    base::Table table(matrix.header);
    for (const auto& row : matrix.rows) table.add(row);
    std::string text =
        "verdicts (K kept, D degraded, F failed, * lookup error above the noise tolerance; default "
        "parameters)\n" +
        table.text("  ");
    for (const ScenarioOutcome& outcome : outcomes) {
        const std::string& name = outcome.result.name;
        for_each_cell(outcome.result, [&](const VariantResult& variant, const LightResult& light, const Cell& cell) {
            if (cell.verdict != Verdict::failed) return;
            const std::string place = place_of(outcome.result, variant, light);
            text += fmt::format("failed: {}{}, {}: {}\n", name, place.empty() ? "" : " (" + place + ")", title(cell),
                                cell.verdict_why);
        });
        if (!outcome.error.empty()) text += fmt::format("could not be run: {}: {}\n", name, outcome.error);
    }
    return text + counts(outcomes);
}

}  // namespace shadowbench::results
