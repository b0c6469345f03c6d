// The settings that an exploration chooses from: every technique with what its row trades (Traits::trades), and the
// resolution and samples of the light rays.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/vec.h"
#include "recommend/lab.h"
#include "scene/scene.h"
#include "techniques/technique.h"

namespace shadowbench::recommend {

// One point in the words of a scenario.
struct Setting {
    const techniques::Technique* row = nullptr;
    techniques::ParameterValues values;
    base::Vec2i resolution;
    int samples = 1;  // a pixel
};

class Space {
public:
    // `only`: ids of techniques; empty: all that can serve the scene. Throws Error{usage} for an unknown id.
    //
    // Resolutions have the scenario's ratio of sides exactly, and its own resolution among them: the light then frames
    // the same part of its plane in all of them. Neighbours differ by a factor of 2^(1/8), or more where the ratio of
    // sides has no such numbers; the larger side is from 16 to 4096 pixels. Samples a pixel are squares up to 256. A
    // deep image's rays are all there are: they have one resolution and one sample.
    Space(const scene::Scenario& scenario, std::span<const std::string> only);

    // One more setting, as a family of its own. `part` is a part of a scenario, as scenario_part() writes it: rays
    // with a resolution of the scenario's ratio of sides and the samples a pixel, where they differ from the
    // scenario's, and one technique. Throws Error{bad_input}, place: a JSON pointer into it.
    Point add(const nlohmann::json& part);

    std::span<const Family> families() const { return families_; }
    // The family that stores every ray's function exactly.
    std::optional<std::size_t> scout() const { return scout_; }
    Setting setting(const Point& point) const;
    const techniques::Technique& row(std::size_t family) const { return *choices_[family].row; }
    // Whether the family is built from light rays.
    bool uses_rays(std::size_t family) const { return !choices_[family].row->traits.traces; }
    base::Vec2i resolution(const Point& point) const;
    int samples(const Point& point) const;

private:
    // The steps of axes 0 and 1.
    struct Rays {
        std::vector<base::Vec2i> resolutions;
        std::vector<int> samples;
        int resolution_stride = 1, sample_stride = 1;

        std::vector<Axis> axes() const;
    };
    struct Choice {
        const techniques::Technique* row = nullptr;
        techniques::ParameterValues values;  // with the family's words
        Rays rays;
        std::vector<std::pair<const char*, std::vector<techniques::ParameterValues::Value>>> numbers = {};  // axes 2, ...
    };
    void add_families(const techniques::Technique& row, const Rays& rays);

    base::Vec2i own_;
    int own_samples_ = 1;
    std::vector<Family> families_;
    std::vector<Choice> choices_;  // of each family
    std::optional<std::size_t> scout_;
};

}  // namespace shadowbench::recommend
