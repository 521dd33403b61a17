// Prints the state hash of a shipped scene after some ticks with fixed commands: for runs with another environment,
// above all another SPINDRIFT_GPU_CHECKS.
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include <spindrift/gpu/context.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/sim/water_sim.h>

#include "test_device.h"

int main(int count, char** arguments) {
  using namespace spindrift;
  if (count != 3) return std::fprintf(stderr, "usage: state_hash SCENE_FILE TICKS\n"), 2;
  auto ctx = gpu::testContext();
  if (!ctx) return std::fprintf(stderr, "%s\n", ctx.error().message.c_str()), 3;
  const auto scene = scene::loadSceneFile(arguments[1]);
  if (!scene) return std::fprintf(stderr, "%s\n", scene.error().message.c_str()), 2;
  auto water = sim::WaterSim::create(**ctx, scene::toCore(*scene));
  if (!water) return std::fprintf(stderr, "%s\n", water.error().message.c_str()), 1;
  const int ticks = std::atoi(arguments[2]);
  for (int tick = 0; tick < ticks; ++tick) {
    if (tick == 3) (void)(*water)->start(core::Splash{0.3, -0.2, 0.8, 0.4, 0.15});
    if (tick == 10) (void)(*water)->start(core::BreakingWave{core::Side::kMinusX, 0.4, 1.5, 0.3});
    if (tick == 15) (void)(*water)->controlBoat(1, 1.0, -0.5);
    if ((*ctx)->checks().poison) (*ctx)->poisonScratch();
    (*water)->step();
  }
  std::printf("%016llx\n", static_cast<unsigned long long>((*water)->stateHash()));
  return 0;
}
