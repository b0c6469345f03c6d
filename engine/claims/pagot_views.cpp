#include "claims/pagot_views.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "render/render.h"

namespace shadowbench::claims::pagot {
namespace {

constexpr double turn = 360.0 / lights;  // degrees
constexpr std::size_t judged = 4096;     // receivers compared with the truth

// The position turned around the vertical axis through the target.
void turn_around_target(nlohmann::json& thing, double degrees) {
    nlohmann::json& position = thing.at("position");
    const nlohmann::json& target = thing.at("target");
    const double angle = degrees * std::numbers::pi / 180.0, c = std::cos(angle), s = std::sin(angle);
    const double tx = target.at(0).get<double>(), tz = target.at(2).get<double>();
    const double x = position.at(0).get<double>() - tx, z = position.at(2).get<double>() - tz;
    position.at(0) = tx + c * x + s * z;
    position.at(2) = tz - s * x + c * z;
}

void add_apart(const render::Image& a, const render::Image& b, Apart& apart) {
    const render::PictureErrors errors = render::compare(a, b);
    apart.rms.push_back(errors.rms);
    apart.flip.push_back(errors.flip_mean);
}

double transition_share(const render::Image& picture) {
    const auto between = std::count_if(picture.pixels.begin(), picture.pixels.end(),
                                       [](const base::Vec3f& p) { return p.x > 0.001f && p.x < 0.999f; });
    return static_cast<double>(between) / static_cast<double>(picture.pixels.size());
}

double sum_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

nlohmann::json turned(nlohmann::json document, double light_degrees, double camera_degrees) {
    turn_around_target(document.at("lights").at(0), light_degrees);
    turn_around_target(document.at("receivers"), camera_degrees);
    return document;
}

render::Image mean_picture(const std::vector<render::Image>& pictures) {
    render::Image mean = pictures.front();
    for (std::size_t i = 1; i < pictures.size(); ++i)
        for (std::size_t p = 0; p < mean.pixels.size(); ++p) mean.pixels[p] += pictures[i].pixels[p];
    for (base::Vec3f& pixel : mean.pixels) pixel /= static_cast<float>(pictures.size());
    return mean;
}

double rms_from(const std::vector<render::Image>& pictures, const render::Image& mean) {
    double squares = 0.0;
    for (const render::Image& picture : pictures)
        for (std::size_t p = 0; p < mean.pixels.size(); ++p) {
            const double off = static_cast<double>(picture.pixels[p].x) - mean.pixels[p].x;
            squares += off * off;
        }
    return std::sqrt(squares / static_cast<double>(pictures.size() * mean.pixels.size()));
}

std::size_t Views::Numbers::best_width() const {
    const auto best = std::min_element(error.begin(), error.end(), [](const auto& a, const auto& b) {
        return sum_of(a) < sum_of(b);
    });
    return static_cast<std::size_t>(best - error.begin());
}

Views::Views(const Context& context, const char* scene, std::vector<Kernel> kernels)
    : kernels_(std::move(kernels)), measured_(kernels_.size()) {
    std::vector<std::string> requests;
    for (const Kernel& kernel : kernels_) requests.push_back(request(kernel));
    std::vector<std::string> set{fmt::format("techniques=[{}]", fmt::join(requests, ",")),
                                 "reference.samples_per_pixel=32"};
    if (context.quick) set.insert(set.end(), {"rays.resolution=256", "receivers.resolution=[256,192]"});
    const nlohmann::json document = context.document(scene, set);
    note_document(context, scene, document);
    // Twice the turn of the light makes another angle between the light and the camera each time.
    for (int i = 0; i < lights; ++i)
        add(with_moved_map(turned(document, turn * i, 2.0 * turn * i), static_cast<std::uint64_t>(i)), context.data);
}

const Difference& Views::difference(const Kernel& a, const Kernel& b) {
    const std::size_t low = std::min(place(a), place(b)), high = std::max(place(a), place(b));
    Difference& found = differences_[{low, high}];
    if (!found.of_means.rms.empty()) return found;
    const Measured &first = measured_[low], &second = measured_[high];
    for (std::size_t i = 0; i < first.mean.size(); ++i) {
        add_apart(first.mean[i], second.mean[i], found.of_means);
        add_apart(first.one[i], second.one[i], found.in_one_phase);
    }
    return found;
}

std::size_t Views::place(const Kernel& kernel) const {
    return static_cast<std::size_t>(std::find(kernels_.begin(), kernels_.end(), kernel) - kernels_.begin());
}

void Views::add(const nlohmann::json& document, const scene::SearchPath& data) {
    std::vector<std::vector<render::Image>> pictures(kernels_.size());  // of each phase, the opposite of the first last
    for (const base::Vec2d& phase : {base::Vec2d(0.0, 0.0), base::Vec2d(0.5, 0.0), base::Vec2d(0.0, 0.5),
                                     base::Vec2d(0.5, 0.5)}) {
        const Seen seen(document, data, phase);
        if (pictures.front().empty()) add_errors(seen);
        for (std::size_t k = 0; k < kernels_.size(); ++k) pictures[k].push_back(seen.picture(seen.visibility(k)));
    }
    for (std::size_t k = 0; k < kernels_.size(); ++k) {
        Measured& measured = measured_[k];
        measured.mean.push_back(mean_picture(pictures[k]));
        measured.numbers.aliasing.push_back(rms_from(pictures[k], measured.mean.back()));
        measured.numbers.transition.push_back(transition_share(pictures[k].front()));
        add_apart(pictures[k].front(), pictures[k].back(), measured.numbers.half_a_cell_on);
        measured.one.push_back(std::move(pictures[k].front()));
    }
}

// The expected square of the truth's noise is taken off.
void Views::add_errors(const Seen& seen) {
    const std::vector<std::size_t> chosen = seen.chosen(judged);
    std::vector<techniques::Query> asked;
    for (const double width : widths)
        for (const std::size_t q : chosen) {
            asked.push_back(seen.queries()[q]);
            asked.back().width = static_cast<float>(width);
        }
    const bench::Truth truth = seen.truth(asked);
    for (std::size_t k = 0; k < kernels_.size(); ++k)
        for (std::size_t w = 0; w < std::size(widths); ++w) {
            double squares = 0.0;
            for (std::size_t i = 0; i < chosen.size(); ++i) {
                const std::size_t at = w * chosen.size() + i;
                const double off = static_cast<double>(seen.visibility(k)[chosen[i]]) - truth.value[at];
                squares += off * off - truth.standard_error[at] * truth.standard_error[at];
            }
            const double mean = squares / static_cast<double>(chosen.size());
            measured_[k].numbers.error[w].push_back(std::sqrt(std::max(mean, 0.0)));
        }
}

}  // namespace shadowbench::claims::pagot
