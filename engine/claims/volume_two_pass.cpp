// Deep shadow maps from volumetric data: section "Implementation", steps 1 to 10 of the lookup, and figure 3.
#include <fmt/format.h>

#include "base/parallel.h"
#include "bench/clock.h"
#include "claims/panels.h"
#include "claims/volume.h"
#include "claims/volume_map.h"
#include "claims/volume_rays.h"
#include "render/default_view.h"
#include "render/exposure.h"
#include "render/render.h"
#include "render/two_pass.h"

namespace shadowbench::claims::volume {
namespace {

using render::BoxRay;

constexpr int repetitions = 7;  // of times
constexpr int few_lookups = 8, some_lookups = 32;
constexpr int converged_lookups = 1024;
constexpr int timed_side = 128;  // pixels

using Numbers = std::vector<double>;

// One number of each view, and their median with its interval.
struct OverViews {
    std::vector<double> values;
    Value value() const { return of(results::summarise(values)); }
};

struct Errors {
    OverViews unshadowed, darkened, share;  // of the picture; share: the second over the first
    OverViews opacity, sampled, exact;      // error of the average opacity; mean of both
    OverViews few, some, many;              // of the average opacity, against many more lookups of the same map
};

void add_view(const VolumeMap& map, const render::ColourPass& pass, std::span<const BoxRay> rays, Errors& errors) {
    const auto sampled = [&](int lookups) { return render::mean_opacities(rays, lookups, map.view, map.maps); };
    const Numbers colour = pass.colours(rays), opacity = sampled(view_lookups),
                  exact = render::exact_opacities(rays, view_lookups, map.scenario.scene, map.view, pass);
    const Numbers truth = render::darkened(colour, exact);
    const double unshadowed = rms(rays, colour, truth), darkened = rms(rays, render::darkened(colour, opacity), truth);
    errors.unshadowed.values.push_back(unshadowed);
    errors.darkened.values.push_back(darkened);
    errors.share.values.push_back(darkened / unshadowed);
    errors.opacity.values.push_back(rms(rays, opacity, exact));
    errors.sampled.values.push_back(mean(rays, opacity));
    errors.exact.values.push_back(mean(rays, exact));
    const Numbers converged = sampled(converged_lookups);
    errors.few.values.push_back(rms(rays, sampled(few_lookups), converged));
    errors.some.values.push_back(rms(rays, sampled(some_lookups), converged));
    errors.many.values.push_back(rms(rays, opacity, converged));
}

struct Measured {
    const char* name;
    Errors errors;
    PassTimes times;
    Value cost;  // time of the second pass with the paper's lookups over that with few
};

// Nanoseconds for a ray through the box, each pass on one thread.
void take_times(const VolumeMap& map, const render::ColourPass& pass, std::span<const BoxRay> rays,
                Measured& measured) {
    const base::ThreadLimit one_thread(1);
    double through = 0.0;
    for (const BoxRay& ray : rays) through += ray.meets() ? 1.0 : 0.0;
    std::vector<double> colour, opacity, few;
    for (int repetition = 0; repetition < repetitions; ++repetition) {
        const auto timed = [&](std::vector<double>& times, const auto& action) {
            const bench::Stopwatch stopwatch;
            action();
            times.push_back(1e9 * stopwatch.seconds() / through);
        };
        timed(colour, [&] { pass.colours(rays); });
        timed(opacity, [&] { render::mean_opacities(rays, view_lookups, map.view, map.maps); });
        timed(few, [&] { render::mean_opacities(rays, few_lookups, map.view, map.maps); });
    }
    measured.times = {of(results::summarise(colour)), of(results::summarise(opacity))};
    std::vector<double> cost;
    for (std::size_t i = 0; i < few.size(); ++i) cost.push_back(opacity[i] / few[i]);
    measured.cost = of(results::summarise(cost));
}

// A row of figure 3: the colour, the colour darkened by the average opacity, and that opacity; beside them the colour
// darkened by the exact light, and how far the second picture is from it, times four.
void add_pictures(const VolumeMap& map, const render::ColourPass& pass, const scene::Camera& camera, base::Vec2i size,
                  std::vector<render::Image>& pictures) {
    constexpr int exact_steps = 64;
    const std::vector<BoxRay> rays = render::box_rays(camera, size, map.grid);
    const Numbers colour = pass.colours(rays), opacity = render::mean_opacities(rays, view_lookups, map.view, map.maps),
                  exact = render::exact_opacities(rays, exact_steps, map.scenario.scene, map.view, pass);
    std::vector<float> seen;
    for (const BoxRay& ray : rays) seen.push_back(ray.meets() ? 1.0f : 0.0f);
    const double exposure = render::exposure_of(render::grey_picture(colour, size), seen);
    const auto exposed = [&](const Numbers& opacities) {
        render::Image image = render::grey_picture(render::darkened(colour, opacities), size);
        for (base::Vec3f& pixel : image.pixels) pixel *= static_cast<float>(exposure);
        return image;
    };
    const render::Image darkened = exposed(opacity), truth = exposed(exact);
    pictures.push_back(exposed(Numbers(rays.size(), 0.0)));
    pictures.push_back(darkened);
    pictures.push_back(render::grey_picture(opacity, size));
    pictures.push_back(truth);
    pictures.push_back(dark_on_white(render::difference_times_four(darkened, truth)));
}

void add_table(const std::vector<Measured>& sets, PaperReport& report) {
    Table table{
        "Figure 3: light on the view rays, 128 lookups each; medians over six views around the volume, with "
        "their range; times are medians over repetitions in the first view",
        {"data", "average opacity", "exact opacity of what is seen", "rms difference of these two",
         "rms difference from the picture in exact light, not shadowed", "the same, darkened", "ns of a first pass",
         "ns of a second pass"},
        {}};
    for (const Measured& m : sets)
        table.rows.push_back({m.name, to_text(m.errors.sampled.value()), to_text(m.errors.exact.value()),
                              to_text(m.errors.opacity.value()), to_text(m.errors.unshadowed.value()),
                              to_text(m.errors.darkened.value()), to_text(m.times.colour), to_text(m.times.opacity)});
    report.tables.push_back(std::move(table));
}

void add_claims(const std::vector<Measured>& sets, PaperReport& report) {
    std::vector<std::string> shadow_texts, sample_texts;
    std::vector<Judged> shadows, samples;
    std::vector<Value> shadow_values, sample_values;
    for (const Measured& m : sets) {
        const Value share = m.errors.share.value(), few = m.errors.few.value(), some = m.errors.some.value(),
                    many = m.errors.many.value();
        shadow_texts.push_back(fmt::format("{} {}", m.name, to_text(share)));
        shadows.push_back(judge_less(share, exactly(1.0)));
        shadow_values.push_back(share);
        sample_texts.push_back(fmt::format("{} {} / {} / {}, {} times the time", m.name, to_text(few), to_text(some),
                                           to_text(many), to_text(m.cost)));
        samples.push_back(both(both(judge_less(many, some), judge_less(some, few)), judge_growth(m.cost)));
        sample_values.insert(sample_values.end(), {few, some, many, m.cost});
    }
    report.claims.push_back(
        {"abstract, figure 3",
         "the average of the sampled opacities, which darkens the volume's colour, determines how much light got to a "
         "fragment",
         fmt::format("difference rms from the picture in exact light, darkened over not shadowed: {}",
                     fmt::join(shadow_texts, ", ")),
         in_all(shadows),
         "The paper says not how exact it is: judged is whether the darkened picture is nearer to the picture in exact "
         "light than one without shadows is. Figure 3 shows the box only; judged over all four data sets, of which the abstract speaks, and six views of "
         "each. The average counts all places of a view ray alike, where the exact light counts what the eye sees of "
         "them; the table has both.",
         shadow_values});
    report.claims.push_back(
        {"section Implementation, step 10", "the number of samples is a balance between performance and quality",
         fmt::format("average opacity with {} / {} / {} samples, error rms against {}; {} take: {}", few_lookups,
                     some_lookups, view_lookups, converged_lookups, view_lookups, fmt::join(sample_texts, ", ")),
         in_all(samples), "Times are those of the second pass with the most samples over the fewest.", sample_values});
}

}  // namespace

std::vector<PassTimes> two_pass_renderer(const Context& context) {
    const int side = context.quick ? 32 : 64;
    const base::Vec2i picture(context.quick ? 96 : 256);
    std::vector<Measured> sets;
    std::vector<render::Image> pictures;
    for (const DataSet& set : data_sets)
        with_map(context, set.scenario, context.quick ? 128 : 512, [&](const VolumeMap& map) {
            const render::ColourPass pass(map.object, map_steps);
            const scene::Camera camera = render::default_camera(map.scenario.scene);
            Measured measured{set.name, {}, {}, {}};
            for (int view = 0; view < views; ++view)
                add_view(map, pass, view_rays(map.scenario.scene, map.grid, side, view), measured.errors);
            take_times(map, pass, render::box_rays(camera, {timed_side, timed_side}, map.grid), measured);
            add_pictures(map, pass, camera, picture, pictures);
            sets.push_back(std::move(measured));
        });
    add_table(sets, *context.report);
    add_claims(sets, *context.report);
    context.report->sheets.push_back(sheet_of(
        "volume_figure3",
        "Figure 3, each row a data set: box (the paper's), bucky, rods, clouds. From left to right, as in the paper: "
        "the volume without shadows; darkened by the average opacity; that opacity. Then the volume in exact light, "
        "and the difference of the second picture from it, times four, dark on white. A row has one exposure",
        pictures, 5));
    std::vector<PassTimes> times;
    for (const Measured& m : sets) times.push_back(m.times);
    return times;
}

}  // namespace shadowbench::claims::volume
