// Where the water is if a scene does not say it, and that a scene's own words count.
#include <string>

#include <gtest/gtest.h>

#include <spindrift/scene/scene_loader.h>

namespace spindrift::scene {
namespace {

v1::Setting loaded(const std::string& text) {
  const auto scene = parseSceneText(text, "water.textproto");
  EXPECT_TRUE(scene) << scene.error().message;
  return scene ? scene->setting() : v1::SETTING_UNSPECIFIED;
}

#define SIDES_X(kind) "boundary_minus_x: WAVE_BOUNDARY_" kind " boundary_plus_x: WAVE_BOUNDARY_" kind " "
#define SIDES_Z(kind) "boundary_minus_z: WAVE_BOUNDARY_" kind " boundary_plus_z: WAVE_BOUNDARY_" kind " "
#define WALLED "boundary_x: BOUNDARY_WALL boundary_z: BOUNDARY_WALL "

TEST(Setting, OfAWaveFollowsFromItsSides) {
  EXPECT_EQ(loaded("wave { " SIDES_X("ABSORB") SIDES_Z("ABSORB") "}"), v1::SETTING_OPEN_SEA);
  EXPECT_EQ(loaded("wave { boundary_minus_x: WAVE_BOUNDARY_ABSORB boundary_plus_x: WAVE_BOUNDARY_REFLECT " SIDES_Z(
                "REFLECT") "}"),
            v1::SETTING_OPEN_SEA);
  EXPECT_EQ(loaded("wave {}"), v1::SETTING_OPEN_SEA) << "periodic in both directions";
  EXPECT_EQ(loaded("wave { " SIDES_X("REFLECT") "}"), v1::SETTING_FLUME) << "walls at two ends";
  EXPECT_EQ(loaded("wave { side_m: 16 " SIDES_X("REFLECT") SIDES_Z("REFLECT") "}"), v1::SETTING_POOL);
  EXPECT_EQ(loaded("wave { side_m: 3 " SIDES_X("REFLECT") SIDES_Z("REFLECT") "}"), v1::SETTING_GLASS_TANK);
}

TEST(Setting, OfParticlesFollowsFromTheirBox) {
  EXPECT_EQ(loaded("particles { box_side_m: 5 " WALLED "}"), v1::SETTING_GLASS_TANK);
  EXPECT_EQ(loaded("particles { box_side_m: 10 " WALLED "}"), v1::SETTING_POOL);
  EXPECT_EQ(loaded("particles { box_side_m: 4 box_width_m: 0.8 " WALLED "}"), v1::SETTING_FLUME);
  EXPECT_EQ(loaded("particles { box_side_m: 8 box_width_m: 4.5 boundary_x: BOUNDARY_WALL }"), v1::SETTING_FLUME)
      << "walls at two ends";
}

TEST(Setting, ThatTheSceneNamesCounts) {
  EXPECT_EQ(loaded("wave {} setting: SETTING_POOL"), v1::SETTING_POOL);
  EXPECT_EQ(loaded("particles {} setting: SETTING_GLASS_TANK"), v1::SETTING_GLASS_TANK);
}

v1::WaterType waterTypeOf(const std::string& text) {
  const auto scene = parseSceneText(text, "water.textproto");
  EXPECT_TRUE(scene) << scene.error().message;
  return scene ? scene->water_type() : v1::WATER_TYPE_UNSPECIFIED;
}

TEST(WaterType, FollowsFromWhatIsAroundTheWater) {
  const std::string sea = "wave { " SIDES_X("ABSORB") SIDES_Z("ABSORB") "} ";
  EXPECT_EQ(waterTypeOf(sea), v1::WATER_TYPE_OCEAN);
  EXPECT_EQ(waterTypeOf(sea + "obstacles { rock { radius_m: 1 height_m: 1 } }"), v1::WATER_TYPE_COAST);
  EXPECT_EQ(waterTypeOf(sea + "bed { shapes { slope { gradient_ratio: 0.01 } } }"), v1::WATER_TYPE_COAST);
  EXPECT_EQ(waterTypeOf("particles {}"), v1::WATER_TYPE_POOL);
}

TEST(WaterType, ThatTheSceneNamesCounts) {
  EXPECT_EQ(waterTypeOf("wave {} water_type: WATER_TYPE_HARBOR"), v1::WATER_TYPE_HARBOR);
}

TEST(FirstView, HasDefaultsAndBounds) {
  const auto scene = parseSceneText("wave {} first_view { x_m: 2 }", "water.textproto");
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->first_view().heading_deg(), -90);
  EXPECT_EQ(scene->first_view().pitch_deg(), 22);
  EXPECT_EQ(scene->first_view().hour(), 12);
  EXPECT_FALSE(parseSceneText("wave {} first_view { pitch_deg: 90 }", "water.textproto"));
  EXPECT_FALSE(parseSceneText("wave {} first_view { hour: 24.5 }", "water.textproto"));
}

// The documents and `spindrift check` name settings in words; a new one needs a name.
TEST(Setting, HasAName) {
  const auto* type = v1::Setting_descriptor();
  for (int i = 0; i < type->value_count(); ++i) {
    const auto setting = static_cast<v1::Setting>(type->value(i)->number());
    if (setting == v1::SETTING_UNSPECIFIED) continue;
    EXPECT_NE(settingName(setting), "unknown") << type->value(i)->name();
  }
}

}  // namespace
}  // namespace spindrift::scene
