// A scene's water with a GL context of its own, so that it can be built on one thread and run on another.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <spindrift/core/result.h>
#include <spindrift/gpu/context.h>
#include <spindrift/gpu/device.h>
#include <spindrift/sim/water_sim.h>
#include <spindrift/v1/scene.pb.h>

namespace spindrift::rooms {

/// Owned by one thread at a time: release() on one, then bind() on the other. The destructor waits until no frame of
/// this water is in anybody's hands (they are read from the device's memory), then frees the device's objects.
class Water {
 public:
  /// Builds the scene and runs it for some ticks, so that every shader is compiled, then puts it back to its start; its
  /// ticks have begun to count. The calling thread owns it. Errors: the device's, and those of WaterSim::create().
  static core::Result<std::unique_ptr<Water>> create(const gpu::DeviceChoice& device, v1::Scene scene);
  ~Water();
  Water(const Water&) = delete;
  Water& operator=(const Water&) = delete;

  /// Makes the context current on the calling thread; nothing to do where it is.
  void bind();
  /// Lets another thread bind it.
  void release();

  /// Why this water cannot go on: the device was lost, or does not answer. Asks the driver: on the owning thread, once
  /// per tick is enough.
  [[nodiscard]] std::optional<std::string> failure();
  /// What a tick took while it was built, beside whatever else ran [ms].
  [[nodiscard]] double warmTick_ms() const { return warm_tick_ms_; }

  [[nodiscard]] gpu::Context& context() { return *context_; }
  [[nodiscard]] const gpu::Context& context() const { return *context_; }
  [[nodiscard]] sim::WaterSim& sim() { return *sim_; }
  [[nodiscard]] const sim::WaterSim& sim() const { return *sim_; }
  [[nodiscard]] v1::Scene& scene() { return scene_; }  ///< parameters as they are now
  [[nodiscard]] const v1::Scene& scene() const { return scene_; }

 private:
  Water(std::unique_ptr<gpu::Context> context, std::unique_ptr<sim::WaterSim> sim, v1::Scene scene,
        double warm_tick_ms);

  std::unique_ptr<gpu::Context> context_;
  std::unique_ptr<sim::WaterSim> sim_;
  v1::Scene scene_;
  double warm_tick_ms_ = 0.0;
};

}  // namespace spindrift::rooms
