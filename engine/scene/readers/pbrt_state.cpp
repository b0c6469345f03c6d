#include "scene/readers/pbrt_state.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include <fmt/format.h>

namespace shadowbench::scene {
namespace {

constexpr std::size_t most_saved = 100'000;

Vec3d three(const PbrtStatement& s, std::size_t from = 0) {
    return {s.numbers[from], s.numbers[from + 1], s.numbers[from + 2]};
}

Matrix sixteen(const PbrtStatement& s) {
    Matrix matrix;
    for (std::size_t i = 0; i < 16; ++i) matrix[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = s.numbers[i];
    return matrix;
}

// Of a material: whether its shapes only bound media.
bool is_boundary(const std::string& type) {
    return type.empty() || type == "interface" || type == "none";
}

}  // namespace

// What the transforms of the camera were before the world begins is known as "camera".
bool PbrtState::take(const PbrtStatement& s) {
    struct Row {
        std::string_view word;
        void (PbrtState::*act)(const PbrtStatement& s);
    };
    static constexpr std::array rows{Row{"ActiveTransform", &PbrtState::active_transform},
                                     Row{"AttributeBegin", &PbrtState::save},
                                     Row{"AttributeEnd", &PbrtState::restore},
                                     Row{"Camera", &PbrtState::camera},
                                     Row{"ConcatTransform", &PbrtState::concat_transform},
                                     Row{"CoordSysTransform", &PbrtState::use_system},
                                     Row{"CoordinateSystem", &PbrtState::coordinate_system},
                                     Row{"Identity", &PbrtState::identity},
                                     Row{"LookAt", &PbrtState::look_at},
                                     Row{"MakeNamedMaterial", &PbrtState::make_material},
                                     Row{"Material", &PbrtState::material},
                                     Row{"NamedMaterial", &PbrtState::named_material},
                                     Row{"Rotate", &PbrtState::rotate},
                                     Row{"Scale", &PbrtState::scale},
                                     Row{"Transform", &PbrtState::transform},
                                     Row{"TransformBegin", &PbrtState::save},
                                     Row{"TransformEnd", &PbrtState::restore},
                                     Row{"Translate", &PbrtState::translate},
                                     Row{"WorldBegin", &PbrtState::world}};
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const Row& each) { return each.word == s.word; });
    if (row == rows.end()) return false;
    (this->*row->act)(s);
    return true;
}

void PbrtState::save(const PbrtStatement& s) {
    if (saved_.size() >= most_saved) s.fail(fmt::format("over {} saved attributes inside each other", most_saved));
    saved_.push_back({s.word.substr(0, s.word.size() - 5), now});
}

void PbrtState::restore(const PbrtStatement& s) {
    const std::string_view by = s.word.substr(0, s.word.size() - 3);
    if (saved_.empty() || saved_.back().by != by) s.fail(fmt::format("{} ends no {}Begin", s.word, by));
    const PbrtAttributes& before = saved_.back().attributes;
    if (by == "Transform") {
        now.place = before.place;
        now.at_begin = before.at_begin;
    } else {
        now = before;
    }
    saved_.pop_back();
}

void PbrtState::place(const PbrtStatement& s, const Matrix& matrix) {
    if (!now.at_begin) {
        ++late_transforms_;
        return;
    }
    if (!is_affine(matrix)) s.fail("a transform must be finite and keep parallel lines parallel");
    now.place = matrix;
}

void PbrtState::multiply(const PbrtStatement& s, const Matrix& by) {
    place(s, by * now.place);
}

void PbrtState::identity(const PbrtStatement& s) {
    place(s, Matrix());
}

void PbrtState::translate(const PbrtStatement& s) {
    multiply(s, translation(three(s)));
}

void PbrtState::scale(const PbrtStatement& s) {
    multiply(s, scaling(three(s)));
}

void PbrtState::rotate(const PbrtStatement& s) {
    if (!(three(s, 1).length() > 0.0)) s.fail("a rotation needs an axis that is not 0");
    multiply(s, rotation(s.numbers[0], three(s, 1)));
}

void PbrtState::look_at(const PbrtStatement& s) {
    const std::optional<Matrix> matrix = looking(three(s), three(s, 3), three(s, 6));
    if (!matrix) s.fail("LookAt needs two places, and an up that is not along the line between them");
    multiply(s, *matrix);
}

void PbrtState::transform(const PbrtStatement& s) {
    place(s, sixteen(s));
}

void PbrtState::concat_transform(const PbrtStatement& s) {
    multiply(s, sixteen(s));
}

void PbrtState::active_transform(const PbrtStatement& s) {
    if (s.texts[0] != "All" && s.texts[0] != "StartTime" && s.texts[0] != "EndTime")
        s.fail("ActiveTransform needs All, StartTime or EndTime");
    now.at_begin = s.texts[0] != "EndTime";
}

void PbrtState::coordinate_system(const PbrtStatement& s) {
    systems_[s.texts[0]] = now.place;
}

void PbrtState::use_system(const PbrtStatement& s) {
    const auto known = systems_.find(s.texts[0]);
    if (known == systems_.end()) s.fail(fmt::format("there is no coordinate system \"{}\"", s.texts[0].substr(0, 40)));
    place(s, known->second);
}

void PbrtState::camera(const PbrtStatement&) {
    systems_["camera"] = now.place.inverse();
}

void PbrtState::world(const PbrtStatement&) {
    now.place = Matrix();
    now.at_begin = true;
    systems_["world"] = Matrix();
}

void PbrtState::material(const PbrtStatement& s) {
    now.is_surface = !is_boundary(s.texts[0]);
}

void PbrtState::make_material(const PbrtStatement& s) {
    if (is_boundary(s.text("type", ""))) boundaries_.insert(s.texts[0]);
}

void PbrtState::named_material(const PbrtStatement& s) {
    now.is_surface = !boundaries_.contains(s.texts[0]);
}

}  // namespace shadowbench::scene
