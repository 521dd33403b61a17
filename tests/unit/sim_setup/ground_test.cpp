// The ground: floor, beaches, grid, shapes and obstacles, as closed forms.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/sim_setup/basin.h>
#include <spindrift/sim_setup/derive.h>
#include <spindrift/sim_setup/fill_up.h>
#include <spindrift/sim_setup/ground.h>

namespace spindrift::sim {
namespace {

using ::testing::HasSubstr;

constexpr double kExact = 1e-12;

core::Scene waterOf(double side_m, double depth_m) {
  core::Scene scene;
  scene.wave.emplace();
  scene.wave->resolution_count = 64;
  scene.wave->side_m = side_m;
  scene.wave->depth_m = depth_m;
  setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
  return scene;
}

core::Scene withShapes(core::Scene scene, std::vector<core::BedShape> shapes) {
  if (!scene.bed) scene.bed.emplace();
  scene.bed->shapes = std::move(shapes);
  return scene;
}

core::DepthGrid gridOf(std::uint32_t columns, std::uint32_t rows, std::vector<float> depths_m) {
  core::DepthGrid out;
  out.columns_count = columns;
  out.rows_count = rows;
  out.depths_m = std::make_shared<const std::vector<float>>(std::move(depths_m));
  return out;
}

TEST(Ground, IsTheDepthOfTheWaterWithoutBeachesAndBed) {
  const core::Scene scene = waterOf(24, 1.5);
  EXPECT_EQ(groundDepth(scene, 3, -7), 1.5);
  EXPECT_EQ(bedDepth(scene, 3, -7), 1.5);
  EXPECT_FALSE(shoreSlope(scene, 3, -7));
}

TEST(Ground, BeachRisesAboveTheWaterToTheSide) {
  core::Scene scene = waterOf(20, 2.0);
  scene.beaches = {{.side = core::Side::kPlusX, .width_m = 8, .shore_depth_m = -2.0}};
  EXPECT_NEAR(groundDepth(scene, 2, 0), 2.0, kExact);
  EXPECT_NEAR(groundDepth(scene, 6, 5), 0.0, kExact) << "half way up is the shore";
  EXPECT_NEAR(groundDepth(scene, 8, 0), -1.0, kExact);
  EXPECT_NEAR(groundDepth(scene, 10, 0), -2.0, kExact);
  EXPECT_EQ(bedDepth(scene, 8, 0), 0.0) << "linear waves know no land height";
}

TEST(Ground, GridIsBilinear) {
  core::Scene scene = waterOf(10, 9.0);
  scene.bed.emplace();
  scene.bed->grid = gridOf(3, 2, {1, 2, 4, 5, 7, -3});
  const core::DepthGrid& grid = *scene.bed->grid;
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 3; ++column) {
      EXPECT_NEAR(groundDepth(scene, -5 + 5 * column, -5 + 10 * row),
                  (*grid.depths_m)[static_cast<std::size_t>(column + 3 * row)], kExact)
          << column << ", " << row;
    }
  }
  EXPECT_NEAR(groundDepth(scene, -2.5, -5), 1.5, kExact);
  EXPECT_NEAR(groundDepth(scene, -5, 0), 3.0, kExact);
  EXPECT_NEAR(groundDepth(scene, 2.5, 0), (2 + 4 + 7 - 3) / 4.0, kExact);
  EXPECT_NEAR(groundDepth(scene, 4, 3), 0.2 * (0.2 * 2 + 0.8 * 4) + 0.8 * (0.2 * 7 + 0.8 * -3), kExact);
}

TEST(Ground, RectangleHasItsGridAndBeachesAtItsSides) {
  core::Scene scene = waterOf(32, 3.0);
  scene.wave->width_m = 4;
  scene.beaches = {{.side = core::Side::kPlusZ, .width_m = 1, .shore_depth_m = -1}};
  EXPECT_NEAR(groundDepth(scene, 15, 2), -1.0, kExact);
  EXPECT_NEAR(groundDepth(scene, -15, 1), 3.0, kExact);
  scene.bed.emplace();
  scene.bed->grid = gridOf(2, 2, {0, 1, 2, 3});
  EXPECT_NEAR(groundDepth(scene, 16, 2), 3.0, kExact);
  EXPECT_NEAR(groundDepth(scene, -16, 0), 1.0, kExact);
  EXPECT_NEAR(groundDepth(scene, 8, -2), 0.75, kExact);
}

TEST(Ground, GridChangesNothingOutside) {
  core::Scene scene = waterOf(10, 9.0);
  scene.bed.emplace();
  scene.bed->grid = gridOf(2, 2, {1, 1, 1, 1});
  scene.bed->grid->x_m = 1;
  scene.bed->grid->length_m = 2;
  scene.bed->grid->width_m = 4;
  EXPECT_EQ(groundDepth(scene, 1.99, 1.99), 1.0);
  EXPECT_EQ(groundDepth(scene, 2.01, 0), 9.0);
  EXPECT_EQ(groundDepth(scene, 1, -2.01), 9.0);
}

/// The conical island of Briggs et al. 1995: 7.2 m across at the toe, 2.2 m at the crest, 1 on 4.
TEST(Ground, TruncatedConeRisesFromToeToCrest) {
  const core::Scene scene = withShapes(
      waterOf(25, 0.32),
      {core::BedCone{.x_m = 0.46, .z_m = -0.3, .toe_radius_m = 3.6, .crest_radius_m = 1.1, .height_m = 0.625}});
  EXPECT_NEAR(groundDepth(scene, 0.46, -0.3), 0.32 - 0.625, kExact);
  EXPECT_NEAR(groundDepth(scene, 0.46 + 1.1, -0.3), 0.32 - 0.625, kExact);
  EXPECT_NEAR(groundDepth(scene, 0.46, -0.3 + 3.6), 0.32, kExact);
  EXPECT_NEAR(groundDepth(scene, 0.46 - 2.32, -0.3), 0.0, kExact) << "the shore line of a slope of 1 on 4";
  EXPECT_NEAR(groundDepth(scene, 6, 6), 0.32, kExact);
}

/// The plane beach of Synolakis 1987: cot(beta) = 19.85, from a depth of 1 m.
TEST(Ground, SlopeRisesFromItsLine) {
  const core::Scene scene =
      withShapes(waterOf(60, 1.0), {core::BedSlope{.x_m = 2, .z_m = 0, .gradient_ratio = 1 / 19.85}});
  EXPECT_NEAR(groundDepth(scene, 1.9, 7), 1.0, kExact);
  EXPECT_NEAR(groundDepth(scene, 2 + 19.85, -7), 0.0, kExact);
  EXPECT_NEAR(groundDepth(scene, 2 + 1.2 * 19.85, 0), -0.2, kExact);
}

TEST(Ground, SlopesAddUp) {
  const core::BedSlope first{.x_m = 0, .z_m = 0, .heading_deg = 90, .gradient_ratio = 0.1, .length_m = 4};
  const core::BedSlope second{.x_m = 0, .z_m = 4, .heading_deg = 90, .gradient_ratio = 0.5, .length_m = 2};
  const core::Scene scene = withShapes(waterOf(20, 2.0), {first, second});
  EXPECT_NEAR(groundDepth(scene, -3, -1), 2.0, kExact);
  EXPECT_NEAR(groundDepth(scene, -3, 3), 1.7, kExact);
  EXPECT_NEAR(groundDepth(scene, 3, 5), 1.1, kExact);
  EXPECT_NEAR(groundDepth(scene, 3, 9), 0.6, kExact) << "level again behind its end";
}

TEST(Ground, SillAndChannelHaveFlanks) {
  const core::BedSill sill{
      .x_m = 0, .z_m = 0, .heading_deg = 90, .length_m = 6, .crest_width_m = 2, .flank_width_m = 4, .height_m = 1};
  const core::Scene bar = withShapes(waterOf(20, 2.0), {sill});
  EXPECT_NEAR(groundDepth(bar, 1, 3), 1.0, kExact);
  EXPECT_NEAR(groundDepth(bar, 3, 0), 1.5, kExact);
  EXPECT_NEAR(groundDepth(bar, 0, 5), 1.5, kExact);
  EXPECT_NEAR(groundDepth(bar, 5.1, 0), 2.0, kExact);
  EXPECT_NEAR(groundDepth(bar, 1 + 0.6, 3 + 0.8), 1.25, kExact) << "1 m from the corner of the crest";

  core::Scene scene = waterOf(20, 2.0);
  scene.bed.emplace();
  scene.bed->floor_depth_m = 1.5;
  const core::Scene trench =
      withShapes(scene, {core::BedChannel{.length_m = 40, .bottom_width_m = 2, .bank_width_m = 0, .cut_m = 0.5}});
  EXPECT_NEAR(groundDepth(trench, 9, 0.99), 2.0, kExact);
  EXPECT_NEAR(groundDepth(trench, 9, 1.01), 1.5, kExact) << "a bank without width is a step";
  EXPECT_TRUE(derive(trench));
}

TEST(Ground, ObstaclesAreHills) {
  core::Scene scene = waterOf(20, 2.0);
  scene.obstacles = {
      core::Rock{.x_m = 4, .z_m = 0, .radius_m = 2, .height_m = 1},
      core::Breakwater{.x_m = -4, .z_m = 0, .length_m = 4, .width_m = 1, .heading_deg = 90, .height_m = 0.7}};
  EXPECT_NEAR(groundDepthWithObstacles(scene, 4, 0), -1.0, kExact);
  EXPECT_NEAR(groundDepthWithObstacles(scene, 6, 0), 0.0, kExact) << "its radius is that of the water line";
  EXPECT_NEAR(groundDepthWithObstacles(scene, 4, 3), 1.0, kExact) << "below the water it continues with its slope";
  EXPECT_NEAR(groundDepthWithObstacles(scene, 4, 9), 2.0, kExact);
  EXPECT_NEAR(groundDepthWithObstacles(scene, -4.4, 1.9), -0.7, kExact);
  EXPECT_NEAR(groundDepthWithObstacles(scene, -4.6, 0), 2.0, kExact);
  EXPECT_EQ(groundDepth(scene, 4, 0), 2.0) << "the bed is what they stand on";
}

TEST(Ground, TooDeepGroundIsReportedWithItsPosition) {
  const core::Scene scene = withShapes(waterOf(20, 2.0), {core::BedChannel{.x_m = 3, .z_m = -2, .cut_m = 0.5}});
  const auto derived = derive(scene);
  ASSERT_FALSE(derived);
  EXPECT_THAT(derived.error().message, HasSubstr("2.5 m at x"));
  EXPECT_THAT(derived.error().message, HasSubstr("wave.depth_m of at least 2.5 m"));
}

TEST(Ground, RoundingErrorOfTheDepthIsAccepted) {
  // A bar whose slopes are written with five digits: it ends 0.8 um below the floor.
  const core::Scene scene =
      withShapes(waterOf(40, 0.8), {core::BedSlope{.x_m = -14, .gradient_ratio = 0.049875, .length_m = 12.03},
                                    core::BedSlope{.x_m = 1, .gradient_ratio = -0.099502, .length_m = 6.03}});
  const auto derived = derive(scene);
  ASSERT_TRUE(derived) << derived.error().message;
  EXPECT_EQ(groundDepth(scene, 15, 0), 0.8);
  EXPECT_NEAR(groundDepth(scene, -1, 0), 0.8 - 0.049875 * 12.03, kExact);
}

TEST(Ground, NonlinearGroundIsLimitedByItsUnits) {
  core::Scene scene = withShapes(waterOf(40, 1.0), {core::BedSlope{.gradient_ratio = 10.0}});
  scene.wave->bulk = core::Bulk::kNonlinear;
  EXPECT_NEAR(groundDepth(scene, 19, 0), -189.0, kExact) << "what people and the page see";
  EXPECT_EQ(groundDepthWithObstacles(scene, 19, 0), -kHighestLand_m);
  const Basin basin = layOutBasin(scene, *derive(scene)->wave);
  EXPECT_EQ(std::ranges::max(restingElevation(basin)), bedUnits(kHighestLand_m));
}

TEST(Ground, GridWithoutPointsIsRefused) {
  core::Scene scene = waterOf(20, 2.0);
  scene.bed.emplace();
  scene.bed->grid = gridOf(3, 2, {1, 2, 3});
  const auto derived = derive(scene);
  ASSERT_FALSE(derived);
  EXPECT_THAT(derived.error().message, HasSubstr("bed.grid: 3 x 2 points with 3 depths"));
}

TEST(Ground, SlopeLeadsToAShoreAndABarDoesNot) {
  const core::Scene beach = withShapes(waterOf(40, 1.0), {core::BedSlope{.x_m = 0, .z_m = 0, .gradient_ratio = 0.1}});
  ASSERT_TRUE(shoreSlope(beach, 7, 0));
  EXPECT_NEAR(*shoreSlope(beach, 7, 0), 0.1, 1e-9);
  EXPECT_FALSE(shoreSlope(beach, -7, 0)) << "level";
  EXPECT_FALSE(shoreSlope(beach, 12, 0)) << "land";
  const core::Scene bar = withShapes(
      waterOf(40, 1.0), {core::BedSill{.length_m = 80, .crest_width_m = 1, .flank_width_m = 5, .height_m = 0.9}});
  EXPECT_FALSE(shoreSlope(bar, 0, 1.5)) << "its crest is under water";
}

TEST(Basin, BedIsDryOnLandAndFadesOnItsShore) {
  core::Scene scene = withShapes(waterOf(40, 1.0), {core::BedSlope{.x_m = 0, .z_m = 0, .gradient_ratio = 0.1}});
  const WaveLayout layout = *derive(scene)->wave;
  const Basin basin = layOutBasin(scene, layout);
  const Terrain terrain = layOutTerrain(scene, layout, basin);
  EXPECT_FALSE(basin.is_flat);
  const std::size_t row = 64 * 32;
  for (std::size_t x = 0; x < 64; ++x) {
    const double x_m = (static_cast<double>(x) + 0.5) * 40 / 64 - 20;
    const double depth_m = 1 - 0.1 * std::max(x_m, 0.0);
    const double wet_m = depth_m < 0.03 ? 0.0 : depth_m;
    EXPECT_NEAR(basin.depth_m[row + x], wet_m, 1e-6) << x_m;
    EXPECT_EQ(basin.bed[row + x][0] > 0, depth_m < 0.4 && depth_m > 0) << x_m << " m: " << depth_m << " m deep";
    EXPECT_NEAR(terrain.ground[row + x][3], depth_m < 0 ? depth_m : wet_m, 1e-6) << "land has its height";
  }
}

/// A beach of the scene and the same slope as a bed make the same water.
TEST(Basin, SlopeEqualsABeach) {
  core::Scene beach = waterOf(40, 1.0);
  beach.beaches = {{.side = core::Side::kPlusX, .width_m = 10, .shore_depth_m = 0}};
  const core::Scene slope = withShapes(waterOf(40, 1.0), {core::BedSlope{.x_m = 10, .z_m = 0, .gradient_ratio = 0.1}});
  const WaveLayout layout = *derive(beach)->wave;
  const Basin expected = layOutBasin(beach, layout);
  const Basin basin = layOutBasin(slope, layout);
  for (std::size_t i = 0; i < expected.depth_m.size(); ++i) {
    ASSERT_NEAR(basin.depth_m[i], expected.depth_m[i], 1e-6);
    ASSERT_NEAR(basin.conductance_m[i][0], expected.conductance_m[i][0], 1e-6);
    if (expected.depth_m[i] > 0) {
      ASSERT_NEAR(basin.bed[i][0], expected.bed[i][0], 1e-4);
    }
  }
}

}  // namespace
}  // namespace spindrift::sim
