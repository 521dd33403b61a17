// A software device for the simulation's tests, and starting scenes.
#pragma once

#include <memory>

#include <gtest/gtest.h>

#include <spindrift/gpu/context.h>
#include <spindrift/sim/water_sim.h>

namespace spindrift::sim {

class OnDevice : public ::testing::Test {
 protected:
  void SetUp() override {
    auto context = gpu::Context::create({gpu::DeviceChoice::Kind::kSoftware, 0});
    if (!context) GTEST_SKIP() << "no software EGL device here: " << context.error().message;
    ctx_ = *std::move(context);
  }
  void TearDown() override {
    sim_.reset();
    if (ctx_) {
      EXPECT_EQ(ctx_->takeFaults(), std::vector<std::string>{}) << "missing barriers";
      EXPECT_EQ(ctx_->debugErrorCount(), 0u) << "the driver complained; see the log";
    }
  }

  WaterSim& make(const core::Scene& scene) {
    auto made = WaterSim::create(*ctx_, scene);
    if (!made) throw std::runtime_error(made.error().message);
    sim_ = *std::move(made);
    return *sim_;
  }

  std::unique_ptr<gpu::Context> ctx_;
  std::unique_ptr<WaterSim> sim_;
};

/// A small scene with every part: 32^2 wave of 8 m, about `count` particles in 3 layers.
inline core::Scene smallScene(std::uint32_t count = 600) {
  core::Scene scene;
  scene.name = "test";
  scene.wave.emplace();
  scene.wave->resolution_count = 32;
  scene.wave->side_m = 8.0;
  scene.particles.emplace();
  scene.particles->count = count;
  scene.particles->viscosity_pas = 100.0;
  scene.particles->headroom_m = 3.0;
  scene.coupling.emplace();
  scene.foam.emplace();
  return scene;
}

}  // namespace spindrift::sim
