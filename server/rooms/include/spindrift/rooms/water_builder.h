// Builds water, and works out changes of it, beside the running rooms; takes down what they let go of.
#pragma once

#include <functional>
#include <future>
#include <memory>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/gpu/device.h>
#include <spindrift/rooms/water.h>
#include <spindrift/rooms/worker.h>
#include <spindrift/sim/prepared_scene.h>
#include <spindrift/v1/scene.pb.h>

namespace spindrift::rooms {

/// What waits is bounded by its callers: a room has one build and one change under way.
class WaterBuilder {
 public:
  using Built = core::Result<std::unique_ptr<Water>>;
  using Prepared = core::Result<sim::PreparedScene>;

  /// `done` is called after each piece of work, on a thread of the builder.
  explicit WaterBuilder(gpu::DeviceChoice device, std::function<void()> done = {});
  /// Ends after the work at hand; builds and changes that wait end with kUnavailable.
  ~WaterBuilder() = default;
  WaterBuilder(const WaterBuilder&) = delete;
  WaterBuilder& operator=(const WaterBuilder&) = delete;

  /// Any thread. At a lower priority than the simulation. The water comes released: the caller binds it. Errors:
  /// Water::create()'s; kUnavailable at the end.
  std::future<Built> build(v1::Scene scene);
  /// Any thread. sim::prepareScene() on a thread of its own, behind no build: a room waits for it without a tick.
  /// Errors: its own; kUnavailable at the end.
  std::future<Prepared> prepare(core::Scene scene, sim::SceneBasis basis);
  /// Destroys the water, which the calling thread has bound.
  void dispose(std::unique_ptr<Water> water);

 private:
  const gpu::DeviceChoice device_;
  Worker builds_;
  Worker changes_;
};

}  // namespace spindrift::rooms
