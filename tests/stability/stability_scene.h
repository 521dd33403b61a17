// A shipped scene on the software device, for long runs.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include <spindrift/gpu/context.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/sim/water_sim.h>

#include "test_device.h"

namespace spindrift {

/// What is thrown into a basin and the waves that come of it, over those of a basin of at least 6 m: 1 there.
inline double basinRatio(double length_m) {
  return std::min(1.0, length_m / 6.0);
}

class Endurance : public ::testing::Test {
 public:
  static std::filesystem::path sceneFolder() { return std::filesystem::path(SPINDRIFT_SOURCE_DIR) / "server/scenes"; }
  /// `level`: that of the file by default.
  static v1::Scene shipped(const std::string& name, std::optional<v1::Fidelity> level = {}) {
    auto scene = scene::loadSceneFile(sceneFolder() / (name + ".textproto"), level);
    if (!scene) throw std::runtime_error(scene.error().message);
    return *scene;
  }
  /// Returns the scene with its lattice as it is laid out: to settle takes a still pool 720 ticks at each creation.
  static v1::Scene unsettled(v1::Scene scene) {
    if (scene.has_particles()) scene.mutable_particles()->clear_settle_s();
    return scene;
  }

 protected:
  void SetUp() override {
    auto ctx = gpu::testContext();
    if (!ctx) GTEST_SKIP() << "no device: " << ctx.error().message;
    ctx_ = *std::move(ctx);
  }
  void TearDown() override {
    water_.reset();
    if (ctx_) {
      EXPECT_EQ(ctx_->debugErrorCount(), 0u) << "the driver complained; see the log";
    }
  }

  sim::WaterSim& make(const core::Scene& scene) {
    auto made = sim::WaterSim::create(*ctx_, scene);
    if (!made) throw std::runtime_error(made.error().message);
    water_ = *std::move(made);
    return *water_;
  }

  /// Returns the level of a test that this variable of the environment makes long: that of the file; else DRAFT, with a
  /// quarter of the cells.
  static std::optional<v1::Fidelity> levelFor(const char* variable) {
    return std::getenv(variable) ? std::nullopt : std::optional(v1::FIDELITY_DRAFT);
  }

  /// Reads a number from the environment, for runs longer than the default.
  static int wanted(const char* variable, int otherwise) {
    const char* text = std::getenv(variable);
    return text ? std::atoi(text) : otherwise;
  }

  std::unique_ptr<gpu::Context> ctx_;
  std::unique_ptr<sim::WaterSim> water_;
};

}  // namespace spindrift
