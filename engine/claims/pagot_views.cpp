#include "claims/pagot_views.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/queries.h"
#include "render/render.h"
#include "render/shading.h"

namespace shadowbench::claims::pagot {
namespace {

constexpr double turn = 360.0 / lights;  // degrees
constexpr std::size_t judged = 4096;     // receivers compared with the truth
constexpr double faces_light = 0.1;      // least shade of a receiver: what is turned away shows no shadow

// Of close views: a cell is more than a pixel wide.
constexpr double fov_of_plane = 12.0, fov_of_balls = 20.0;  // degrees
const base::Vec3d middle_of_balls(0.0, 1.1, 0.1);

base::Vec3d vector_of(const nlohmann::json& value) {
    return {value.at(0).get<double>(), value.at(1).get<double>(), value.at(2).get<double>()};
}

nlohmann::json json_of(const base::Vec3d& value) {
    return nlohmann::json::array({value.x, value.y, value.z});
}

// The position turned around the vertical axis through the target.
void turn_around_target(nlohmann::json& thing, double degrees) {
    const double angle = degrees * std::numbers::pi / 180.0, c = std::cos(angle), s = std::sin(angle);
    const base::Vec3d target = vector_of(thing.at("target")), from = vector_of(thing.at("position")) - target;
    thing["position"] = json_of(target + base::Vec3d(c * from.x + s * from.z, from.y, c * from.z - s * from.x));
}

void add_apart(const render::Image& a, const render::Image& b, Apart& apart) {
    const render::PictureErrors errors = render::compare(a, b);
    apart.rms.push_back(errors.rms);
    apart.flip.push_back(errors.flip_mean);
}

double sum_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

double least_shade(const nlohmann::json& document, Surfaces surfaces) {
    if (surfaces == Surfaces::plane) return faces_light;
    const nlohmann::json &light = document.at("lights").at(0), &resolution = document.at("rays").at("resolution");
    const double cells = resolution.is_array() ? resolution.at(0).get<double>() : resolution.get<double>();
    const double distance = (vector_of(light.at("target")) - vector_of(light.at("position"))).length();
    const double angle = light.at("angle").get<double>() * std::numbers::pi / 180.0;
    const double cell = 2.0 * distance * std::tan(0.5 * angle) / cells;
    const double reach = 0.5 * std::numbers::sqrt2 * widths[std::size(widths) - 1];  // cells, to a footprint's corner
    const double slope = document.at("receivers").at("bias").get<double>() / (reach * cell);
    return render::surface_albedo / std::sqrt(1.0 + slope * slope);
}

nlohmann::json turned(nlohmann::json document, double light_degrees, double camera_degrees) {
    turn_around_target(document.at("lights").at(0), light_degrees);
    turn_around_target(document.at("receivers"), camera_degrees);
    return document;
}

base::Vec3d middle_of_shadow(const nlohmann::json& document) {
    const nlohmann::json& light = document.at("lights").at(0);
    const base::Vec3d position = vector_of(light.at("position")), target = vector_of(light.at("target"));
    return position + (target - position) * (position.y / (position.y - target.y));
}

nlohmann::json aimed(nlohmann::json document, const base::Vec3d& at, double fov) {
    nlohmann::json& camera = document.at("receivers");
    const base::Vec3d from = vector_of(camera.at("position")) - vector_of(camera.at("target"));
    camera["position"] = json_of(at + from);
    camera["target"] = json_of(at);
    camera["fov"] = fov;
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
    const auto best = std::min_element(error.begin(), error.end(),
                                       [](const auto& a, const auto& b) { return sum_of(a) < sum_of(b); });
    return static_cast<std::size_t>(best - error.begin());
}

Views::Views(const Context& context, const char* scene, Surfaces surfaces, std::vector<Kernel> kernels)
    : surfaces_(surfaces), kernels_(std::move(kernels)), measured_(kernels_.size()) {
    std::vector<std::string> requests;
    for (const Kernel& kernel : kernels_) requests.push_back(request(kernel));
    std::vector<std::string> set{fmt::format("techniques=[{}]", fmt::join(requests, ",")),
                                 "reference.samples_per_pixel=32"};
    if (context.quick) set.insert(set.end(), {"rays.resolution=256", "receivers.resolution=[256,192]"});
    const nlohmann::json document = context.document(scene, set);
    note_document(context, scene, document);
    least_shade_ = least_shade(document, surfaces_);
    // Twice the turn of the light makes another angle between the light and the camera each time.
    for (int i = 0; i < lights; ++i) {
        nlohmann::json one = turned(document, turn * i, 2.0 * turn * i);
        one = surfaces_ == Surfaces::plane ? aimed(one, middle_of_shadow(one), fov_of_plane)
                                           : aimed(one, middle_of_balls, fov_of_balls);
        add(with_moved_map(std::move(one), static_cast<std::uint64_t>(i)), context.data);
    }
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

bool Views::on_surfaces(const Seen& seen, std::size_t query) const {
    return (std::abs(seen.place(query).y) < 1e-3) == (surfaces_ == Surfaces::plane);
}

// Other surfaces are white.
render::Image Views::shaded(const Seen& seen, std::size_t kernel) const {
    std::vector<float> values(seen.queries().size(), 1.0f);
    for (std::size_t q = 0; q < values.size(); ++q)
        if (on_surfaces(seen, q)) values[q] = seen.visibility(kernel)[q] * seen.shade(q);
    return seen.picture(values);
}

void Views::add(const nlohmann::json& document, const scene::SearchPath& data) {
    std::vector<std::vector<render::Image>> pictures(kernels_.size());  // of each phase, the opposite of the first last
    for (const base::Vec2d& phase :
         {base::Vec2d(0.0, 0.0), base::Vec2d(0.5, 0.0), base::Vec2d(0.0, 0.5), base::Vec2d(0.5, 0.5)}) {
        const Seen seen(document, data, phase);
        if (pictures.front().empty()) add_numbers(seen);
        for (std::size_t k = 0; k < kernels_.size(); ++k) pictures[k].push_back(shaded(seen, k));
    }
    for (std::size_t k = 0; k < kernels_.size(); ++k) {
        Measured& measured = measured_[k];
        measured.mean.push_back(mean_picture(pictures[k]));
        measured.numbers.aliasing.push_back(rms_from(pictures[k], measured.mean.back()));
        add_apart(pictures[k].front(), pictures[k].back(), measured.numbers.half_a_cell_on);
        measured.one.push_back(std::move(pictures[k].front()));
    }
}

// Transitions and errors. The expected square of the truth's noise is taken off the errors'.
void Views::add_numbers(const Seen& seen) {
    std::vector<std::size_t> receivers;
    for (std::size_t q = 0; q < seen.queries().size(); ++q)
        if (on_surfaces(seen, q) && seen.shade(q) >= least_shade_) receivers.push_back(q);
    std::vector<std::size_t> chosen;
    for (const std::size_t i : bench::choose_judged(receivers.size(), judged, 1)) chosen.push_back(receivers[i]);
    std::vector<techniques::Query> asked;
    for (const double width : widths)
        for (const std::size_t q : chosen) {
            asked.push_back(seen.queries()[q]);
            asked.back().width = static_cast<float>(width);
        }
    const bench::Truth truth = seen.truth(asked);
    for (std::size_t k = 0; k < kernels_.size(); ++k) {
        const std::span<const float> visibility = seen.visibility(k);
        const auto between = std::count_if(receivers.begin(), receivers.end(), [&](std::size_t q) {
            return visibility[q] > 0.001f && visibility[q] < 0.999f;
        });
        Numbers& numbers = measured_[k].numbers;
        numbers.transition.push_back(static_cast<double>(between) / static_cast<double>(receivers.size()));
        for (std::size_t w = 0; w < std::size(widths); ++w) {
            double squares = 0.0;
            for (std::size_t i = 0; i < chosen.size(); ++i) {
                const std::size_t at = w * chosen.size() + i;
                const double off = static_cast<double>(visibility[chosen[i]]) - truth.value[at];
                squares += off * off - truth.standard_error[at] * truth.standard_error[at];
            }
            const double mean = squares / static_cast<double>(chosen.size());
            numbers.error[w].push_back(std::sqrt(std::max(mean, 0.0)));
        }
    }
}

}  // namespace shadowbench::claims::pagot
