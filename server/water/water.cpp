#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include <spdlog/spdlog.h>

#include <spindrift/scene/scene_loader.h>
#include <spindrift/water/water.h>

namespace spindrift::water {
namespace {

using namespace std::chrono_literals;

/// Shaders are compiled when they first run, which takes seconds on a software device. Diagnostics run every fourth
/// tick, so four ticks keep their phase.
constexpr int kWarmUpTickCount = 4;
/// Ends within the first two ticks.
constexpr double kWarmUpEffect_s = 0.01;
/// The encoder holds a frame for milliseconds; a frame held longer than this is lost.
constexpr auto kFramePatience = 5s;

WarmUp runWarm(gpu::Context& context, sim::WaterSim& sim) {
  // A scene without waves has no program to compile for an effect, and refuses it.
  (void)sim.start(core::Splash{.depth_m = 0.01, .duration_s = kWarmUpEffect_s});
  (void)sim.start(core::BreakingWave{.side = core::Side::kPlusX, .amplitude_m = 0.01, .duration_s = kWarmUpEffect_s});
  WarmUp out;
  for (int i = 0; i < kWarmUpTickCount; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    sim.step();
    context.finish();
    const auto duration = std::chrono::steady_clock::now() - begin;
    const double tick_ms = std::chrono::duration<double, std::milli>(duration).count();
    if (i == 0) out = {tick_ms, tick_ms};
    out.least_tick_ms = std::min(out.least_tick_ms, tick_ms);
  }
  sim::FrameRequest request{.bodies = true};
  request.levels.fill({.surface = true, .particles = true, .foam = true});
  (void)sim.requestFrame(request);
  context.finish();
  (void)sim.takeFrames();
  (void)sim.takePassCosts();
  sim.reset();
  return out;
}

}  // namespace

core::Result<std::unique_ptr<Water>> Water::create(const gpu::DeviceChoice& device, v1::Scene scene,
                                                   const KnownScene& known) {
  auto context = gpu::Context::create(device);
  if (!context) return context.error();
  auto sim = sim::WaterSim::create(**context, scene::toCore(scene), known.basins);
  if (!sim) return sim.error();
  const bool is_warm = known.warm_up && known.warm_up->wasQuick();
  const WarmUp warm_up = is_warm ? *known.warm_up : runWarm(**context, **sim);
  spdlog::debug("scene {}: {:.1f} MB on the device", scene.name(),
                static_cast<double>((*context)->ledger().buffer_bytes) / 1e6);
  return std::unique_ptr<Water>(new Water(*std::move(context), *std::move(sim), std::move(scene), warm_up));
}

Water::Water(std::unique_ptr<gpu::Context> context, std::unique_ptr<sim::WaterSim> sim, v1::Scene scene,
             const WarmUp& warm_up)
    : context_(std::move(context)),
      sim_(std::move(sim)),
      scene_(std::move(scene)),
      start_scene_(scene_),
      warm_up_(warm_up) {}

Water::~Water() {
  bind();
  sim_.reset();
  const auto deadline = std::chrono::steady_clock::now() + kFramePatience;
  for (context_->collectRetired(); context_->hasRetired() && std::chrono::steady_clock::now() < deadline;
       context_->collectRetired()) {
    std::this_thread::sleep_for(1ms);
  }
}

std::optional<std::string> Water::failure() {
  if (context_->isLost()) return "the device was lost (" + context_->device().name + ")";
  if (const auto& error = sim_->deviceError()) return error->message;
  return std::nullopt;
}

void Water::bind() {
  if (context_->isOwnedHere() || context_->makeCurrent()) return;
  // Only a bug in the program leads here: two threads use one water.
  spdlog::error("room's GL context cannot be bound: another thread has not released it");
}

void Water::release() {
  if (context_->isOwnedHere()) context_->release();
}

}  // namespace spindrift::water
