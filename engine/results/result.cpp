#include "results/result.h"

#include <algorithm>
#include <utility>

namespace shadowbench::results {

Sample summarise(std::vector<double> raw) {
    Sample sample;
    if (raw.empty()) return sample;
    sample.raw = std::move(raw);
    sample.median = metrics::median(sample.raw);
    sample.interval = metrics::order_interval(sample.raw);
    return sample;
}

const char* to_string(Verdict verdict) {
    return verdict == Verdict::kept ? "kept" : verdict == Verdict::degraded ? "degraded" : "failed";
}

std::string title(const std::string& technique, const std::string& parameters) {
    return parameters.empty() ? technique : technique + " " + parameters;
}

std::string title(const Cell& cell) {
    return title(cell.technique, cell.parameters);
}

bool agrees(const Agreement& agreement) {
    const double allowed = std::max(3.0, 1e-3 * static_cast<double>(agreement.rays));
    return static_cast<double>(std::max(agreement.other_crossings, agreement.other_transmittance)) <= allowed;
}

double capture_seconds_on_one_thread(const LightResult& light) {
    return static_cast<double>(light.rays) / light.agreement->times.capture_rays_per_second;
}

bool sees_nothing(const LightResult& light) {
    return light.segments == 0;
}

bool any_failed(const Result& result) {
    for (const VariantResult& variant : result.variants)
        for (const LightResult& light : variant.lights)
            for (const Cell& cell : light.cells)
                if (cell.status == CellStatus::failed) return true;
    return false;
}

}  // namespace shadowbench::results
