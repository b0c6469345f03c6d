// Changes that must not matter: the unit of depth, the order of hits at one depth, the order of a pixel's rays.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "techniques/any_rays.h"
#include "techniques/trades.h"
#include "techniques/variants.h"

namespace shadowbench::techniques {
namespace {

using testing::HandMap;
using testing::HandRays;
using testing::Segment;
using testing::Segments;

class Invariance : public ::testing::TestWithParam<const Technique*> {
protected:
    const Technique& row() const { return *GetParam(); }
};

// Anywhere in the map, with narrow and wide filters, at each depth.
std::vector<Query> any_queries(const HandRays& given) {
    const std::vector<float> depths = testing::telling_depths(given);
    const auto seed = static_cast<std::uint64_t>(*rc::gen::inRange(0, 1000));
    std::vector<Query> queries;
    for (std::size_t i = 0; i < depths.size(); ++i) {
        base::Random random(base::hash(seed, i));
        queries.push_back({static_cast<float>(random.uniform(0, given.width)),
                           static_cast<float>(random.uniform(0, given.height)), depths[i],
                           static_cast<float>(random.uniform(0, 3))});
    }
    return queries;
}

// Drops segments that would take a ray below 1e-20 without being opaque.
void keep_above_faint(Segments& ray) {
    float through = 1.0f;
    std::erase_if(ray, [&](const Segment& s) {
        if (s.through > 0.0f && through * s.through < 1e-20f) return true;
        through *= s.through > 0.0f ? s.through : 1.0f;
        return false;
    });
}

// Multiplying every depth by a power of two changes no digit except of depths, if neither they nor their products with
// values are denormal: light below 1e-28 behind opaque media may differ in digits that it does not have. This does not
// hold for rows that draw their samples by the digits of a query's depth, nor for a bias, which is a length too.
TEST_P(Invariance, TheUnitOfDepthChangesNothing) {
    if (row().traits.draws_samples || row().traits.traces) return;
    std::vector<ParameterValues> settings = testing::variants(row());
    for (ParameterValues& values : settings) values = testing::unbiased(row(), values);
    rc::detail::checkGTest([&] {
        HandRays given = *testing::any_rays({.hostile = false});
        for (Segments& ray : given.rays) keep_above_faint(ray);
        const float scale = std::ldexp(1.0f, *rc::gen::inRange(-30, 31));
        const ParameterValues& values = settings[*rc::gen::inRange<std::size_t>(0, settings.size())];
        RC_LOG() << testing::text_of(row(), values) << " scaled by " << scale << '\n';
        // On its way to a denormal, an exponential has no more digits than the denormal.
        if (values.values.count("sampling") && values.word("sampling") == "exponential")
            for (Segments& ray : given.rays)
                std::erase_if(ray, [](const Segment& s) { return s.through == 0.0f && s.front < s.back; });
        HandRays scaled = given;
        for (Segments& ray : scaled.rays)
            for (Segment& s : ray) s = {s.front * scale, s.back * scale, s.through};
        rays::MapLayout layout = layout_of(given), scaled_layout = layout;
        scaled_layout.z_min *= scale;
        scaled_layout.z_max *= scale;
        const HandMap one = testing::make_map(row(), values, light_rays(given), layout);
        const HandMap two = testing::make_map(row(), values, light_rays(scaled), scaled_layout);
        std::vector<Query> queries = any_queries(given);
        const std::vector<float> answers = one.lookup(queries);
        for (Query& q : queries) q.z *= scale;
        const std::vector<float> scaled_answers = two.lookup(queries);
        RC_ASSERT(scaled_answers.size() == answers.size());
        for (std::size_t i = 0; i < answers.size(); ++i)
            RC_ASSERT(scaled_answers[i] == answers[i] || std::max(scaled_answers[i], answers[i]) < 1e-28f);
        RC_ASSERT(two.map->bytes() == one.map->bytes());
    });
}

// Whether two maps give the same answers up to some slack.
void check_alike(const HandMap& one, const HandMap& two, const std::vector<Query>& queries, double slack) {
    const std::vector<float> a = one.lookup(queries), b = two.lookup(queries);
    for (std::size_t i = 0; i < a.size(); ++i) {
        const Query& q = queries[i % queries.size()];
        if (!(std::abs(a[i] - b[i]) <= slack)) RC_LOG() << q.x << ' ' << q.y << ' ' << q.z << ' ' << q.width << '\n';
        RC_ASSERT(std::abs(a[i] - b[i]) <= slack);
    }
}

template <class Value>
void shuffle(std::vector<Value>& values, base::Random& random) {
    for (std::size_t k = values.size(); k > 1; --k) std::swap(values[k - 1], values[random.below(k)]);
}

// With room for all segments of a ray, if the row names such settings: a technique that drops nodes, hit after hit,
// depends on the order of the hits.
std::vector<ParameterValues> roomy(const Technique& row) {
    std::vector<ParameterValues> found;
    for (const ParameterValues& values : testing::variants(row)) found.push_back(with(values, row.traits.order_free));
    return found;
}

constexpr double rounding = 1e-6;

// A search builds one map for all values of the trades that only change lookups.
TEST_P(Invariance, LookupsThatAreSetLaterAnswerAsThoseOfAMapBuiltForThem) {
    if (row().traits.traces) return;
    std::vector<ParameterValues> settings{read_parameters(row().parameters, nlohmann::json::object(), "")};
    for (const Trade& trade : row().traits.trades) {
        std::vector<ParameterValues> more;
        const std::vector<ParameterValues::Value> values = values_of(trade, row().parameters);
        for (const ParameterValues& before : settings)
            for (std::size_t i = 0; i < values.size(); i += trade.only_lookups ? std::max<std::size_t>(values.size() / 3, 1) : values.size())
                more.push_back(with(before, std::vector<ParameterSetting>{{trade.parameter, values[i]}}));
        settings = std::move(more);
    }
    rc::detail::checkGTest([&] {
        const HandRays given = testing::rays_of(3, 2, 2, *testing::any_draws(), {.hostile = false});
        const std::vector<Query> queries = any_queries(given);
        const ParameterValues& first = settings[*rc::gen::inRange<std::size_t>(0, settings.size())];
        const ParameterValues& second = settings[*rc::gen::inRange<std::size_t>(0, settings.size())];
        RC_LOG() << testing::text_of(row(), first) << ", then " << testing::text_of(row(), second) << '\n';
        const HandMap one = make_map(row(), first, given), two = make_map(row(), second, given);
        RC_ASSERT(one.map->bytes() == two.map->bytes());
        one.map->set_lookups(second);
        RC_ASSERT(one.lookup(queries) == two.lookup(queries));
    });
}

// A search measures the errors of one layout only.
TEST_P(Invariance, LayoutsOfOneMapAnswerTheSame) {
    if (row().traits.traces) return;
    const ParameterValues usual = read_parameters(row().parameters, nlohmann::json::object(), "");
    for (const Trade& trade : row().traits.trades) {
        if (!trade.only_layout) continue;
        const std::vector<ParameterValues::Value> values = values_of(trade, row().parameters);
        rc::detail::checkGTest([&] {
            const HandRays given = testing::rays_of(3, 2, 2, *testing::any_draws(), {.hostile = false});
            const std::vector<Query> queries = any_queries(given);
            const auto answers = [&](const ParameterValues::Value& value) {
                return make_map(row(), with(usual, std::vector<ParameterSetting>{{trade.parameter, value}}), given)
                    .lookup(queries);
            };
            for (std::size_t i = 1; i < values.size(); ++i) RC_ASSERT(answers(values[i]) == answers(values[0]));
        });
    }
}

// The contract leaves the order of hits that begin and end at one depth open.
TEST_P(Invariance, TheOrderOfHitsAtOneDepthChangesNothing) {
    if (row().traits.traces) return;
    const std::vector<ParameterValues> settings = roomy(row());
    rc::detail::checkGTest([&] {
        const auto draws = *testing::any_draws();
        std::vector<testing::Draw> few(draws.begin(), draws.begin() + std::min<std::ptrdiff_t>(draws.size(), 12));
        for (testing::Draw& draw : few) std::get<1>(draw) %= 2, std::get<2>(draw) %= 2;  // two depths, two lengths
        HandRays given = testing::rays_of(2, 1, 1, few, {.hostile = false});
        const ParameterValues& values = settings[*rc::gen::inRange<std::size_t>(0, settings.size())];
        RC_LOG() << testing::text_of(row(), values) << '\n' << given << '\n';
        const std::vector<Query> queries = any_queries(given);
        const HandMap one = make_map(row(), values, given);
        base::Random random(static_cast<std::uint64_t>(*rc::gen::inRange(0, 1000)));
        for (Segments& ray : given.rays) shuffle(ray, random);
        const double slack = rounding + 2.0 * row().traits.segment_rounding * static_cast<double>(few.size());
        check_alike(one, make_map(row(), values, given), queries, slack);
    });
}

// Over whole pixels, in which every ray has the same weight.
TEST_P(Invariance, TheOrderOfTheRaysOfAPixelChangesNoMean) {
    if (!row().traits.filters || row().traits.traces) return;
    std::vector<ParameterValues> settings = roomy(row());
    for (ParameterValues& values : settings) values = with(values, row().traits.whole_pixel);
    rc::detail::checkGTest([&] {
        const bool media = *rc::gen::arbitrary<bool>();
        HandRays given = *testing::any_rays({.media = media, .hostile = false});
        const ParameterValues& values = settings[*rc::gen::inRange<std::size_t>(0, settings.size())];
        RC_LOG() << testing::text_of(row(), values) << '\n';
        std::vector<Query> queries;
        for (const float z : testing::telling_depths(given))
            queries.push_back({0.5f + static_cast<float>(*rc::gen::inRange(0, given.width)), 0.5f, z, 1.0f});
        const HandMap one = make_map(row(), values, given);
        base::Random random(static_cast<std::uint64_t>(*rc::gen::inRange(0, 1000)));
        const auto samples = static_cast<std::size_t>(given.samples);
        for (std::size_t first = 0; first < given.rays.size(); first += samples) {
            std::vector<Segments> pixel(given.rays.begin() + first, given.rays.begin() + first + samples);
            shuffle(pixel, random);
            std::copy(pixel.begin(), pixel.end(), given.rays.begin() + first);
        }
        // Another order rounds sums of media differently, and bounded compression may then choose another function
        // within its bound.
        const double bound = row().error_bound(values, one.layout);
        const bool compresses = media && std::isfinite(bound) && bound > rounding;
        check_alike(one, make_map(row(), values, given), queries, compresses ? 2.0 * bound + rounding : rounding);
    });
}

INSTANTIATE_TEST_SUITE_P(Registry, Invariance, ::testing::ValuesIn(testing::rows()), testing::name_of_row);

}  // namespace
}  // namespace shadowbench::techniques
