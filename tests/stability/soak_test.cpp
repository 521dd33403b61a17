// Runs the default scene for a long time, as fast as the machine can: 40 simulated seconds at DRAFT in a test run, or
// SPINDRIFT_SOAK_S at the scene's own level (600 for the ten minutes of docs/operations/watch.md).
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <spindrift/gpu/context.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/sim/water_sim.h>

#include "test_device.h"

namespace spindrift {
namespace {

double soakSeconds() {
  const char* text = std::getenv("SPINDRIFT_SOAK_S");
  return text ? std::max(40.0, std::atof(text)) : 40.0;
}

/// Resident memory of this process. [bytes]
std::size_t residentBytes() {
  std::ifstream statm("/proc/self/statm");
  std::size_t total = 0;
  std::size_t resident = 0;
  statm >> total >> resident;
  return resident * 4096;
}

TEST(Soak, DefaultSceneKeepsEnergyAndMemory) {
  auto ctx = gpu::testContext();
  if (!ctx) GTEST_SKIP() << "no device: " << ctx.error().message;
  const auto level = std::getenv("SPINDRIFT_SOAK_S") ? std::nullopt : std::optional(v1::FIDELITY_DRAFT);
  auto scene =
      scene::loadSceneFile(std::filesystem::path(SPINDRIFT_SOURCE_DIR) / "server/scenes/pool.textproto", level);
  ASSERT_TRUE(scene) << scene.error().message;
  auto made = sim::WaterSim::create(**ctx, scene::toCore(*scene));
  ASSERT_TRUE(made) << made.error().message;
  sim::WaterSim& water = **made;

  const auto ticks = static_cast<std::uint64_t>(soakSeconds() * scene->tick_rate_hz());
  const auto settled =
      static_cast<std::uint64_t>(12 * scene->tick_rate_hz());  // the scene's own events repeat every 12 s
  std::vector<double> energy_j;
  std::size_t memory_at_start = 0;
  std::uint64_t frames = 0;
  for (std::uint64_t tick = 0; tick < ticks; ++tick) {
    water.step();
    if (tick % 2 == 0) (void)water.requestFrame(sim::FrameRequest::full({.surface = true, .particles = true}));
    frames += water.takeFrames().size();
    if (tick == settled) memory_at_start = residentBytes();
    if (tick > settled) energy_j.push_back(water.health().kinetic_energy_j + water.health().wave_energy_j);
    ASSERT_EQ(water.nonfiniteCount(), 0u) << "at " << water.time_s() << " s";
    ASSERT_EQ(water.escapedCount(), 0u) << "at " << water.time_s() << " s";
  }
  EXPECT_EQ(water.recoveredCount(), 0u);
  EXPECT_GT(frames, ticks / 4);
  EXPECT_EQ((*ctx)->debugErrorCount(), 0u);

  const std::size_t half = energy_j.size() / 2;
  const double early = *std::max_element(energy_j.begin(), energy_j.begin() + static_cast<std::ptrdiff_t>(half));
  const double late = *std::max_element(energy_j.begin() + static_cast<std::ptrdiff_t>(half), energy_j.end());
  const double grown_mb = (static_cast<double>(residentBytes()) - static_cast<double>(memory_at_start)) / 1e6;
  RecordProperty("simulated_s", std::to_string(water.time_s()));
  std::printf(
      "%.0f s simulated; largest energy %.0f J in the first half, %.0f J in the second; memory grew by %.2f MB\n",
      water.time_s(), early, late, grown_mb);
  EXPECT_LE(late, 1.25 * early) << "the same events give the same energy again";
  EXPECT_LE(grown_mb, 4.0);
}

}  // namespace
}  // namespace spindrift
