// Deep shadow maps from volumetric data: sections "Implementation" and "Results", figure 4.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "claims/paper.h"
#include "claims/sheet.h"
#include "claims/texel.h"
#include "claims/volume.h"
#include "claims/volume_crossings.h"
#include "claims/volume_rays.h"
#include "claims/volume_sets.h"

namespace shadowbench::claims {
namespace {

using results::Cell;

using volume::avsm;
using volume::bytes_a_texel;
using volume::Crossings;
using volume::data_sets;
using volume::DataSet;
using volume::MeasuredSet;
using volume::PassTimes;
using volume::place_of;
using volume::Sets;
using volume::volume_deep;

constexpr double image_pixels = 512.0 * 512.0;  // of a frame, our choice: the paper gives only the map's size

// "box 0.1, bucky 0.2, ..."
template <class Text>
std::string list(const Sets& sets, const Text& text) {
    std::vector<std::string> parts;
    for (const MeasuredSet& m : sets) parts.push_back(fmt::format("{} {}", m.name, text(m)));
    return fmt::format("{}", fmt::join(parts, ", "));
}

template <class Judge>
std::vector<Judged> judged(const Sets& sets, const Judge& judge) {
    std::vector<Judged> cases;
    for (const MeasuredSet& m : sets) cases.push_back(judge(m));
    return cases;
}

template <class Number>
std::vector<Value> values(const Sets& sets, const Number& number) {
    std::vector<Value> result;
    for (const MeasuredSet& m : sets) result.push_back(number(m));
    return result;
}

void table_of_techniques(const Sets& sets, PaperReport& report) {
    Table table{
        "Times, sizes and errors of visibility over four data sets. Curve errors are the largest of each "
        "function: their maximum and rms over all texels, exact for these regular rays. Lookup errors are over "
        "the judged receivers",
        {"data", "technique", "ms a build", "ns a lookup", "bytes a texel", "curve error max", "curve error rms",
         "lookup error rms", "lookup error max"},
        {}};
    for (const MeasuredSet& m : sets)
        for (const Cell& cell : m.light().cells) {
            if (cell.status == results::CellStatus::failed) continue;  // a claim that needs it will report it
            const std::size_t place = place_of(cell, m.light());
            table.rows.push_back({m.name, results::title(cell), to_text(m.builds.time(place)),
                                  to_text(m.lookups.time(place)), fmt::format("{:.3g}", bytes_a_texel(cell, m.light())),
                                  fmt::format("{:.2g}", cell.curve->norms.max),
                                  fmt::format("{:.2g}", cell.curve->norms.rms), to_text(error_of(cell)),
                                  fmt::format("{:.2g}", cell.lookup->norms.max)});
        }
    report.tables.push_back(std::move(table));
}

// Milliseconds of one thread for a frame: marching through the data from the light, building the map, and both passes
// of an image that the volume fills.
struct Frame {
    Value march, build, colour, opacity;

    Value rate() const { return 1e3 * (exactly(1.0) / (march + build + colour + opacity)); }
};

Frame frame_of(const MeasuredSet& m, const PassTimes& passes) {
    const Cell& point = volume_deep(m.light(), "smooth", volume::map_steps, "point");  // the paper's lookup: one texel
    const double pixels = 1e-6 * image_pixels;                                         // and from ns to ms
    return {m.builds.time(m.march), m.builds.time(place_of(point, m.light())), pixels * passes.colour,
            pixels * passes.opacity};
}

void frames_a_second(const Sets& sets, const std::vector<PassTimes>& passes, PaperReport& report) {
    Table table{
        fmt::format("Times of a frame on one thread: {} lookups of one texel each for a pixel, and 512 x 512 pixels, "
                    "our choice, since the paper gives only the map's size",
                    volume::view_lookups),
        {"data", "voxels", "ms a march", "ms a build", "ms of a first pass", "ms of a second pass", "frames a second"},
        {}};
    Value slowest = exactly(std::numeric_limits<double>::infinity());
    std::vector<std::string> texts;
    std::vector<Value> rates;
    for (std::size_t i = 0; i < sets.size(); ++i) {
        const Frame frame = frame_of(sets[i], passes[i]);
        const Value rate = frame.rate();
        table.rows.push_back({sets[i].name, data_sets[i].size, to_text(frame.march), to_text(frame.build),
                              to_text(frame.colour), to_text(frame.opacity), to_text(rate)});
        texts.push_back(fmt::format("{} of {} {}", sets[i].name, data_sets[i].size, to_text(rate)));
        rates.push_back(rate);
        slowest = least(slowest, rate);
    }
    report.tables.push_back(std::move(table));
    const Value threads = exactly(180.0) / slowest;
    rates.push_back(threads);
    report.claims.push_back(
        {"section Results",
         "180 to 330 frames a second based on the size of the data set, with up to 512 steps to build and 128 lookups "
         "a view ray",
         fmt::format("frames a second: {}; 180 everywhere would take {} such threads", fmt::join(texts, ", "),
                     to_text(threads)),
         not_comparable(),
         "Theirs is a GPU (GeForce GTX 465), ours one thread of a processor. The paper does not say which data set had "
         "which rate.",
         rates});
}

void shadows_behind(const Sets& sets, PaperReport& report) {
    const auto plane = [](const MeasuredSet& m) { return error_of(volume_deep(m.behind(), "smooth")); };
    const auto inside = [](const MeasuredSet& m) { return error_of(volume_deep(m.light(), "smooth")); };
    report.claims.push_back(
        {"section Implementation, figure 4", "the maximum opacity casts the volume's shadow on other objects",
         "lookup error rms on the plane / with the volume's inside: " +
             list(sets,
                  [&](const MeasuredSet& m) { return fmt::format("{} / {}", to_text(plane(m)), to_text(inside(m))); }),
         in_all(judged(sets, [&](const MeasuredSet& m) { return judge_unnoticed(plane(m)); })),
         "The maximum is the opacity of a whole ray: behind everything a texel answers with it alone, so it must be "
         "that of exact rays. The remaining error is that of one ray a texel.",
         values(sets, plane)});
}

void thresholds(const Sets& sets, PaperReport& report) {
    const auto fixed = [](const MeasuredSet& m) -> const Cell& { return volume_deep(m.light(), "smooth"); };
    const auto errors = [](const Cell& cell) {
        return fmt::format("{:.2g} / {:.2g} / {}", cell.curve->norms.max, cell.curve->norms.rms,
                           to_text(error_of(cell)));
    };
    const auto of_avsm = [&](int nodes) {
        return fmt::format("; AVSM {}: ", nodes) +
               list(sets, [&](const MeasuredSet& m) { return errors(avsm(m.light(), nodes)); });
    };
    report.claims.push_back(
        {"section Implementation",
         "the depths of 10, 50 and 90 % opacity and the maximum are a representation of the visibility of all depths",
         "curve error max / rms / lookup error rms: " +
             list(sets, [&](const MeasuredSet& m) { return errors(fixed(m)); }) + of_avsm(4) + of_avsm(2),
         not_comparable(),
         "The introduction calls deep shadow maps such a representation. The paper chooses the levels, and does not "
         "say how well they fit: a limit would be ours. Curve errors are the largest of each function: their maximum "
         "and rms over all texels, exact for these regular rays. Fixed levels jump by 10 % at the first and the last "
         "depth. AVSM of 4 nodes takes twice the bytes, of 2 as many.",
         values(sets, [&](const MeasuredSet& m) { return exactly(fixed(m).curve->norms.rms); })});
}

void memory(const Sets& sets, PaperReport& report) {
    const auto ours = [](const MeasuredSet& m) {
        return exactly(bytes_a_texel(volume_deep(m.light(), "smooth"), m.light()));
    };
    constexpr double paper = 4.0 * sizeof(float);
    report.claims.push_back(
        {"section Implementation", "the map is one texture of four numbers a texel",
         "bytes a texel, uncompressed beside it: " +
             list(sets,
                  [&](const MeasuredSet& m) {
                      return fmt::format("{} ({:.3g})", to_text(ours(m)),
                                         bytes_a_texel(cell_of(m.light(), "uncompressed"), m.light()));
                  }),
         by_construction(std::all_of(sets.begin(), sets.end(),
                                     [&](const MeasuredSet& m) { return std::abs(ours(m).value - paper) < 0.5; })),
         "Four floats are 16 bytes; the paper does not say how many bits a channel of its texture has.",
         values(sets, ours)});
}

// The function of one ray beside what maps keep of it.
void curve_figure(const Context& context, const DataSet& set) {
    const nlohmann::json document = context.document(
        set.scenario,
        {"rays.resolution=128",
         R"(techniques=[{"type":"volume_deep","cells":"sample"},{"type":"avsm","cells":"sample","nodes":4}])"});
    note_document(context, set.scenario, document);
    const TexelCurves curves = busiest_texel(document, context.data);
    context.report->plots.push_back({fmt::format("volume_{}", set.name),
                                     fmt::format("{}: light along one ray of many segments", set.name),
                                     "depth from light", "visibility", false, false, curves.series});
}

}  // namespace

void measure_volume(const Context& context) {
    context.report->conditions = fmt::format(
        "The Bucky ball has the paper's name and size; box, rods and clouds are procedural and have its sizes. "
        "512 x 512 texels of one light ray, {} data sets, 128 lookups a view ray, on one thread of a processor where "
        "the paper used a GPU. The paper judged pictures by eye; here errors are against exact rays. Lookups take the "
        "mean over a footprint of a texel's width; where one texel is named, and in figures 2 and 3, they answer from "
        "one texel. Light rays are regular, through the middles of texels; where seeds are named, they are jittered. "
        "Figure 3 is drawn by the paper's renderer of two passes; its errors are of view rays through random places of "
        "the pixels, with the median over {} views around the volume and their range. Plots show the ray of the most "
        "segments among those that keep more than 0.3 of their light at half the depth of a map of 128 x 128 texels. "
        "The paper's future work (one pass, coloured shadows, several volumes) is not measured, nor are the streaks "
        "that it explains by its data.",
        std::size(data_sets), volume::views);
    Sets sets;
    std::vector<Crossings> crossings;
    for (const DataSet& set : data_sets) {
        sets.push_back(volume::measure_set(context, set));
        crossings.push_back(volume::measure_crossings(context, set));
    }
    table_of_techniques(sets, *context.report);
    const std::vector<PassTimes> passes = volume::two_pass_renderer(context);
    frames_a_second(sets, passes, *context.report);
    volume::add_crossings(crossings, *context.report);
    shadows_behind(sets, *context.report);
    thresholds(sets, *context.report);
    memory(sets, *context.report);
    for (const DataSet& set : data_sets) curve_figure(context, set);
    volume::channel_pictures(context);
    context.report->sheets.push_back(picture_sheet(
        context, "volume_bucky",
        {"receivers.filter_width=1",
         R"(techniques=[{"type":"volume_deep","cells":"sample"},{"type":"volume_deep","cells":"sample","interpolation":"bucket"},)"
         R"({"type":"avsm","cells":"sample","nodes":4},{"type":"avsm","cells":"sample"}])"}));
}

}  // namespace shadowbench::claims
