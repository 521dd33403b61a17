// Effects in scenes without a wave, where they move the particles themselves.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

class StirredBox : public OnDevice {
 protected:
  /// Water `length_m` x `width_m` between walls, six layers deep.
  WaterSim& box(double length_m, double width_m) {
    core::Scene scene = smallScene(4000);
    scene.wave.reset();
    scene.coupling.reset();
    core::ParticleScene& p = *scene.particles;
    p.layers_count = 6;
    p.box_side_m = length_m;
    p.box_width_m = width_m;
    p.headroom_m = 3;
    p.max_speed_mps = 6;
    p.solver = core::PressureSolver::kPositionBased;
    p.boundary_x = p.boundary_z = core::Boundary::kWall;
    return make(scene);
  }

  /// Height of the highest particle in each of `count` slices along x. [m]
  static std::vector<double> profile(const StateCopy& state, const ParticleLayout& l, int count) {
    std::vector<double> top(static_cast<std::size_t>(count), l.min_m[1]);
    for (std::size_t i = 0; i < state.position.size(); i += 4) {
      const double share = (state.position[i] - l.min_m[0]) / (l.max_m[0] - l.min_m[0]);
      const auto slice = static_cast<std::size_t>(std::clamp(static_cast<int>(share * count), 0, count - 1));
      top[slice] = std::max<double>(top[slice], state.position[i + 1]);
    }
    return top;
  }
};

TEST_F(StirredBox, ASplashThrowsACrownAroundItsCavity) {
  WaterSim& sim = box(4.0, 4.0);
  const ParticleLayout& l = *sim.derived().particles;
  for (int tick = 0; tick < 30; ++tick) sim.step();
  ASSERT_TRUE(sim.start(core::Splash{0.0, 0.0, 0.7, 0.5, 0.15}));
  double crown_m = -1e9;
  double middle_m = 1e9;
  for (int tick = 0; tick < 24; ++tick) {
    sim.step();
    const StateCopy state = sim.copyState();
    double middle_now_m = l.min_m[1];
    for (std::size_t i = 0; i < state.position.size(); i += 4) {
      const double r_m = std::hypot(state.position[i], state.position[i + 2]);
      const double y_m = state.position[i + 1];
      if (r_m < 0.35) middle_now_m = std::max(middle_now_m, y_m);
      if (r_m > 0.7 && r_m < 1.8) crown_m = std::max(crown_m, y_m);
      // Particles outside its reach do not move.
      if (r_m > 2.4) {
        EXPECT_LT(y_m, 2.5 * l.spacing_m);
      }
    }
    middle_m = std::min(middle_m, middle_now_m);
  }
  EXPECT_GT(crown_m, 0.25) << "rises by at least half of the splash's depth over the water";
  EXPECT_LT(middle_m, -0.25) << "at least half of the splash's depth is dug out";
  EXPECT_EQ(sim.nonfiniteCount() + sim.escapedCount() + sim.recoveredCount(), 0u);
}

TEST_F(StirredBox, AWaveRunsAlongTheWholeOfAnOblongBox) {
  for (const auto side : {core::Side::kPlusX, core::Side::kMinusX}) {
    WaterSim& sim = box(8.0, 2.0);
    const ParticleLayout& l = *sim.derived().particles;
    for (int tick = 0; tick < 30; ++tick) sim.step();
    ASSERT_TRUE(sim.start(core::BreakingWave{.side = side, .amplitude_m = 0.5, .length_m = 1.0, .duration_s = 0.2}));
    std::vector<double> crest_m;
    for (int tick = 0; tick < 75; ++tick) {
      sim.step();
      if (tick % 15 != 14) continue;
      const std::vector<double> top = profile(sim.copyState(), l, 16);
      const auto at = std::ranges::max_element(top) - top.begin();
      crest_m.push_back(l.min_m[0] + (static_cast<double>(at) + 0.5) / 16 * (l.max_m[0] - l.min_m[0]));
    }
    const double inward = side == core::Side::kPlusX ? -1 : 1;
    EXPECT_LT(inward * crest_m.front(), 0.0) << "starts in its own half";
    EXPECT_GT(inward * (crest_m.back() - crest_m.front()), 2.0) << "and crosses more than a quarter of the box";
  }
}

}  // namespace
}  // namespace spindrift::sim
