#include "claims/salvi_columns.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace shadowbench::claims::salvi {
namespace {

nlohmann::json columns() {
    return nlohmann::json::parse(R"({
        "scene": {"objects": [
            {"type": "smoke_column", "base": [3.0, 0, 1.5], "extinction": 0.01},
            {"type": "smoke_column", "base": [0, 0, 0], "extinction": 0.05},
            {"type": "smoke_column", "base": [-3.0, 0, -1.5], "extinction": 0.1},
            {"type": "hair_ball", "opacity": 0.12},
            {"type": "quad"}]},
        "lights": [{"direction": [-1, -0.2, -0.5]}],
        "receivers": {"type": "camera", "position": [-4.0, 3.0, 11.0], "target": [0, 1.5, 1.0]}})");
}

// The light's line through a foot of the near column must meet the middle one at the same height.
TEST(SalviColumns, AreSeenByTheLightInTheSamePlacesAtAnySpacing) {
    for (const double spacing : {2.5, own_spacing, far_spacing}) {
        const nlohmann::json document = with_spacing(columns(), spacing);
        const nlohmann::json &objects = document["scene"]["objects"], &direction = document["lights"][0]["direction"];
        const double scale = spacing / own_spacing;
        EXPECT_DOUBLE_EQ(objects[0]["base"][0].get<double>(), 3.0 * scale);
        EXPECT_DOUBLE_EQ(objects[2]["base"][2].get<double>(), -1.5 * scale);
        EXPECT_EQ(objects[1]["base"][0], 0);
        const double steps = objects[0]["base"][0].get<double>() / -direction[0].get<double>();
        EXPECT_NEAR(steps * direction[1].get<double>(), -0.6, 1e-12) << "how much lower it is there";
    }
}

TEST(SalviColumns, OnlySmokeBecomesDenserAndOnlyHairMoreOpaque) {
    const nlohmann::json dense = with_density(columns(), 3.0), opaque = with_opacity(columns(), 3.0);
    EXPECT_DOUBLE_EQ(dense["scene"]["objects"][2]["extinction"].get<double>(), 0.1 * 3.0);
    EXPECT_EQ(dense["scene"]["objects"][3], columns()["scene"]["objects"][3]);
    EXPECT_DOUBLE_EQ(opaque["scene"]["objects"][3]["opacity"].get<double>(), 0.12 * 3.0);
    EXPECT_EQ(opaque["scene"]["objects"][0], columns()["scene"]["objects"][0]);
    EXPECT_FALSE(opaque["scene"]["objects"][4].contains("opacity"));
}

TEST(SalviColumns, TheCameraMovesAwayAlongItsView) {
    const nlohmann::json away = with_camera_away(columns(), 2.0)["receivers"];
    EXPECT_EQ(away["target"], columns()["receivers"]["target"]);
    EXPECT_DOUBLE_EQ(away["position"][0].get<double>(), -8.0);
    EXPECT_DOUBLE_EQ(away["position"][1].get<double>(), 4.5);
    EXPECT_DOUBLE_EQ(away["position"][2].get<double>(), 21.0);
}

}  // namespace
}  // namespace shadowbench::claims::salvi
