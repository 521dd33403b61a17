// The coupled simulation of one room. step() is the page to read first.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <spindrift/core/command.h>
#include <spindrift/core/frame_view.h>
#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/gpu/context.h>
#include <spindrift/gpu/pass_timer.h>
#include <spindrift/sim/boat_record.h>
#include <spindrift/sim/derive.h>
#include <spindrift/sim/health.h>
#include <spindrift/sim/prepared_scene.h>
#include <spindrift/sim/state_copy.h>

namespace spindrift::sim {

/// Which of the layers that come in levels one level of a frame should hold.
struct LayerRequest {
  bool surface = false;
  bool particles = false;
  bool foam = false;

  [[nodiscard]] bool isEmpty() const { return !surface && !particles && !foam; }
};

/// Which layers a frame should hold.
struct FrameRequest {
  bool surface = false;
  bool particles = false;
  bool foam = false;
  bool bodies = false;
  std::array<LayerRequest, core::kReducedLevelCount> reduced{};  ///< besides the full ones; by Level
  double asked_s = 0.0;                                          ///< on the caller's clock: comes back with the frame
  std::uint64_t state_id = 0;                                    ///< the caller's: comes back with the frame

  [[nodiscard]] bool isEmpty() const {
    return !surface && !particles && !foam && !bodies && std::ranges::all_of(reduced, &LayerRequest::isEmpty);
  }
  [[nodiscard]] LayerRequest at(core::Level level) const {
    if (level == core::Level::kFull) return {surface, particles, foam};
    return reduced[indexOf(level)];
  }
};

/// All calls on the thread that owns the context, which may become another one between two calls (Context::release()
/// and makeCurrent()). What waits for the device says so.
class WaterSim {
 public:
  /// Buffers, programs and the starting state for what the scene names, and nothing else. Errors: derive()'s, and
  /// kInternal when the device refuses.
  static core::Result<std::unique_ptr<WaterSim>> create(gpu::Context& ctx, const core::Scene& scene);
  ~WaterSim();
  WaterSim(const WaterSim&) = delete;
  WaterSim& operator=(const WaterSim&) = delete;

  /// Advances by one tick. Waits for the device only while kMaxTicksInFlight ticks are submitted and not done, so that
  /// the time of this call shows a device that cannot keep up. Does nothing once deviceError() is set.
  void step();
  static constexpr std::size_t kMaxTicksInFlight = 3;
  /// Set when the device has not finished a tick within 10 s, or its context is lost. Nothing moves any more: destroy
  /// this simulation and create another, after a lost context on a new one.
  [[nodiscard]] const std::optional<core::Error>& deviceError() const { return device_error_; }

  /// Starts an effect now, on the wave, or on the particles where there is none. kUnavailable when too many are active.
  core::Result<void> start(const core::Effect& effect);
  /// A boat comes to the water; its id. kInvalidInput in a scene without boats, kUnavailable when there is no place.
  core::Result<std::uint32_t> spawnBoat(const core::Boat& boat);
  /// kInvalidInput for a boat that is not on the water.
  core::Result<void> controlBoat(std::uint32_t boat_id, double throttle_ratio, double rudder_ratio);
  core::Result<void> removeBoat(std::uint32_t boat_id);
  [[nodiscard]] std::vector<BoatRecord> boats() const;
  /// Gives boats ids from here on (1 where it is never called), the scene's own first. An id is given once; only the
  /// scene's own boats keep theirs over a reset. At the start, before a boat was launched or a tick was made.
  void numberBoatsFrom(std::uint32_t first_id);
  /// Above every id that was given; what numberBoatsFrom() said in a scene without boats.
  [[nodiscard]] std::uint32_t nextBoatId() const;
  [[nodiscard]] std::uint32_t boatCount() const { return static_cast<std::uint32_t>(boats().size()); }
  /// Particles now; in two-way scenes as of the newest health().
  [[nodiscard]] std::uint32_t particleCount() const;

  /// New parameter values from the next tick on: prepareScene() and adopt() in one call. kInvalidInput when a step rule
  /// breaks or the change needs a restart; then nothing changes.
  core::Result<void> setScene(const core::Scene& scene);
  /// Whether the change has other particles than the running ones: another `particles.count` lays the same water out
  /// anew, in motion as it is. Then prepareScene() takes long enough for a thread of its own.
  [[nodiscard]] bool relaysParticles(const core::Scene& scene) const;
  /// Copies for prepareScene(). Waits for the device where the change has other particles, else not.
  [[nodiscard]] SceneBasis sceneBasis(const core::Scene& scene);
  /// The device's part of a change: buffers and uploads, no waiting. Water in motion goes on from where it was when the
  /// basis was copied; frames on their way are lost where particles are others. kUnavailable when the room has become
  /// another one since (another change, a reset, the watchdog): prepare again from a new basis. kInternal when the
  /// device has no memory; nothing changes then.
  core::Result<void> adopt(PreparedScene prepared);
  /// Back to the starting state at time 0; parameters stay as they are now, ticks go on counting. Uploads what changed
  /// since the start: positions of particles, boats, one block of uniforms.
  void reset();

  /// Packs a frame of the state now. False when none will come: it was dropped because earlier ones are still being
  /// read, or the scene has nothing of what was asked for.
  bool requestFrame(const FrameRequest& request);
  /// Frames that were requested and that takeFrames() is still to return. Frames that are lost on the way (another
  /// `particles.count`) no longer count.
  [[nodiscard]] std::size_t framesInFlight() const;
  /// Frames that have arrived, oldest first. `diagnostics` is left empty.
  std::vector<core::FrameView> takeFrames();
  /// How many levels of a frame have to leave something out: surfaces, particles.
  [[nodiscard]] core::ReducedCounts reducedCounts() const;

  /// Newest health that has arrived.
  [[nodiscard]] const Health& health() const { return health_; }
  /// Sums since creation of what health() reported, and how often the watchdog put the room back to its last good
  /// checkpoint.
  [[nodiscard]] std::uint64_t nonfiniteCount() const { return nonfinite_count_; }
  [[nodiscard]] std::uint64_t escapedCount() const { return escaped_count_; }
  [[nodiscard]] std::uint64_t recoveredCount() const { return recovered_count_; }
  /// Sum since creation of Health::crowded_count.
  [[nodiscard]] std::uint64_t crowdedCount() const { return crowded_count_; }
  /// Mean cost of each pass since the last call, per scope.
  std::vector<gpu::PassCost> takePassCosts() { return timers_.take(); }

  [[nodiscard]] std::uint64_t tick() const { return tick_; }
  /// Simulated time since the start or the last reset().
  [[nodiscard]] double time_s() const { return static_cast<double>(tick_ - start_tick_) * derived_.tick_s; }
  [[nodiscard]] const core::Scene& scene() const { return scene_; }
  [[nodiscard]] const Derived& derived() const { return derived_; }

  /// The state now. Waits.
  StateCopy copyState();
  /// Replaces the state (sizes must match). For tests that need a given state.
  void setState(const StateCopy& state);
  /// 64-bit FNV-1a of the state's bits: equal hashes for equal runs on the same device.
  std::uint64_t stateHash();

 private:
  struct Parts;
  WaterSim(gpu::Context& ctx, core::Scene scene, Derived derived);

  core::Result<void> build();
  bool waitForDevice();
  void uploadStartingState();
  std::vector<double> copyElevation();
  core::Result<void> replaceParticles(const PreparedScene& prepared);
  void uploadBasin();
  void startEvents();
  void advanceWave();
  void stirParticles();
  void sampleSurface();
  void breakWaves();
  void moveBoats();
  void emitParticles(std::uint32_t substep);
  void leadSurface(std::uint32_t substep);
  void movePatch();
  void bindSurroundings();
  void fadeFoam();
  void predictParticles();
  void buildGrid();
  void advanceParticles();
  void measure();
  void watchHealth();
  void saveCheckpoint();
  void recover(const Health& breach);
  void setCareful(bool careful);

  /// Ticks since the start or the last reset: what chance is drawn by, so that a run repeats.
  [[nodiscard]] std::uint32_t runTick() const { return static_cast<std::uint32_t>(tick_ - start_tick_); }

  gpu::Context& ctx_;
  core::Scene scene_;
  Derived derived_;
  gpu::PassTimers timers_;
  std::unique_ptr<Parts> parts_;
  std::uint64_t tick_ = 0;  ///< never goes back
  std::uint64_t start_tick_ = 0;
  std::uint64_t revision_ = 0;  ///< of scene, layout and course of time; see SceneBasis
  std::uint32_t first_boat_id_ = 1;
  Health health_;
  std::uint64_t nonfinite_count_ = 0;
  std::uint64_t escaped_count_ = 0;
  std::uint64_t recovered_count_ = 0;
  std::uint64_t crowded_count_ = 0;
  std::uint64_t abandoned_until_tick_ = 0;  ///< health of ticks up to this one belongs to a state that was given up
  std::uint64_t careful_until_tick_ = 0;    ///< after a recovery: twice the substeps until then
  bool is_careful_ = false;
  std::optional<core::Error> device_error_;
};

}  // namespace spindrift::sim
