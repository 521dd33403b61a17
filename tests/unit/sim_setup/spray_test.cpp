
#include <gtest/gtest.h>

#include <spindrift/sim_setup/particle_layout.h>

namespace spindrift::sim {
namespace {

TEST(SprayBlocks, SmallParticlesMayLeaveEveryCell) {
  const SprayBlocks blocks = sprayBlocks(1, 0.12, 1.2);
  EXPECT_EQ(blocks.block_count, 1u);
  EXPECT_NEAR(blocks.taken_ratio, 1.0, 1e-12) << "all cells at once: the weights add up to one particle";
}

TEST(SprayBlocks, LargeParticlesMayLeaveFewerCells) {
  const SprayBlocks blocks = sprayBlocks(3, 0.786, 1.0);
  EXPECT_EQ(blocks.block_count, 2u);
  EXPECT_LE(blocks.taken_ratio * 0.786, 0.5);
  EXPECT_GE(blocks.taken_ratio, 0.25) << "one in four at best";
}

TEST(SprayBlocks, WeightsAreThoseOfTheWorstPositions) {
  // Reach 1 spreads 1 4 6 4 1 over 16. With blocks of two, the worst positions sum to 6 + 4 + 1 of 16 per axis; with
  // blocks of 16, to 6 + 4 across the edge of a block.
  EXPECT_NEAR(sprayBlocks(1, 0.9, 1.0).taken_ratio, 11.0 * 11.0 / 256.0, 1e-12);
  const SprayBlocks largest = sprayBlocks(1, 100.0, 1.0);
  EXPECT_EQ(largest.block_count, 16u);
  EXPECT_NEAR(largest.taken_ratio, 10.0 * 10.0 / 256.0, 1e-12);
}

}  // namespace
}  // namespace spindrift::sim
