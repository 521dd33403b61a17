// Floaters: against closed forms, contacts, and what they do to the water.
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <shared/floaters.h>

#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

constexpr double kGravity = 9.81;

/// 8 m of water with the wave only; tests add what they need.
core::Scene floaterScene() {
  core::Scene scene;
  scene.name = "floaters";
  scene.wave.emplace();
  scene.wave->resolution_count = 64;
  scene.wave->side_m = 8.0;
  scene.wave->depth_m = 2.0;
  scene.wave->damping_per_s = 0.5;
  setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
  scene.floaters.emplace();
  return scene;
}

struct FloaterPose {
  double x_m, y_m, z_m;
  double velocity_x_mps, velocity_y_mps, velocity_z_mps;
  double up_x, up_y, up_z;  ///< where its own y axis points
  double spin_radps, dent, ballast_m;
  [[nodiscard]] double speed_mps() const { return std::hypot(velocity_x_mps, velocity_y_mps, velocity_z_mps); }
  [[nodiscard]] double tilt_deg() const { return std::acos(std::min(up_y, 1.0)) * 180.0 / std::numbers::pi; }
  /// Of the middle of its shape.
  [[nodiscard]] double middle_m() const { return y_m - ballast_m * up_y; }
};

class FloatersOnDevice : public OnDevice {
 protected:
  FloaterPose pose(WaterSim& sim, std::size_t slot = 0) { return poses(sim).at(slot); }
  std::vector<FloaterPose> poses(WaterSim& sim) {
    const auto all = sim.copyState().floaters;
    std::vector<FloaterPose> out;
    for (std::size_t at = 0; at < all.size(); at += FLOATER_TEXELS * 4) {
      const float* s = &all[at];
      const double x = s[4], y = s[5], z = s[6], w = s[7];
      out.push_back({s[0], s[1], s[2], s[8], s[9], s[10], 2 * (x * y - w * z), 1 - 2 * (x * x + z * z),
                     2 * (y * z + w * x), std::hypot(s[12], s[13], s[14]), s[15], s[21]});
    }
    return out;
  }
  static void run(WaterSim& sim, double duration_s) {
    for (int i = 0; i < duration_s * 60; ++i) sim.step();
  }
};


[[maybe_unused]] double period(const std::vector<double>& y, double dt) {
  double mean = 0;
  for (double v : y) mean += v / static_cast<double>(y.size());
  std::vector<double> cross;
  for (std::size_t i = 1; i < y.size(); ++i)
    if (y[i - 1] < mean && y[i] >= mean) cross.push_back(dt * (static_cast<double>(i) - (y[i] - mean) / (y[i] - y[i - 1])));
  return cross.size() < 2 ? 0 : (cross.back() - cross.front()) / static_cast<double>(cross.size() - 1);
}

TEST_F(FloatersOnDevice, Explore) {
  for (int n : {0, 64, 256, 1024}) for (double apart : {1.0, 0.45}) {
    core::Scene scene = floaterScene();
    scene.wave->side_m = 40;
    scene.wave->resolution_count = 128;
    scene.floaters->capacity_count = 1024;
    const int row = static_cast<int>(std::ceil(std::sqrt(n)));
    for (int i = 0; i < n; ++i)
      scene.floaters->floaters.push_back(core::Floater{.kind = static_cast<core::FloaterKind>(i % 7),
          .x_m = apart * (i % row - row / 2), .y_m = 0.1, .z_m = apart * (i / row - row / 2), .heading_deg = 7.0 * (i % 7),
          .size_m = 0.5});
    WaterSim& sim = make(scene);
    run(sim, 1);
    (void)sim.takePassCosts();
    const auto t0 = std::chrono::steady_clock::now();
    run(sim, 1.5);
    (void)sim.copyState();
    const double ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - t0).count() / 90;
    std::printf("%d apart %.2f: %.3f ms per tick:", n, apart, ms);
    for (const auto& c : sim.takePassCosts()) std::printf(" %s %.3f", c.name.c_str(), c.total_ms / static_cast<double>(c.scope_count));
    std::puts("");
  }
}

}  // namespace
}  // namespace spindrift::sim
