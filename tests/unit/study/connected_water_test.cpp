// What hangs together in a channel of particles.
#include "connected_water.h"

#include <vector>

#include <gtest/gtest.h>

namespace spindrift::study {
namespace {

/// Columns of 10 x 4 particles, three across, from the wall of a channel; spacing 0.1 m, support radius 0.2 m.
class Channel : public ::testing::Test {
 protected:
  Channel() {
    layout_.spacing_m = 0.1;
    layout_.support_radius_m = 0.2;
    layout_.band_m = 1.0;
    layout_.min_m = {-2.0, -1.0, -0.15};
    layout_.max_m = {2.0, 1.0, 0.15};
    for (int x = 0; x < 10; ++x)
      for (int y = 0; y < 4; ++y)
        for (int z = 0; z < 3; ++z) add(0.05 + 0.1 * x, 0.05 + 0.1 * y, -0.1 + 0.1 * z);
  }
  void add(double from_wall_m, double height_m, double z_m) {
    position_.push_back(static_cast<float>(-2.0 + from_wall_m));
    position_.push_back(static_cast<float>(-1.0 + height_m));
    position_.push_back(static_cast<float>(z_m));
    position_.push_back(0.0f);
  }

  sim::ParticleLayout layout_;
  std::vector<float> position_;
};

TEST_F(Channel, HasItsEdgeAndHeightWhereTheParticlesEnd) {
  const ConnectedWater water(position_, layout_);
  EXPECT_NEAR(water.edge_m(), 1.0, 1e-5);
  EXPECT_NEAR(water.columnHeight_m(), 0.4, 1e-5);
  EXPECT_NEAR(water.highestAtWall_m(), 0.4, 1e-5);
}

TEST_F(Channel, LeavesOutDropsThatFlyAlone) {
  add(1.3, 0.05, 0.0);
  add(0.1, 0.9, 0.0);
  const ConnectedWater water(position_, layout_);
  EXPECT_NEAR(water.edge_m(), 1.0, 1e-5);
  EXPECT_NEAR(water.columnHeight_m(), 0.4, 1e-5);
  EXPECT_NEAR(water.highestAtWall_m(), 0.4, 1e-5);
}

TEST_F(Channel, IsConnectedAcrossItsPeriodicSides) {
  // 0.26 m from the water inside the box, 0.16 m across the side.
  for (int k = 0; k < 2; ++k) add(1.06 + 0.12 * k, 0.05, k == 0 ? -0.14 : 0.14);
  const ConnectedWater water(position_, layout_);
  EXPECT_NEAR(water.edge_m(), 1.23, 1e-5);
}

}  // namespace
}  // namespace spindrift::study
