#include "recommend/space.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include <nlohmann/json.hpp>

#include "base/error.h"

namespace shadowbench::recommend {
namespace {

scene::Scenario with_resolution(int x, int y) {
    scene::Scenario scenario;
    scenario.rays.resolution = {x, y};
    return scenario;
}

std::size_t family_named(const Space& space, const std::string& name) {
    for (std::size_t i = 0; i < space.families().size(); ++i)
        if (space.families()[i].name == name) return i;
    ADD_FAILURE() << "no family " << name;
    return 0;
}

Point first(const Space& space, std::size_t family) {
    return {family, std::vector<int>(space.families()[family].axes.size(), 0)};
}

TEST(Space, HasResolutionsOfTheScenariosRatioWithItsOwnAmongTheCoarseOnes) {
    for (const auto& [x, y] :
         {std::pair(128, 128), {300, 300}, {640, 480}, {480, 640}, {1024, 64}, {640, 427}, {8, 8}}) {
        SCOPED_TRACE(testing::Message() << x << " x " << y);
        const Space space(with_resolution(x, y), {});
        Point point = first(space, family_named(space, "variance filter=footprint"));
        const Axis& axis = space.families()[point.family].axes[0];
        double before = 0.0;
        bool own = false;
        for (int i = 0; i < axis.steps(); ++i) {
            point.step[0] = i;
            const base::Vec2i sides = space.resolution(point);
            EXPECT_EQ(static_cast<long>(sides.x) * y, static_cast<long>(sides.y) * x);
            EXPECT_GT(sides.x, before);
            EXPECT_LE(std::max(sides.x, sides.y), 4096);
            before = sides.x;
            own = own || (i % axis.stride == 0 && sides == base::Vec2i(x, y));
        }
        EXPECT_TRUE(own);
    }
}

TEST(Space, OfSquareMapsHasEightResolutionsAnOctaveFrom16To4096) {
    const Space space(with_resolution(256, 256), {});
    const Axis& axis = space.families()[0].axes[0];
    EXPECT_EQ(axis.stride, 8);
    EXPECT_EQ(axis.steps(), 65);
    EXPECT_EQ(axis.values.front(), "16");
    EXPECT_EQ(axis.values.back(), "4096");
}

TEST(Space, HasAFamilyForEachCombinationOfWords) {
    const Space space(with_resolution(64, 64), std::vector<std::string>{"deep"});
    std::set<std::string> names;
    for (const Family& family : space.families()) names.insert(family.name);
    EXPECT_EQ(names, (std::set<std::string>{"deep kernel=box mip=none", "deep kernel=box mip=nearest",
                                            "deep kernel=box mip=blend", "deep kernel=tent mip=none",
                                            "deep kernel=tent mip=nearest", "deep kernel=tent mip=blend"}));
}

TEST(Space, GivesTheSettingOfAPoint) {
    const Space space(with_resolution(64, 64), {});
    Point point = first(space, family_named(space, "deep kernel=tent mip=none"));
    point.step = {8, 2, 0};
    const Setting setting = space.setting(point);
    EXPECT_EQ(setting.row->id, std::string("deep"));
    EXPECT_EQ(setting.resolution, base::Vec2i(32, 32));
    EXPECT_EQ(setting.samples, 9);
    EXPECT_EQ(setting.values.number("tolerance"), 0.2);
    EXPECT_EQ(setting.values.word("kernel"), "tent");
    EXPECT_EQ(setting.values.word("filter"), "box");  // not traded: its default
}

TEST(Space, KnowsTheFamilyThatLosesNothingOfItsRays) {
    const Space space(with_resolution(64, 64), {});
    ASSERT_TRUE(space.scout());
    EXPECT_EQ(space.families()[*space.scout()].name, "uncompressed filter=footprint");
    EXPECT_FALSE(Space(with_resolution(64, 64), std::vector<std::string>{"pcf"}).scout());
}

TEST(Space, OfWhatNeedsNoRaysHasOneStepOfThem) {
    const Space space(with_resolution(64, 32), {});
    const Point point = first(space, family_named(space, "ray_traced"));
    EXPECT_FALSE(space.uses_rays(point.family));
    EXPECT_EQ(space.families()[point.family].axes[0].values, std::vector<std::string>{"[64,32]"});
    EXPECT_EQ(space.families()[point.family].axes[1].steps(), 1);
    EXPECT_EQ(space.resolution(point), base::Vec2i(64, 32));
}

TEST(Space, OfADeepImageHasItsOwnRaysOnly) {
    scene::Scenario scenario = with_resolution(30, 20);
    scenario.rays.samples_per_pixel = 1;
    scenario.scene.deep_image.emplace();
    const Space space(scenario, {});
    for (const Family& family : space.families()) {
        EXPECT_EQ(family.axes[0].values, std::vector<std::string>{"[30,20]"});
        EXPECT_EQ(family.axes[1].steps(), 1);
        EXPECT_NE(family.technique, "ray_traced");
    }
}

TEST(Space, TakesASettingThatIsNotOnItsAxes) {
    Space space(with_resolution(64, 32), std::vector<std::string>{"pcf"});
    const Point point = space.add(nlohmann::json::parse(
        R"({"rays": {"resolution": [70, 35], "samples_per_pixel": 7}, "techniques": [{"type": "deep", "radius": 1.5}]})"));
    const Setting setting = space.setting(point);
    EXPECT_EQ(setting.row->id, std::string("deep"));
    EXPECT_EQ(setting.values.number("radius"), 1.5);
    EXPECT_TRUE(setting.values.is_word("tolerance"));  // the default
    EXPECT_EQ(setting.resolution, base::Vec2i(70, 35));
    EXPECT_EQ(setting.samples, 7);
    EXPECT_EQ(space.resolution(point), setting.resolution);
    const Setting own = space.setting(space.add(nlohmann::json::parse(R"({"techniques": [{"type": "variance"}]})")));
    EXPECT_EQ(own.resolution, base::Vec2i(64, 32));
    EXPECT_EQ(own.samples, scene::Scenario().rays.samples_per_pixel);
}

TEST(Space, RefusesASettingThatFramesAnotherPartOfThePlane) {
    Space space(with_resolution(64, 32), {});
    const auto part = [](const char* rays, const char* technique) {
        return nlohmann::json{{"rays", nlohmann::json::parse(rays)}, {"techniques", {nlohmann::json::parse(technique)}}};
    };
    EXPECT_THROW(space.add(part(R"({"resolution": 64})", R"({"type": "variance"})")), base::Error);
    EXPECT_THROW(space.add(part(R"({})", R"({"type": "variance", "depth": 1})")), base::Error);
    EXPECT_THROW(space.add(part(R"({})", R"({"type": "varience"})")), base::Error);
}

TEST(Space, RefusesATechniqueThatDoesNotExist) {
    EXPECT_THROW(Space(with_resolution(64, 64), std::vector<std::string>{"depp"}), base::Error);
}

// Otherwise the search would find out the error of each layout anew.
TEST(Space, KnowsWhichFamiliesLayOutTheSameMap) {
    const Space space(with_resolution(64, 64), std::vector<std::string>{"pcf", "deep"});
    const auto named = [&](const std::string& name) -> const Family& { return space.families()[family_named(space, name)]; };
    for (const std::string factor : {"1", "3"}) {
        const std::string words = "pcf res_factor=" + factor + " storage=";
        EXPECT_FALSE(named(words + "raw").answers_as);
        for (const char* layout : {"bounding_box", "tiles"})
            EXPECT_EQ(named(words + layout).answers_as, family_named(space, words + "raw"));
    }
    EXPECT_FALSE(named("deep kernel=tent mip=none").answers_as) << "another kernel answers otherwise";
}

}  // namespace
}  // namespace shadowbench::recommend
