// How Trials goes on with the trials of an exploration that ended early.
#include <nlohmann/json.hpp>

#include "recommend/attempt.h"
#include "recommend/record.h"
#include "recommend/request.h"

namespace shadowbench::recommend {

void Trials::keep_in(const std::filesystem::path& folder) {
    // With another limit of memory, other maps fail, and other light rays are kept.
    files_.emplace(folder, result_without_variants(),
                   nlohmann::json{{"light", light_->name},
                                  {"measure", measure_words[static_cast<std::size_t>(measure_)]},
                                  {"memory", options_.limits.all}});
}

void Trials::note_effort(const Setting& setting, double seconds, double rays, double bytes) {
    if (bytes > large_map) {
        large_seconds_ += seconds;
        large_bytes_ += bytes;
        return;
    }
    Effort& effort = efforts_[setting.row];
    effort.seconds += seconds;
    effort.rays += rays;
}

// Of the setting, and of the library that its technique is from.
std::string Trials::filed_name(const Point& point, const Setting& setting) const {
    nlohmann::ordered_json name = scenario_part(space_->families()[point.family], point);
    const techniques::Library& library = setting.row->library;
    if (!library.file.empty()) name["library"] = {library.file, library.hash, library.isolated};
    return name.dump();
}

Trial Trials::take(const FiledTrial& filed, const Point& point, const Setting& setting) {
    ++taken_;
    const results::LightResult& light = filed.variant.lights.at(0);
    const results::Cell& cell = light.cells.at(0);
    if (filed.seconds > 0.0) note_effort(setting, filed.seconds, filed.rays, static_cast<double>(cell.bytes));
    if (filed.trial.failed.empty()) trials_.emplace_back(point, filed.trial);
    results::LightResult* there = recorded(setting);
    if (!there) {
        there = &recorded_.emplace_back(choice(setting, 0), light).second;
        there->cells.clear();
    }
    put_cell(*there, cell);
    return filed.trial;
}

void Trials::file(const Point& point, const Setting& setting, const results::LightResult& light,
                  const results::Cell& cell, FiledTrial filed) const {
    filed.variant = variant_of(choice(setting, 0), light);
    filed.variant.lights[0].cells = {cell};
    files_->write(filed_name(point, setting), filed);
}

}  // namespace shadowbench::recommend
