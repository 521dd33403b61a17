// Prints the state hash of a shipped scene after some ticks with fixed commands: for runs with another environment,
// above all another SPINDRIFT_GPU_CHECKS. With `twice`, computes the scene two times side by side and prints where they
// differ first: for a device on which equal runs end in different states.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <set>
#include <string>

#include <spindrift/gpu/context.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/sim/water_sim.h>

#include "test_device.h"

namespace {

using namespace spindrift;

void step(gpu::Context& ctx, sim::WaterSim& water, int tick) {
  if (tick == 3) (void)water.start(core::Splash{0.3, -0.2, 0.8, 0.4, 0.15});
  if (tick == 10) (void)water.start(core::BreakingWave{core::Side::kMinusX, 0.4, 1.5, 0.3});
  if (tick == 15) (void)water.controlBoat(1, 1.0, -0.5);
  if (ctx.checks().poison) ctx.poisonScratch();
  water.step();
}

/// Prints each buffer in which the two states differ and that is not in `known` yet.
void printDifferences(int tick, const sim::SavedState& a, const sim::SavedState& b, std::set<std::string>& known) {
  for (std::size_t k = 0; k < std::min(a.buffers.size(), b.buffers.size()); ++k) {
    const auto &one = a.buffers[k].words, &other = b.buffers[k].words;
    if (one == other || !known.insert(a.buffers[k].name).second) continue;
    const auto at = std::mismatch(one.begin(), one.end(), other.begin(), other.end()).first - one.begin();
    std::size_t count = 0;
    for (std::size_t i = 0; i < std::min(one.size(), other.size()); ++i) count += one[i] != other[i];
    std::printf("tick %d: %s: %zu of %zu words, the first is %td\n", tick, a.buffers[k].name.c_str(), count, one.size(),
                at);
  }
}

}  // namespace

int main(int count, char** arguments) {
  const bool twice = count == 4 && std::strcmp(arguments[3], "twice") == 0;
  if (count != 3 && !twice) return std::fprintf(stderr, "usage: state_hash SCENE_FILE TICKS [twice]\n"), 2;
  auto ctx = gpu::testContext();
  if (!ctx) return std::fprintf(stderr, "%s\n", ctx.error().message.c_str()), 3;
  const auto scene = scene::loadSceneFile(arguments[1]);
  if (!scene) return std::fprintf(stderr, "%s\n", scene.error().message.c_str()), 2;
  const int ticks = std::atoi(arguments[2]);
  auto water = sim::WaterSim::create(**ctx, scene::toCore(*scene));
  if (!water) return std::fprintf(stderr, "%s\n", water.error().message.c_str()), 1;
  auto other = std::unique_ptr<sim::WaterSim>();
  if (twice) {
    auto made = sim::WaterSim::create(**ctx, scene::toCore(*scene));
    if (!made) return std::fprintf(stderr, "%s\n", made.error().message.c_str()), 1;
    other = std::move(*made);
  }
  std::set<std::string> known;
  for (int tick = 0; tick < ticks; ++tick) {
    step(**ctx, **water, tick);
    if (!twice) continue;
    step(**ctx, *other, tick);
    printDifferences(tick, (*water)->savedState(), other->savedState(), known);
  }
  std::printf("%016llx\n", static_cast<unsigned long long>((*water)->stateHash()));
  if (!twice) return 0;
  std::printf("%016llx\n", static_cast<unsigned long long>(other->stateHash()));
  return known.empty() ? 0 : 1;
}
