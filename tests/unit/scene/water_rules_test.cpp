// Rules between the water and the obstacles, boats and floaters in it, each broken once.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/scene/scene_loader.h>

namespace spindrift::scene {
namespace {

using testing::HasSubstr;

struct BrokenRule {
  const char* name;
  const char* text;
  std::vector<const char*> must_hold;  ///< all in the one error line
};

class OneBrokenRule : public testing::TestWithParam<BrokenRule> {};

TEST_P(OneBrokenRule, IsNamedWithFieldValueBoundAndRemedy) {
  const auto scene = parseSceneText(GetParam().text, "pool.textproto");
  ASSERT_FALSE(scene);
  const std::string& message = scene.error().message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  for (const char* part : GetParam().must_hold) EXPECT_THAT(message, HasSubstr(part));
}

#define WALLS_X "boundary_minus_x: WAVE_BOUNDARY_REFLECT boundary_plus_x: WAVE_BOUNDARY_REFLECT "

const BrokenRule kBrokenRules[] = {
    {"PeriodicAlone",
     "wave { boundary_minus_x: WAVE_BOUNDARY_ABSORB }",
     {"wave.boundary_minus_x: WAVE_BOUNDARY_ABSORB", "boundary_plus_x", "both"}},
    {"PeriodicAloneZ",
     "wave { boundary_plus_z: WAVE_BOUNDARY_REFLECT }",
     {"wave.boundary_plus_z: WAVE_BOUNDARY_REFLECT", "boundary_minus_z"}},
    {"SpongeTooWide",
     "wave { side_m: 6 boundary_minus_x: WAVE_BOUNDARY_ABSORB boundary_plus_x: WAVE_BOUNDARY_ABSORB }",
     {"wave.sponge_width_m: 4 m", "half the side", "at most 3 m"}},
    {"ObstaclesWithoutWave",
     "particles {}\nobstacles { rock {} }",
     {"obstacles[0]: needs a wave", "remove the obstacles"}},
    {"BeachesWithoutWave", "particles {}\nbeaches {}", {"beaches[0]: needs a wave"}},
    {"BoatTooLongForTheBoxOfParticles",
     "particles { box_side_m: 4 }\nboats { boats { length_m: 1.2 beam_m: 0.4 height_m: 0.1 } }",
     {"boats.boats[0].length_m: 1.2 m", "quarter"}},
    {"StormWithoutWave", "particles {}\nstorm {}", {"storm: needs a wave"}},
    {"OpenSeaOfParticles",
     "particles {}\nsetting: SETTING_OPEN_SEA",
     {"pool.textproto:2:", "setting: SETTING_OPEN_SEA needs a wave", "SETTING_POOL"}},
    {"ObstacleWithoutShape", "wave {}\nobstacles {}", {"obstacles[0]: has no shape", "rock {}"}},
    {"RockOverTheEdge",
     "wave { side_m: 8 }\nobstacles { rock { x_m: 3.5 } }",
     {"obstacles[0].rock.x_m: 3.5 m", "edge", "-3 to 3 m"}},
    {"RockWiderThanTheWater",
     "wave { side_m: 8 }\nobstacles { rock { radius_m: 5 } }",
     {"obstacles[0].rock.radius_m: 5 m", "half the side", "at most 4 m"}},
    {"BreakwaterOverTheEdge",
     "wave { side_m: 20 }\nobstacles { breakwater { z_m: 7 heading_deg: 90 } }",
     {"obstacles[0].breakwater.z_m: 7 m", "-6 to 6 m"}},
    {"BeachOnAPeriodicSide", "wave {}\nbeaches { side: SIDE_MINUS_Z }", {"beaches[0].side: SIDE_MINUS_Z", "periodic"}},
    {"BeachInADirection", "wave {}\nbeaches { side: SIDE_DIRECTION }", {"beaches[0].side: SIDE_DIRECTION", "waves"}},
    {"BeachTwice", "wave { " WALLS_X "}\nbeaches {}\nbeaches {}", {"beaches[1].side: SIDE_PLUS_X", "beaches[0]"}},
    {"BeachWiderThanTheWater", "wave { side_m: 5 " WALLS_X "}\nbeaches {}", {"beaches[0].width_m: 6 m", "at most 5 m"}},
    {"ShoreDeeperThanTheWater",
     "wave { depth_m: 1 " WALLS_X "}\nbeaches { shore_depth_m: 1.5 }",
     {"beaches[0].shore_depth_m: 1.5 m", "at most 1 m"}},
    {"BoatTooLong",
     "wave { side_m: 8 }\nboats { boats { } }",
     {"boats.boats[0].length_m: 2.4 m", "quarter", "at most 2 m"}},
    {"BoatWiderThanLong",
     "wave {}\nboats { boats { length_m: 1 beam_m: 1.5 } }",
     {"boats.boats[0].beam_m: 1.5 m", "at most 1 m"}},
    {"BoatTooDeep",
     "wave { depth_m: 0.5 }\nboats { boats { height_m: 1.5 } }",
     {"boats.boats[0].height_m: 1.5 m", "0.6 m", "0.5 m deep", "less than 1.25 m"}},
    {"BoatOverTheEdge", "wave {}\nboats { boats { x_m: -11.5 } }", {"boats.boats[0].x_m: -11.5 m", "-10.8 to 10.8 m"}},
    {"BoatOnARock",
     "wave {}\nobstacles { rock { z_m: 1.4 } }\nboats { boats {} }",
     {"boats.boats[0].x_m: 0 m, z 0 m", "obstacles[0]"}},
    {"BoatInABreakwater",
     "wave {}\nobstacles { breakwater { heading_deg: 30 } }\nboats { boats { x_m: 2 z_m: 1 } }",
     {"boats.boats[0].x_m: 2 m, z 1 m", "obstacles[0]"}},
    {"BoatsOverlap",
     "wave {}\nboats { boats {} boats { x_m: 1.5 heading_deg: 90 } }",
     {"boats.boats[1].x_m: 1.5 m", "boats.boats[0]"}},
    {"TooManyBoats",
     "wave {}\nboats { capacity_count: 1 boats {} boats { z_m: 3 } }",
     {"boats.boats[1]: 2 boats", "capacity_count of 1"}},
    {"FloatersWithoutWave", "particles {}\nfloaters {}", {"floaters: needs a wave", "remove floaters"}},
    {"FloaterTooBig",
     "wave { side_m: 8 width_m: 4 }\nfloaters { floaters { size_m: 1.5 } }",
     {"floaters.floaters[0].size_m: 1.5 m", "quarter", "shorter side of 4 m", "at most 1 m"}},
    {"FloaterTooHigh",
     "wave {}\nfloaters { floaters {} floaters { y_m: 21 } }",
     {"floaters.floaters[1].y_m: 21 m", "too high", "at most 20 m"}},
    {"FloaterBelowTheBed",
     "wave { depth_m: 1 }\nfloaters { floaters { y_m: -1.5 } }",
     {"floaters.floaters[0].y_m: -1.5 m", "below the bed", "at least -1 m"}},
    {"FloaterOverTheEdge",
     "wave { side_m: 10 }\nfloaters { floaters { z_m: 4.8 } }",
     {"floaters.floaters[0].z_m: 4.8 m", "-4.7 to 4.7 m"}},
    {"FloaterInARock",
     "wave {}\nobstacles { rock { z_m: 1.2 } }\nfloaters { floaters {} }",
     {"floaters.floaters[0].x_m: 0 m, z 0 m", "obstacles[0]"}},
    {"FloaterInABreakwater",
     "wave {}\nobstacles { breakwater { heading_deg: 30 } }\nfloaters { floaters { x_m: 2 z_m: 1 } }",
     {"floaters.floaters[0].x_m: 2 m, z 1 m", "obstacles[0]"}},
    {"FloaterTooFast",
     "wave {}\nfloaters { floaters { velocity_x_mps: -21 } }",
     {"floaters.floaters[0].velocity_x_mps: -21 m/s"}},
    {"TooManyFloaters",
     "wave {}\nfloaters { capacity_count: 1 floaters {} floaters { z_m: 3 } }",
     {"floaters.floaters[1]: 2 objects", "capacity_count of 1"}},
    {"FoamOfNothing", "wave {}\nfoam {}", {"foam: needs particles", "surface: true", "remove foam"}},
    {"SurfaceFoamWithoutWave", "particles {}\nfoam { surface: true }", {"foam.surface: needs a wave"}},
    {"FollowsNoBoat",
     "wave {}\nparticles {}\ncoupling { patch_follow: PATCH_FOLLOW_BOAT }",
     {"coupling.patch_follow: PATCH_FOLLOW_BOAT needs boats"}},
    {"TwoWayWithoutParticles", "wave {}\ncoupling { mode: COUPLING_MODE_TWO_WAY }", {"coupling: needs particles"}},
    {"BoatSpeedOutOfRange", "wave {}\nboats { boats { max_speed_mps: 31 } }", {"boats.boats[0].max_speed_mps: 31 m/s"}},
    {"RestartTooSoon", "wave {}\nrestart_after_s: 0.5", {"restart_after_s: 0.5 s", "choose 0 (never) or at least 1 s"}},
    {"RestartOutOfRange", "wave {}\nrestart_after_s: 3601", {"restart_after_s: 3601 s", "3600"}},
    {"StormOutOfRange", "wave {}\nstorm { level_ratio: 1.5 }", {"storm.level_ratio: 1.5", "maximum of 1"}},
    {"UnknownShape",
     "wave {}\nevents { effect { breaking_wave { shape: 9 } } }",
     {"events[0].effect.breaking_wave.shape: 9", "1 to 2"}},
};

INSTANTIATE_TEST_SUITE_P(WaterRules, OneBrokenRule, testing::ValuesIn(kBrokenRules),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

TEST(WaterRules, AcceptASceneWithEveryPart) {
  const auto scene = parseSceneText(
      "wave { side_m: 40 depth_m: 2 boundary_minus_x: WAVE_BOUNDARY_ABSORB boundary_plus_x: WAVE_BOUNDARY_REFLECT\n"
      "       sponge_width_m: 20 }\n"
      "particles { patch_scale: 0.25 }\n"
      "coupling { mode: COUPLING_MODE_TWO_WAY patch_follow: PATCH_FOLLOW_BOAT }\n"
      "foam { surface: true }\n"
      "obstacles { rock { x_m: 19 } }\n"
      "obstacles { breakwater { x_m: -16 z_m: 10 } }\n"
      "beaches { width_m: 40 shore_depth_m: 2 }\n"
      "boats { capacity_count: 3 boats { x_m: 5 } boats { x_m: 5 z_m: 1 } boats { x_m: 8 length_m: 3 } }\n"
      "floaters { floaters { x_m: -8 } floaters { x_m: -8 y_m: 20 size_m: 10 kind: FLOATER_KIND_RAFT } }\n"
      "storm { level_ratio: 1 }\n"
      "events { effect { breaking_wave { side: SIDE_DIRECTION direction_deg: -135 shape: WAVE_SHAPE_SWELL } } }\n",
      "pool.textproto");
  EXPECT_TRUE(scene) << scene.error().message;
}

TEST(WaterRules, AcceptFoamOfTheSurfaceWithoutParticles) {
  const auto scene = parseSceneText("wave {}\nfoam { surface: true }", "pool.textproto");
  EXPECT_TRUE(scene) << scene.error().message;
}

TEST(WaterRules, AcceptASmallWaterWithoutASponge) {
  const auto scene = parseSceneText("wave { side_m: 2 }", "pool.textproto");
  EXPECT_TRUE(scene) << "the default sponge is wider, but no side absorbs: " << scene.error().message;
}

TEST(WaterRules, RefuseMoreObstaclesThanTheBound) {
  std::string text = "wave {}\n";
  for (int i = 0; i <= kSceneObstacleMaxCount; ++i) text += "obstacles { rock {} }\n";
  const auto scene = parseSceneText(text, "pool.textproto");
  ASSERT_FALSE(scene);
  EXPECT_THAT(scene.error().message, HasSubstr("obstacles[64]: 65 obstacles are more than 64"));
}

}  // namespace
}  // namespace spindrift::scene
