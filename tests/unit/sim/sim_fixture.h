// A device for the simulation's tests.
#pragma once

#include <memory>

#include <gtest/gtest.h>

#include <spindrift/gpu/context.h>
#include <spindrift/sim/water_sim.h>

#include "small_scene.h"
#include "test_device.h"

namespace spindrift::sim {

class OnDevice : public ::testing::Test {
 protected:
  void SetUp() override {
    auto context = gpu::testContext();
    if (!context) GTEST_SKIP() << "no device: " << context.error().message;
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

}  // namespace spindrift::sim
