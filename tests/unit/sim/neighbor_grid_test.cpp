#include "neighbor_grid.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <tuple>

#include <gtest/gtest.h>
#include <shared/bindings.h>

#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

class Grid : public OnDevice {
 protected:
  /// Sorts `positions` (4 floats each) on the device with the layout of `derived`.
  void sort(const Derived& derived, const std::vector<float>& positions) {
    derived_ = derived;
    derived_.uniforms.particle_count = static_cast<std::uint32_t>(positions.size() / 4);
    derived_.particles->count = derived_.uniforms.particle_count;
    auto uniforms = gpu::Buffer::create(*ctx_, "uniforms", sizeof(shared::SimUniforms));
    uniforms->uploadValue(derived_.uniforms);
    uniforms->bindUniform(SIM_UNIFORMS);
    ParticleBuffers p;
    const std::size_t n = derived_.particles->count;
    for (gpu::TexelBuffer* b : {&p.position, &p.velocity, &p.sorted_position, &p.sorted_velocity}) {
      *b = *gpu::TexelBuffer::create(*ctx_, "particles", n, gpu::TexelFormat::kRGBA32F);
    }
    p.position.upload(positions);
    p.velocity.upload(positions);  // lets a test check that both move together
    Creation create(*ctx_, {{"PERIODIC_X", "1"}, {"PERIODIC_Y", "0"}, {"PERIODIC_Z", "1"}, {"POOL_PARTICLES", "0"}});
    NeighborGrid grid(create, *derived_.particles);
    ASSERT_FALSE(create.error()) << create.error()->message;
    // The second build finds what the first one has cleared.
    for (int build = 0; build < 2; ++build) grid.build(p, Population(derived_.particles->count, nullptr));
    ctx_->barrier(gpu::Barrier::kBufferUpdate);
    sorted_ = p.sorted_position.downloadVector<float>(4 * n);
    sorted_velocity_ = p.sorted_velocity.downloadVector<float>(4 * n);
    start_ = grid.cellStart().downloadVector<std::uint32_t>(derived_.particles->cell_count + 1);
  }

  std::uint32_t cellOf(const float* x) const {
    const ParticleLayout& l = *derived_.particles;
    std::array<std::uint32_t, 3> c{};
    for (int axis = 0; axis < 3; ++axis) {
      // In float, like the shader.
      const float u =
          std::floor((x[axis] - static_cast<float>(l.min_m[axis])) / static_cast<float>(l.support_radius_m));
      c[axis] = static_cast<std::uint32_t>(std::clamp(u, 0.0f, static_cast<float>(l.cells[axis] - 1)));
    }
    return c[1] + l.cells[1] * (c[0] + l.cells[0] * c[2]);
  }

  std::vector<float> randomPositions(const Derived& d, std::size_t count) {
    std::mt19937 random(42);
    std::vector<float> out;
    for (std::size_t i = 0; i < count; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        const double u = std::generate_canonical<double, 53>(random);
        out.push_back(
            static_cast<float>(d.particles->min_m[axis] + u * (d.particles->max_m[axis] - d.particles->min_m[axis])));
      }
      out.push_back(static_cast<float>(i));
    }
    return out;
  }

  Derived derived_;
  std::vector<float> sorted_, sorted_velocity_;
  std::vector<std::uint32_t> start_;
};

TEST_F(Grid, SortsByCellAndThenByIndexAtOddSizes) {
  for (const std::size_t count : {1u, 7u, 63u, 65u, 257u, 1021u, 5003u}) {
    const auto d = derive(smallScene(3000));
    const auto positions = randomPositions(*d, count);
    sort(*d, positions);
    // The reference is a stable sort on the CPU.
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return cellOf(&positions[4 * i]); });
    for (std::size_t k = 0; k < count; ++k) {
      ASSERT_EQ(sorted_[4 * k + 3], static_cast<float>(order[k])) << "place " << k << " of " << count;
      ASSERT_EQ(sorted_velocity_[4 * k + 3], sorted_[4 * k + 3]);
    }
  }
}

TEST_F(Grid, StartsAreTheExclusivePrefixSum) {
  const auto d = derive(smallScene(3000));
  const auto positions = randomPositions(*d, 2999);
  sort(*d, positions);
  std::vector<std::uint32_t> count(d->particles->cell_count, 0);
  for (std::size_t i = 0; i < 2999; ++i) ++count[cellOf(&positions[4 * i])];
  std::uint32_t before = 0;
  for (std::uint32_t c = 0; c < d->particles->cell_count; ++c) {
    ASSERT_EQ(start_[c], before) << "cell " << c;
    before += count[c];
  }
  EXPECT_EQ(start_.back(), 2999u);
}

TEST_F(Grid, ScansMoreBlocksThanOneGroupHolds) {
  // Over 256 blocks of 1024 cells: the second level of the scan needs a second chunk.
  auto d = derive(smallScene(3000));
  d->particles->cells = {70, 70, 70};
  d->particles->cell_count = 70 * 70 * 70;
  d->uniforms.cells_x = d->uniforms.cells_y = d->uniforms.cells_z = 70;
  d->uniforms.cell_count = d->particles->cell_count;
  for (int axis = 0; axis < 3; ++axis)
    d->particles->max_m[axis] = d->particles->min_m[axis] + 70 * d->particles->support_radius_m;
  const auto positions = randomPositions(*d, 4001);
  sort(*d, positions);
  EXPECT_EQ(start_.back(), 4001u);
  EXPECT_TRUE(std::ranges::is_sorted(start_));
  for (std::size_t k = 1; k < 4001; ++k) ASSERT_LE(cellOf(&sorted_[4 * (k - 1)]), cellOf(&sorted_[4 * k]));
}

TEST_F(Grid, HasMoreCellsThanOneDispatchHasInvocations) {
  // Over 65535 groups of 256 cells.
  constexpr std::uint32_t kCells = 257;
  auto d = derive(smallScene(3000));
  d->particles->cells = {kCells, kCells, kCells};
  d->particles->cell_count = kCells * kCells * kCells;
  ASSERT_GT(d->particles->cell_count / 256, 65535u);
  d->uniforms.cells_x = d->uniforms.cells_y = d->uniforms.cells_z = kCells;
  d->uniforms.cell_count = d->particles->cell_count;
  for (int axis = 0; axis < 3; ++axis)
    d->particles->max_m[axis] = d->particles->min_m[axis] + kCells * d->particles->support_radius_m;
  sort(*d, randomPositions(*d, 1009));
  EXPECT_EQ(start_.back(), 1009u);
  EXPECT_TRUE(std::ranges::is_sorted(start_));
}

TEST_F(Grid, SurvivesEveryParticleInOneCell) {
  const auto d = derive(smallScene(3000));
  std::vector<float> positions;
  for (int i = 0; i < 2000; ++i) positions.insert(positions.end(), {0.01f, 0.01f, 0.01f, static_cast<float>(i)});
  sort(*d, positions);
  for (int k = 0; k < 2000; ++k) ASSERT_EQ(sorted_[4 * k + 3], static_cast<float>(k));
}

}  // namespace
}  // namespace spindrift::sim
