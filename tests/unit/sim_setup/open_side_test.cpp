// The side that waves come from where none is named.
#include <gtest/gtest.h>

#include <spindrift/sim_setup/ground.h>

namespace spindrift::sim {
namespace {

using core::Side;

core::Scene basin() {
  core::Scene scene;
  scene.wave.emplace();
  scene.wave->side_m = 16;
  scene.wave->depth_m = 1;
  setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
  return scene;
}

core::Beach beachAt(Side side, double shore_depth_m) {
  core::Beach beach;
  beach.side = side;
  beach.width_m = 5;
  beach.shore_depth_m = shore_depth_m;
  return beach;
}

TEST(OpenSide, LevelBasinTakesTheFirstSide) {
  EXPECT_EQ(openSide(core::Scene{}), Side::kPlusX) << "without a wave";
  EXPECT_EQ(openSide(basin()), Side::kPlusX);
}

TEST(OpenSide, IsNeitherBeachNorLand) {
  for (const double shore_depth_m : {0.3, 0.0, -2.0}) {
    core::Scene scene = basin();
    scene.beaches = {beachAt(Side::kPlusX, shore_depth_m)};
    EXPECT_EQ(openSide(scene), Side::kMinusX) << shore_depth_m;
    scene.beaches.push_back(beachAt(Side::kMinusX, shore_depth_m));
    EXPECT_EQ(openSide(scene), Side::kPlusZ) << shore_depth_m;
  }
}

TEST(OpenSide, PrefersTheAbsorbingOneOfEquallyDeepSides) {
  core::Scene scene = basin();
  scene.wave->boundary_minus_z = core::WaveBoundary::kAbsorb;
  EXPECT_EQ(openSide(scene), Side::kMinusZ);
  scene.beaches = {beachAt(Side::kMinusZ, 0.2)};
  EXPECT_EQ(openSide(scene), Side::kPlusZ) << "deep water comes first; the other sides have a part of the beach";
}

TEST(OpenSide, IsNotBehindAnIslandOrAWall) {
  core::Scene scene = basin();
  core::Breakwater wall;
  wall.x_m = 6;
  wall.length_m = 14;
  wall.width_m = 2;
  wall.heading_deg = 90;
  scene.obstacles = {wall};
  EXPECT_EQ(openSide(scene), Side::kMinusX);
}

TEST(OpenSide, RectangleIsJudgedOverItsOwnLengths) {
  core::Scene scene = basin();
  scene.wave->resolution_count = 64;
  scene.wave->width_m = 4;
  scene.beaches = {beachAt(Side::kPlusX, 0.0), beachAt(Side::kMinusX, 0.0)};
  EXPECT_EQ(openSide(scene), Side::kPlusZ);
}

}  // namespace
}  // namespace spindrift::sim
