#include "bench/hard_case.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include <nlohmann/json.hpp>

#include "document/document.h"

namespace shadowbench::bench {
namespace {

using techniques::Query;

const std::filesystem::path folder = std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / "scenarios" / "hard";

document::Variant first_variant(const std::string& name, const std::vector<std::string>& assignments) {
    std::ifstream file(folder / (name + ".json"));
    nlohmann::json document = nlohmann::json::parse(file);
    for (const std::string& assignment : assignments) document::set_value(document, assignment);
    return document::expand(document).at(0);
}

void compare(const std::string& name, const auto& answers, const HardCase::Queries& queries,
             const HardCase::Answers& expected, double allowed) {
    ASSERT_EQ(expected.size(), answers.size()) << name;
    double worst = -1.0;
    std::size_t where = 0;
    for (std::size_t i = 0; i < answers.size(); ++i) {
        const double error = std::abs(static_cast<double>(answers[i] - expected[i]));
        if (error <= worst) continue;
        worst = error;
        where = i;
    }
    const Query& q = queries[where % queries.size()];
    EXPECT_LE(worst, allowed) << name << " at (" << q.x << ", " << q.y << ", " << q.z << "), channel "
                              << where / queries.size() << ": " << answers[where] << " instead of " << expected[where];
}

}  // namespace

HardCase::HardCase(const std::string& name, const std::vector<std::string>& assignments, std::size_t light)
    : loader_({folder}) {
    const document::Variant variant = first_variant(name, assignments);
    scenario_ = &loader_.load(variant);
    view_ = rays::make_light_view(scenario_->lights.at(light), scenario_->scene, scenario_->rays.resolution, "/lights");
    layout_ = rays::make_layout(scenario_->scene, view_, scenario_->rays);
    contenders_ = make_contenders(*scenario_, variant);
    ask_for_needs(contenders_, layout_);
    casters_ = std::make_unique<rays::Tracer>(scenario_->scene, true);
    capture_ = std::make_unique<rays::Capture>(scenario_->scene, view_, layout_);
    source_ = std::make_unique<RaySource>(*capture_, layout_, std::size_t{1} << 30, RaySource::Watch());
    build_all(contenders_, *source_, {layout_, view_, casters_.get()}, std::size_t{4} << 30, {});
}

Query HardCase::at(const base::Vec3d& world, float width) const {
    const base::Vec3d place = rays::to_light(view_, world);
    return {static_cast<float>(place.x), static_cast<float>(place.y), static_cast<float>(place.z), width};
}

void HardCase::expect_of_techniques(const Queries& queries, const Answers& expected, double slack) const {
    for (const Contender& contender : contenders_) {
        const std::string name = results::title(contender.cell);
        ASSERT_TRUE(contender.ok()) << name << ": " << contender.cell.reason;
        const std::vector<float> answers = lookup_all(contender.maps, {queries});
        const bool bounded = std::isfinite(contender.cell.error_bound) && !contender.cell.outside_promise;
        if (contender.row->traits.traces)
            compare(name, answers, queries, expected, slack);
        else if (bounded)
            compare(name, answers, queries, expected, contender.cell.error_bound + slack);
        const bool unit_range = techniques::promises(*contender.row, contender.values).unit_range;
        for (const float answer : answers)
            ASSERT_TRUE(unit_range ? answer >= 0.0f && answer <= 1.0f : std::isfinite(answer))
                << name << ": " << answer;
    }
}

void HardCase::expect_of_truth(const Queries& queries, const Answers& expected, double slack) const {
    const Truth truth = reference_visibility(scenario_->scene, view_, reference_settings(*scenario_), queries, {});
    compare("the truth", truth.value, queries, expected, slack);
}

void HardCase::expect(const Queries& queries, const Answers& expected, double slack) const {
    expect_of_techniques(queries, expected, slack);
    expect_of_truth(queries, expected, slack);
}

}  // namespace shadowbench::bench
