#include "bench/one_light.h"

#include <charconv>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "bench/document.h"
#include "rays/capture.h"

namespace shadowbench::bench {
namespace {

using base::Error;
using base::ErrorCode;

Variant only_variant(const nlohmann::json& document) {
    std::vector<Variant> variants = expand(document);
    if (variants.size() == 1) return std::move(variants[0]);
    std::string swept;
    for (const Setting& setting : variants[0].settings) swept += (swept.empty() ? "" : ", ") + setting.pointer;
    throw Error(ErrorCode::usage, "--set",
                fmt::format("the scenario sweeps over {}; set one value of each, as in --set {}=...", swept,
                            variants[0].settings[0].pointer));
}

RaySource::Watch stage(const ProgressCallback& progress, const char* name, const rays::MapLayout& layout) {
    if (!progress) return {};
    return [&progress, name, total = static_cast<std::size_t>(layout.tiles())](std::size_t done) {
        progress({"", name, done, total});
    };
}

}  // namespace

std::vector<std::string> names_of(const std::vector<scene::Light>& lights) {
    std::vector<std::string> names;
    for (const scene::Light& light : lights) names.push_back(light.name);
    return names;
}

std::size_t find_light(const std::vector<std::string>& names, const std::string& name, const std::string& asked) {
    if (name.empty()) return 0;
    std::string list;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i] == name) return i;
        list += fmt::format("{}{} {}", i > 0 ? ", " : "", i, names[i]);
    }
    std::size_t index = 0;
    const auto [rest, fault] = std::from_chars(name.data(), name.data() + name.size(), index);
    if (fault == std::errc() && rest == name.data() + name.size() && index < names.size()) return index;
    throw Error(ErrorCode::usage, asked + name, "there is no such light; there are: " + list);
}

OneLight::OneLight(const nlohmann::json& document, const RunOptions& options, const std::string& light)
    : options_(options), loader_(options.data) {
    scenario_ = &loader_.load(only_variant(document));
    const std::size_t index = find_light(names_of(scenario_->lights), light, "--light ");
    light_ = &scenario_->lights[index];
    where_ = scenario_->scene.deep_image ? "/scene/deep_image" : fmt::format("/lights/{}", index);
    view_ = rays::make_light_view(*light_, scenario_->scene, scenario_->rays.resolution, where_);
    layout_ = rays::make_layout(scenario_->scene, view_, scenario_->rays);
    if (!scenario_->scene.objects.empty()) casters_ = std::make_unique<rays::Tracer>(scenario_->scene, true);
}

void OneLight::capture(std::span<Contender> contenders, const ProgressCallback& progress, const Visit& visit) const {
    check_memory(*scenario_, view_, contenders, options_.limits, "/rays");
    rays::MapLayout layout = layout_;
    ask_for_needs(contenders, layout);
    const rays::Capture capture(scenario_->scene, view_, layout);
    const RaySource source(capture, layout, options_.limits.kept_rays, stage(progress, "capture", layout));
    if (source.segments() == 0)
        throw Error(ErrorCode::bad_input, where_,
                    fmt::format("light \"{}\" sees nothing that casts a shadow", light_->name));
    visit(source, layout);
}

void OneLight::for_each_batch(const std::function<void(RaySource::Batch)>& body,
                              const ProgressCallback& progress) const {
    capture({}, progress, [&](const RaySource& source, const rays::MapLayout&) { source.for_each_batch(0, body); });
}

Contender OneLight::build(const TechniqueChoice& technique, const ProgressCallback& progress) const {
    const std::string where = fmt::format("--technique {}", technique.row->id);
    Contender contender =
        make_contender({technique.row->id, techniques::to_json(technique.values).dump(), where}, where);
    const std::span<Contender> one(&contender, 1);
    capture(one, progress, [&](const RaySource& source, const rays::MapLayout& layout) {
        build_all(one, source, {layout, view_, casters_.get()}, options_.limits.all, stage(progress, "build", layout));
    });
    if (!contender.ok()) throw Error(ErrorCode::internal, where, contender.cell.reason);
    return contender;
}

}  // namespace shadowbench::bench
