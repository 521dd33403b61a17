#include "water.h"

#include <chrono>
#include <thread>
#include <utility>

#include <spdlog/spdlog.h>

#include <spindrift/stream/scene_loader.h>

namespace spindrift::app {
namespace {

using namespace std::chrono_literals;

/// A step's shaders are compiled when they first run, which takes a software device seconds; diagnostics run every
/// fourth tick, so as many ticks leave their rhythm as it was.
constexpr int kWarmUpTickCount = 4;
/// The encoder holds a frame for milliseconds; whoever holds one longer has lost it.
constexpr auto kFramePatience = 5s;

void warmUp(gpu::Context& context, sim::WaterSim& sim) {
  for (int i = 0; i < kWarmUpTickCount; ++i) sim.step();
  (void)sim.requestFrame({.surface = true, .particles = true, .foam = true, .bodies = true});
  context.finish();
  (void)sim.takeFrames();
  (void)sim.takePassCosts();
  sim.reset();
}

}  // namespace

core::Result<std::unique_ptr<Water>> Water::create(const gpu::DeviceChoice& device, v1::Scene scene) {
  auto context = gpu::Context::create(device);
  if (!context) return context.error();
  auto sim = sim::WaterSim::create(**context, stream::toCore(scene));
  if (!sim) return sim.error();
  warmUp(**context, **sim);
  return std::unique_ptr<Water>(new Water(*std::move(context), *std::move(sim), std::move(scene)));
}

Water::Water(std::unique_ptr<gpu::Context> context, std::unique_ptr<sim::WaterSim> sim, v1::Scene scene)
    : context_(std::move(context)), sim_(std::move(sim)), scene_(std::move(scene)) {}

Water::~Water() {
  bind();
  sim_.reset();
  const auto deadline = std::chrono::steady_clock::now() + kFramePatience;
  for (context_->collectRetired(); context_->hasRetired() && std::chrono::steady_clock::now() < deadline;
       context_->collectRetired()) {
    std::this_thread::sleep_for(1ms);
  }
}

void Water::bind() {
  if (context_->isOwnedHere() || context_->makeCurrent()) return;
  // Only a bug of ours gets here: two threads with one water.
  spdlog::error("room's GL context cannot be bound: another thread has not released it");
}

void Water::release() {
  if (context_->isOwnedHere()) context_->release();
}

}  // namespace spindrift::app
