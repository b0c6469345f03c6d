// A lookup of one cell answers with the function that the map says it stores, for random rays.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <fmt/format.h>

#include "curves/cases.h"
#include "curves/norms.h"
#include "techniques/any_rays.h"
#include "techniques/variants.h"

namespace shadowbench::techniques {
namespace {

using testing::HandMap;
using testing::HandRays;

std::vector<ParameterValues> pointwise(const Technique& row) {
    std::vector<ParameterValues> found = testing::variants(row);
    for (ParameterValues& values : found) values = testing::pointwise(row, values);
    return found;
}

// The middle of a cell.
Query middle(const rays::MapLayout& layout, Cells cells, int x, int y) {
    const auto nx = static_cast<float>(cells == Cells::sample ? layout.samples_x : 1);
    const auto ny = static_cast<float>(cells == Cells::sample ? layout.samples_y : 1);
    return {(static_cast<float>(x) + 0.5f) / nx, (static_cast<float>(y) + 0.5f) / ny, 0.0f, 0.0f};
}

// At depths on both sides of every step, in every channel; `slack` is for means that are computed otherwise.
void check_cell(const HandMap& built, const std::vector<float>& depths, int x, int y, float slack) {
    std::vector<Query> queries(depths.size(), middle(built.layout, built.map->cells(), x, y));
    for (std::size_t i = 0; i < depths.size(); ++i) queries[i].z = depths[i];
    const std::vector<float> answers = built.lookup(queries);
    curves::Curve stored;
    for (int c = 0; c < built.map->channels(); ++c) {
        built.map->stored(x, y, c, depths, stored);
        for (std::size_t i = 0; i < depths.size(); ++i) {
            const float answer = answers[static_cast<std::size_t>(c) * depths.size() + i];
            const float value = curves::evaluate(stored, depths[i]);
            if (answer != value) RC_LOG() << "at depth " << depths[i] << " of channel " << c << '\n';
            RC_ASSERT(std::abs(answer - value) <= slack);
        }
    }
}

class LookupProperties : public ::testing::TestWithParam<const Technique*> {
protected:
    const Technique& row() const { return *GetParam(); }
    float slack() const { return static_cast<float>(row().traits.lookup_rounding); }
};

TEST_P(LookupProperties, AnswerAsTheStoredFunction) {
    if (row().traits.traces) return;  // stores none
    const std::vector<ParameterValues> settings = pointwise(row());
    rc::detail::checkGTest([&] {
        HandRays given = *testing::any_rays();
        given.coloured = row().coloured && *rc::gen::arbitrary<bool>();
        const ParameterValues& values = settings[*rc::gen::inRange<std::size_t>(0, settings.size())];
        RC_LOG() << testing::text_of(row(), values) << '\n';
        const rays::MapLayout exact = testing::layout_of(given);
        const HandMap built = testing::make_map(row(), values, testing::light_rays(given),
                                                *rc::gen::arbitrary<bool>() ? exact : testing::outward(exact));
        const bool samples = built.map->cells() == Cells::sample;
        const int x = *rc::gen::inRange(0, exact.width * (samples ? exact.samples_x : 1));
        const int y = *rc::gen::inRange(0, exact.height * (samples ? exact.samples_y : 1));
        check_cell(built, testing::telling_depths(given), x, y, slack());
    });
}

TEST_P(LookupProperties, AnswerAsTheStoredFunctionOfGivenFunctions) {
    if (!row().from_curves) return;
    const std::vector<ParameterValues> settings = pointwise(row());
    rc::detail::checkGTest([&] {
        std::vector<curves::Curve> functions{*curves::cases::any_function()};
        if (*rc::gen::arbitrary<bool>()) functions.push_back(*curves::cases::any_function());
        const ParameterValues& values = settings[*rc::gen::inRange<std::size_t>(0, settings.size())];
        RC_LOG() << testing::text_of(row(), values) << '\n';
        HandMap built;
        built.map = row().from_curves(values, functions);
        built.layout.width = static_cast<int>(functions.size());
        std::vector<float> depths;
        for (const curves::Curve& function : functions)
            for (const curves::Vertex& v : function)
                depths.insert(depths.end(), {std::nextafter(v.z, -INFINITY), v.z, std::nextafter(v.z, INFINITY)});
        std::sort(depths.begin(), depths.end());
        curves::Curve stored;
        for (int f = 0; f < built.layout.width; ++f) {
            check_cell(built, depths, f, 0, 0.0f);
            built.map->stored(f, 0, 0, depths, stored);
            RC_ASSERT(curves::is_visibility(stored) || !promises(row(), values).monotone);
            const double bound = row().error_bound(values, built.layout);
            RC_ASSERT(curves::distance(stored, functions[static_cast<std::size_t>(f)], 0, 1).max <= bound + 1e-6);
        }
    });
}

// Whatever the filters and the rays are, near the map and far from it.
TEST_P(LookupProperties, AnswersStayInTheirRange) {
    if (row().traits.traces) return;  // sees a scene, not these rays
    const std::vector<ParameterValues> settings = testing::variants(row());
    rc::detail::checkGTest([&] {
        HandRays given = *testing::any_rays();
        given.coloured = row().coloured && *rc::gen::arbitrary<bool>();
        const ParameterValues& values = settings[*rc::gen::inRange<std::size_t>(0, settings.size())];
        RC_LOG() << testing::text_of(row(), values) << '\n';
        const HandMap built = testing::make_map(row(), values, given);
        const std::vector<float> depths = testing::telling_depths(given);
        const float side = static_cast<float>(std::max(given.width, given.height));
        std::vector<Query> queries;
        base::Random random(static_cast<std::uint64_t>(*rc::gen::inRange(0, 1000)));
        for (const float z : depths)
            queries.push_back({static_cast<float>(random.uniform(-0.1, 1) * side),
                               static_cast<float>(random.uniform(-0.1, 1) * side), z,
                               static_cast<float>(std::exp2(random.uniform(-10, 10)))});
        const Promises promised = promises(row(), values);
        const double least = testing::least_answer(row(), values, built.layout);
        const std::vector<float> answers = built.lookup(queries);
        for (std::size_t i = 0; i < answers.size(); ++i) {
            const Query& q = queries[i];
            const float answer = answers[i];
            if (std::isfinite(answer) && answer >= least && (answer <= 1.0f || !promised.unit_range)) continue;
            RC_FAIL(fmt::format("{} at ({}, {}), depth {}, width {}", answer, q.x, q.y, q.z, q.width));
        }
        curves::Curve stored;
        built.map->stored(0, 0, 0, depths, stored);
        for (const curves::Vertex& v : stored) RC_LOG() << "stored " << v.z << ' ' << v.value << '\n';
        RC_ASSERT(curves::is_visibility(stored) || !promised.monotone);
    });
}

INSTANTIATE_TEST_SUITE_P(Registry, LookupProperties, ::testing::ValuesIn(testing::rows()), testing::name_of_row);

}  // namespace
}  // namespace shadowbench::techniques
