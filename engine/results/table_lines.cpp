#include "results/table_lines.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/table.h"
#include "results/report.h"
#include "results/settled.h"

namespace shadowbench::results {
namespace {

using base::bytes_text;

std::string count(std::uint64_t n) {
    std::string digits = fmt::format("{}", n);
    for (int at = static_cast<int>(digits.size()) - 3; at > 0; at -= 3)
        digits.insert(static_cast<std::size_t>(at), ",");
    return digits;
}

std::string capture_lines(const LightResult& light, int threads) {
    std::string text = fmt::format(
        "  light {}: map {} x {}, {} ray{} a pixel ({}){}; {} rays, {} segments, {}{}\n", light.name,
        light.layout.width, light.layout.height, light.layout.samples(), light.layout.samples() == 1 ? "" : "s",
        light.deep_image        ? "deep image"
        : light.layout.jittered ? "jittered"
                                : "regular",
        light.layout.channels == 3 ? ", 3 channels" : "", count(light.rays), count(light.segments),
        bytes_text(light.ray_bytes), light.kept ? "" : ", captured again for each pass");
    text += fmt::format("    capture: {:.2f} s on {} thread{} after {:.2f} s of setup", light.times.seconds, threads,
                        threads == 1 ? "" : "s", light.times.setup_seconds);
    if (light.agreement) {
        const Agreement& a = *light.agreement;
        text += fmt::format(
            "; one thread {:.3g} M rays/s, {:.1f} x {}; of {} rays {} differ in crossings, {} in transmittance",
            a.times.capture_rays_per_second * 1e-6, a.times.ratio,
            light.layout.media ? "the same rays traced one by one" : "Embree's all-hits query", count(a.rays),
            a.other_crossings, a.other_transmittance);
    }
    return text + "\n";
}

// Empty if the light sees something.
std::string nothing_line(const LightResult& light) {
    if (!sees_nothing(light)) return "";
    return "    note: the light sees nothing that casts a shadow: its map is empty, and every answer must be 1\n";
}

// Empty if the capture and Embree agree.
std::string warning_line(const LightResult& light) {
    if (!light.agreement || agrees(*light.agreement)) return "";
    const Agreement& a = *light.agreement;
    return fmt::format(
        "    WARNING: the captured rays are not those that Embree traces: of {} compared, {} differ in crossings and "
        "{} in transmittance. Do not rely on this light's numbers.\n",
        count(a.rays), count(a.other_crossings), count(a.other_transmittance));
}

// The techniques from outside, a line each; empty if there are none.
std::string library_lines(const LightResult& light) {
    std::string text;
    for (const Cell& cell : light.cells) {
        if (!cell.library) continue;
        const std::string line = fmt::format(
            "    external: {} from {}, hash {}{}\n", cell.technique, cell.library->file, cell.library->hash,
            cell.library->isolated ? ", in processes of its own: its times hold the way there and back" : "");
        if (text.find(line) == std::string::npos) text += line;
    }
    return text;
}

// Empty if every stored function was compared.
std::string share_line(const LightResult& light) {
    std::string names;
    for (const Cell& cell : light.cells)
        if (cell.curve && cell.curve->cells < cell.nodes.cells)
            names += fmt::format("{}{} ({} of {})", names.empty() ? "" : ", ", title(cell), count(cell.curve->cells),
                                 count(cell.nodes.cells));
    return names.empty() ? "" : "    curve max covers a share of the cells: " + names + "\n";
}

// Empty if the machine was quiet, or nothing was timed.
std::string disturbed_line(const Settling& floors) {
    if (!floors.known() && floors.unjudged > 0)
        return fmt::format(
            "    Fewer than {} repetitions cannot show whether the machine was quiet: do not rank by these times or "
            "front T.\n",
            least_repetitions);
    const std::string why = disturbance_text(floors);
    if (why.empty()) return "";
    return "    UNSETTLED: " + why +
           ". The machine was busy or changed its speed: times, rankings by time and front T "
           "may be off by as much. Run it again on a quiet machine.\n";
}

std::string reference_line(const LightResult& light) {
    const ReferenceReport& r = light.reference;
    std::string text = fmt::format(
        "    truth: {} of {} receivers, {} ray{} a pixel, standard error rms {:.2g} max {:.2g}; noise tolerance "
        "0.5/sqrt(N) {:.2g}",
        count(r.judged), count(light.receivers), r.samples_per_pixel, r.samples_per_pixel == 1 ? "" : "s", r.error_rms,
        r.error_max, r.noise_tolerance);
    if (r.spread_rms) text += fmt::format("; spread over seeds rms {:.2g} max {:.2g}", *r.spread_rms, *r.spread_max);
    if (light.dropped > 0) text += fmt::format("; {} receivers are outside the map", count(light.dropped));
    return text + "\n";
}

}  // namespace

std::string time_text(double value) {
    const int decimals = value < 10 ? 2 : value < 1000 ? 1 : 0;
    return fmt::format("{:.{}f}", value, decimals);
}

std::string front_text(const Cell& cell) {
    const auto mark = [](char letter, metrics::OnFront on) {
        if (on == metrics::OnFront::no) return std::string();
        return std::string(1, letter) + (on == metrics::OnFront::perhaps ? "?" : "");
    };
    const std::string time = mark('T', cell.times ? cell.times->on_front : metrics::OnFront::no);
    const std::string bytes = mark('B', cell.on_bytes_front);
    return time + (time.empty() || bytes.empty() ? "" : " ") + bytes;
}

std::string interval_text(const LookupErrors& errors) {
    if (!errors.interval) return "-";
    return fmt::format("{:.3g}-{:.3g}{}", errors.interval->low, errors.interval->high,
                       errors.interval->covers_rays ? "" : "?");
}

std::string time_text(const Sample& sample, const LightResult& light) {
    return (is_settled(sample, light) == false ? "~" : "") + time_text(sample.median);
}

std::string heading_text(const Result& result) {
    return result.name + (result.purpose.empty() ? "" : ": " + result.purpose) + "\n" + notes_text(result.notes, "  ");
}

std::string settings_lines(const VariantResult& variant) {
    std::string text;
    for (const document::Setting& setting : variant.settings)
        text += fmt::format("{} = {}\n", setting.pointer, setting.value);
    return text;
}

std::string text_above(const LightResult& light, int threads) {
    return capture_lines(light, threads) + nothing_line(light) + warning_line(light) + reference_line(light);
}

std::string text_below(const LightResult& light, const Settling& found) {
    return library_lines(light) + share_line(light) + disturbed_line(found);
}

std::string notes_text(const std::vector<std::string>& notes, const std::string& indent) {
    constexpr std::size_t shown = 5;
    std::string text;
    for (std::size_t i = 0; i < std::min(shown, notes.size()); ++i) text += indent + "note: " + notes[i] + "\n";
    if (notes.size() > shown)
        text += fmt::format("{}and {} more: shadowbench validate shows them\n", indent, notes.size() - shown);
    return text;
}

}  // namespace shadowbench::results
