#include "bench/one_light.h"

#include <charconv>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "document/document.h"
#include "document/technique_choice.h"
#include "rays/capture.h"

namespace shadowbench::bench {
namespace {

using base::Error;
using base::ErrorCode;

RaySource::Watch stage(const ProgressCallback& progress, const char* name, const rays::MapLayout& layout) {
    if (!progress) return {};
    return [&progress, name, total = static_cast<std::size_t>(layout.tiles())](std::size_t done) {
        progress({"", name, done, total});
    };
}

}  // namespace

document::Variant only_variant(const nlohmann::json& document) {
    std::vector<document::Variant> variants = document::expand(document);
    if (variants.size() == 1) return std::move(variants[0]);
    std::string swept;
    for (const document::Setting& setting : variants[0].settings)
        swept += (swept.empty() ? "" : ", ") + setting.pointer;
    throw Error(ErrorCode::usage, "--set",
                fmt::format("the scenario sweeps over {}; set one value of each, as in --set {}=...", swept,
                            variants[0].settings[0].pointer));
}

std::vector<std::string> names_of(const std::vector<scene::Light>& lights) {
    std::vector<std::string> names;
    for (const scene::Light& light : lights) names.push_back(light.name);
    return names;
}

std::size_t find_light(const std::vector<std::string>& names, const std::string& name, const std::string& prefix) {
    if (name.empty()) return 0;
    std::string list;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i] == name) return i;
        list += fmt::format("{}{} {}", i > 0 ? ", " : "", i, names[i]);
    }
    std::size_t index = 0;
    const auto [rest, fault] = std::from_chars(name.data(), name.data() + name.size(), index);
    if (fault == std::errc() && rest == name.data() + name.size() && index < names.size()) return index;
    throw Error(ErrorCode::usage, prefix + name, "there is no such light; the scenario has: " + list);
}

OneLight::OneLight(const nlohmann::json& document, const RunOptions& options, const std::string& light)
    : options_(options), loader_(options.data) {
    scenario_ = &loader_.load(only_variant(document));
    index_ = find_light(names_of(scenario_->lights), light, "--light ");
    light_ = &scenario_->lights[index_];
    prepared_ = prepare_light(*scenario_, index_, {}, options_.limits);
    if (!scenario_->scene.objects.empty()) casters_ = std::make_unique<rays::Tracer>(scenario_->scene, true);
}

// Rays are captured only while `visit` asks for them, which must be once.
void OneLight::capture(std::span<Contender> contenders, const Visit& visit) const {
    const PreparedLight prepared = prepare_light(*scenario_, index_, contenders, options_.limits);
    const rays::Capture capture(scenario_->scene, prepared.view, prepared.layout);
    const RaySource source(capture, prepared.layout);
    visit(source, prepared);
    if (source.segments() == 0)
        throw Error(ErrorCode::bad_input, light_->where,
                    fmt::format("light \"{}\" sees nothing that casts a shadow", light_->name));
}

void OneLight::for_each_batch(const std::function<void(RaySource::Batch)>& body,
                              const ProgressCallback& progress) const {
    const RaySource::Watch watch = stage(progress, "capture", prepared_.layout);
    std::size_t done = 0;
    capture({}, [&](const RaySource& source, const PreparedLight&) {
        source.for_each_batch(0, [&](RaySource::Batch batch) {
            body(batch);
            if (watch) watch(done += batch.size());
        });
    });
}

Contender OneLight::build(const document::TechniqueChoice& technique, const ProgressCallback& progress) const {
    const std::string where = fmt::format("--technique {}", technique.row->id);
    Contender contender =
        make_contender({technique.row->id, techniques::to_json(technique.values).dump(), where}, where);
    const std::span<Contender> contenders(&contender, 1);
    capture(contenders, [&](const RaySource& source, const PreparedLight& prepared) {
        build_all(contenders, source, {prepared.layout, prepared.view, casters_.get()}, options_.limits.all,
                  stage(progress, "build", prepared.layout));
    });
    if (!contender.ok()) throw Error(ErrorCode::internal, where, contender.cell.reason);
    return contender;
}

}  // namespace shadowbench::bench
