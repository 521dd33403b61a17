// Builds water and prepares changes of it on threads beside the running rooms; destroys water no longer used.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <string>

#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/core/worker.h>
#include <spindrift/gpu/device.h>
#include <spindrift/sim/prepared_scene.h>
#include <spindrift/sim_setup/basin_store.h>
#include <spindrift/v1/scene.pb.h>
#include <spindrift/water/water.h>

namespace spindrift::water {

/// The callers bound the queue: a room has at most one build and one change under way.
class WaterBuilder {
 public:
  using Built = core::Result<std::unique_ptr<Water>>;
  using Prepared = core::Result<sim::PreparedScene>;
  /// kMayBeCold: nobody waits for the first tick, and warmUp() need not be of now; then the water makes no ticks that
  /// compile shaders if the driver keeps them.
  enum class FirstTick { kIsWarm, kMayBeCold };

  /// Water of the scenes listed in `scenes` gets its costs at every level. `done` is called after each piece of work,
  /// on a thread of the builder.
  explicit WaterBuilder(gpu::DeviceChoice device, SceneCatalog scenes = {}, const std::function<void()>& done = {});
  /// Ends after the current work; waiting builds and changes end with kUnavailable.
  ~WaterBuilder() = default;
  WaterBuilder(const WaterBuilder&) = delete;
  WaterBuilder& operator=(const WaterBuilder&) = delete;

  /// Any thread. The water is returned released: the caller binds it. The second of a scene is ready sooner: the tables
  /// of the basin are kept.
  /// Errors: those of Water::create(); kUnavailable when the builder ends.
  std::future<Built> build(v1::Scene scene, FirstTick first_tick = FirstTick::kIsWarm);
  /// Any thread. From now on builds at a lower priority than the simulation. To be called when a room runs, and not
  /// before its water is built: that starts the threads of a software rasteriser, which compute the ticks of all rooms.
  void yieldToRooms();
  /// Any thread. Runs sim::prepareScene() on a separate thread and not behind builds, because a room's ticks wait for
  /// it. Errors: those of prepareScene(); kUnavailable when the builder ends.
  std::future<Prepared> prepare(core::Scene scene, sim::SceneBasis basis);
  /// Any thread. From now on waiting and new builds and changes end with kUnavailable. A build that runs cannot be
  /// interrupted: hasEnded() says when it is over.
  void end() {
    builds_.end();
    changes_.end();
  }
  [[nodiscard]] bool hasEnded() const { return builds_.isIdle() && changes_.isIdle(); }
  /// Any thread. Returns whether no water is being built or destroyed.
  [[nodiscard]] bool isIdle() const { return builds_.isIdle(); }
  /// Any thread. Returns how many waters could not be built since the start, for one cause.
  [[nodiscard]] std::uint64_t failureCount(core::ErrorCode cause) const {
    return failure_counts_[static_cast<std::size_t>(cause)];
  }
  /// Destroys the water, which must be bound to the calling thread.
  void dispose(std::unique_ptr<Water> water);

 private:
  const gpu::DeviceChoice device_;
  const SceneCatalog scenes_;
  // What builds leave for the next ones of the same scene; on the thread of builds_ only.
  sim::BasinStore basins_;
  std::map<std::string, WarmUp> warm_ups_;  ///< by the bytes of the scene
  std::array<std::atomic<std::uint64_t>, static_cast<std::size_t>(core::ErrorCode::kInternal) + 1> failure_counts_{};
  core::Worker builds_;
  core::Worker changes_;
};

}  // namespace spindrift::water
