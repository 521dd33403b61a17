// A scene's water with its own GL context, so that one thread can build it and another run it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <spindrift/core/result.h>
#include <spindrift/gpu/context.h>
#include <spindrift/gpu/device.h>
#include <spindrift/sim/water_sim.h>
#include <spindrift/v1/scene.pb.h>
#include <spindrift/water/tick_cost.h>

namespace spindrift::water {

/// The ticks that compile every shader of new water. [ms]
struct WarmUp {
  double first_tick_ms = 0.0;
  double least_tick_ms = 0.0;

  /// Returns whether the driver had the shaders compiled: then the next water of the same scene needs no such ticks.
  [[nodiscard]] bool wasQuick() const { return first_tick_ms < 10 * least_tick_ms; }
};

/// Tables and times that other water has left.
struct KnownScene {
  sim::BasinStore* basins = nullptr;  ///< that of WaterSim::create()
  std::optional<WarmUp> warm_up{};    ///< of water of the same scene
};

/// Owned by one thread at a time: release() on the old thread, then bind() on the new one. The destructor waits until
/// all frames of this water are dropped, because they are read from device memory, then frees the device's objects.
class Water {
 public:
  /// Builds the scene and runs some ticks, so that every shader is compiled, then resets it to its start; the tick
  /// count does not start at 0. Without these ticks if such water has made them quickly. The calling thread owns it.
  /// Errors: those of the device and of WaterSim::create(); kUnavailable when the device has no memory for the scene.
  static core::Result<std::unique_ptr<Water>> create(const gpu::DeviceChoice& device, v1::Scene scene,
                                                     const KnownScene& known = {});
  ~Water();
  Water(const Water&) = delete;
  Water& operator=(const Water&) = delete;

  /// Makes the context current on the calling thread; does nothing if it is already.
  void bind();
  /// Unbinds the context so that another thread can bind it.
  void release();

  /// Returns the reason why this water cannot continue: the device was lost or does not answer. Asks the driver; call
  /// it on the owning thread, once per tick is enough.
  [[nodiscard]] std::optional<std::string> failure();
  /// Returns the ticks while it was built, or those of the water before, with other work running.
  [[nodiscard]] const WarmUp& warmUp() const { return warm_up_; }
  [[nodiscard]] double warmTick_ms() const { return warm_up_.least_tick_ms; }

  [[nodiscard]] gpu::Context& context() { return *context_; }
  [[nodiscard]] const gpu::Context& context() const { return *context_; }
  [[nodiscard]] sim::WaterSim& sim() { return *sim_; }
  [[nodiscard]] const sim::WaterSim& sim() const { return *sim_; }
  [[nodiscard]] v1::Scene& scene() { return scene_; }  ///< with current parameter values
  [[nodiscard]] const v1::Scene& scene() const { return scene_; }
  /// As it was built.
  [[nodiscard]] const v1::Scene& startScene() const { return start_scene_; }
  /// Returns the costs of the scene as it was built; without levels unless setLevelCosts() was called.
  [[nodiscard]] const LevelCosts& levelCosts() const { return level_costs_; }
  void setLevelCosts(LevelCosts costs) { level_costs_ = std::move(costs); }

 private:
  Water(std::unique_ptr<gpu::Context> context, std::unique_ptr<sim::WaterSim> sim, v1::Scene scene,
        const WarmUp& warm_up);

  std::unique_ptr<gpu::Context> context_;
  std::unique_ptr<sim::WaterSim> sim_;
  v1::Scene scene_;
  const v1::Scene start_scene_;
  WarmUp warm_up_;
  LevelCosts level_costs_;
};

}  // namespace spindrift::water
