// The coupled simulation of one room. Read step() first.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <spindrift/core/frame_view.h>
#include <spindrift/core/result.h>
#include <spindrift/core/scene.h>
#include <spindrift/effects/strokes.h>
#include <spindrift/gpu/buffer.h>
#include <spindrift/gpu/context.h>
#include <spindrift/gpu/pass_timer.h>
#include <spindrift/sim/gauge_history.h>
#include <spindrift/sim/health.h>
#include <spindrift/sim/hull_forces.h>
#include <spindrift/sim/prepared_scene.h>
#include <spindrift/sim/state_buffer.h>
#include <spindrift/sim/surface_sample.h>
#include <spindrift/sim_setup/derive.h>
#include <spindrift/sim_state/carried_state.h>
#include <spindrift/sim_state/saved_state.h>

namespace spindrift::sim {

/// The layers that one level of a frame should contain.
struct LayerRequest {
  bool surface = false;
  bool particles = false;
  bool foam = false;

  [[nodiscard]] bool isEmpty() const { return !surface && !particles && !foam; }
};

/// Parts that a frame should contain. Layers that the scene lacks, and levels that would not downsample a layer, are
/// left out.
struct FrameRequest {
  std::array<LayerRequest, core::kLevelCount> levels{};  ///< indexed by core::Level; see at()
  bool bodies = false;
  bool floaters = false;
  double asked_s = 0.0;                        ///< on the caller's clock; returned with the frame
  std::uint64_t state_id = 0;                  ///< the caller's; returned with the frame
  core::LevelSet due = core::LevelSet::all();  ///< the levels that take the frame; returned with it

  /// Requests layers at core::Level::kFull only.
  [[nodiscard]] static FrameRequest full(const LayerRequest& layers) {
    FrameRequest out;
    out.at(core::Level::kFull) = layers;
    return out;
  }
  /// Requests every layer; those with levels at core::Level::kFull only.
  [[nodiscard]] static FrameRequest allLayers() {
    FrameRequest out = full({.surface = true, .particles = true, .foam = true});
    out.bodies = true;
    out.floaters = true;
    return out;
  }

  [[nodiscard]] bool isEmpty() const {
    return !bodies && !floaters && std::ranges::all_of(levels, &LayerRequest::isEmpty);
  }
  [[nodiscard]] const LayerRequest& at(core::Level level) const { return levels[indexOf(level)]; }
  [[nodiscard]] LayerRequest& at(core::Level level) { return levels[indexOf(level)]; }
};

/// The position to which somebody pulls a floater; as v1::HoldFloater.
struct FloaterHold {
  std::uint32_t floater_id = 0;
  double x_m = 0.0;
  double z_m = 0.0;
  double lift_m = 0.0;
  double turn_radps = 0.0;
  bool ends = false;
};

class BasinStore;

/// Call all functions on the thread that owns the context; ownership may move between two calls (Context::release() and
/// makeCurrent()). Functions that wait for the device say so.
class WaterSim {
 public:
  /// Makes the buffers, programs and starting state for the parts of the scene, and nothing else. `basins`: used during
  /// the call, for the tables of the wave; null: they are computed. Errors: those of derive(), and kInternal when the
  /// device fails.
  static core::Result<std::unique_ptr<WaterSim>> create(gpu::Context& ctx, const core::Scene& scene,
                                                        BasinStore* basins = nullptr);
  ~WaterSim();
  WaterSim(const WaterSim&) = delete;
  WaterSim& operator=(const WaterSim&) = delete;

  /// Advances by one tick. Waits for the device only while kMaxTicksInFlight submitted ticks are unfinished, so that
  /// the duration of this call shows a device that cannot keep up. Does nothing once deviceError() is set.
  void step();
  static constexpr std::size_t kMaxTicksInFlight = 3;
  /// Returns the error that is set when the device has not finished a tick within 10 s, or its context is lost. The
  /// simulation has then stopped: destroy it and create another one, after a lost context on a new context.
  [[nodiscard]] const std::optional<core::Error>& deviceError() const { return device_error_; }

  /// Starts an effect now, on the wave, or on the particles if there is no wave. kUnavailable when too many are active.
  core::Result<void> start(const core::Effect& effect);
  /// Begins or continues a stroke; see Strokes::add().
  core::Result<void> draw(const StrokePart& part);
  /// The strokes on the water, as the last step left them.
  [[nodiscard]] const std::vector<Stroke>& strokes() const;
  /// Adds a boat and returns its id. kInvalidInput in a scene without boats, kUnavailable when all slots are taken.
  core::Result<std::uint32_t> spawnBoat(const core::Boat& boat);
  /// Steers a boat. Error kInvalidInput for an unknown boat.
  core::Result<void> controlBoat(std::uint32_t boat_id, double throttle_ratio, double rudder_ratio);
  core::Result<void> removeBoat(std::uint32_t boat_id);
  /// Sets pose and velocities of a boat now; it continues with these velocities, whatever the water does, until the
  /// next call for it, for at most kMovedFor_s. Then, or after releaseBoat(), it is the water's again. It presses with
  /// the water that it displaces under the rest level, and has neither throttle nor rudder. kInvalidInput for an
  /// unknown boat or in a scene without boats or without a wave; kInternal when the device fails.
  core::Result<void> moveBoat(const HullMotion& motion);
  /// kInvalidInput for an unknown boat; does nothing for one that nobody moves.
  core::Result<void> releaseBoat(std::uint32_t boat_id);
  /// Returns what the water did to moved boats in the ticks whose forces have arrived, oldest first. Never waits.
  std::vector<HullForces> takeHullForces();
  /// Returns the number of ticks whose forces takeHullForces() has not yet returned.
  [[nodiscard]] std::size_t hullForcesInFlight() const;
  [[nodiscard]] std::vector<BoatRecord> boats() const;
  /// Sets the first boat id (default 1); the scene's own boats come first. Ids are not reused; only the scene's own
  /// boats keep theirs after a reset. Call it at the start, before a boat is added or a tick is run.
  void numberBoatsFrom(std::uint32_t first_id);
  /// Returns a number above every id in use; in a scene without boats that of numberBoatsFrom().
  [[nodiscard]] std::uint32_t nextBoatId() const;
  [[nodiscard]] std::uint32_t boatCount() const { return static_cast<std::uint32_t>(boats().size()); }
  /// Adds a floater and returns its id. kInvalidInput in a scene without floaters, kUnavailable when all slots are
  /// taken by the scene's own.
  core::Result<std::uint32_t> spawnFloater(const core::Floater& floater);
  /// kInvalidInput for an unknown floater.
  core::Result<void> holdFloater(const FloaterHold& hold);
  /// kInvalidInput for an unknown floater.
  core::Result<void> removeFloater(std::uint32_t floater_id);
  /// Removes all, the scene's own, too.
  core::Result<void> removeFloaters();
  [[nodiscard]] std::uint32_t floaterCount() const;
  /// Returns the number of particles now; in two-way scenes as of the newest health().
  [[nodiscard]] std::uint32_t particleCount() const;

  /// Applies new parameter values from the next tick on: prepareScene() and adopt() in one call. kInvalidInput, with
  /// nothing changed, when a step rule is violated or the change needs a restart.
  core::Result<void> setScene(const core::Scene& scene);
  /// Returns whether the change lays out the particles anew: another `particles.count` fills the same water, with its
  /// motion. Then prepareScene() is slow enough to need another thread.
  [[nodiscard]] bool relaysParticles(const core::Scene& scene) const;
  /// Copies the input of prepareScene(). Waits for the device only if the particles change.
  [[nodiscard]] SceneBasis sceneBasis(const core::Scene& scene);
  /// Applies the device's part of a change: buffers and uploads, without waiting. Moving water continues from the time
  /// when the basis was copied. Frames in flight are lost if the particles change. kUnavailable when the room has
  /// changed since (another change, a reset, the watchdog): prepare again from a new basis. kInternal when the device
  /// has no memory; then nothing changes.
  core::Result<void> adopt(PreparedScene prepared);
  /// Resets to the starting state at time 0. Parameters keep their present values, and the tick count continues.
  /// Uploads only what changed since the start: particle positions, boats, one uniform block.
  void reset();
  /// Resets to the start of a new WaterSim of the present parameters with this seed (0: the present one): the numbers
  /// of boats and floaters begin at 1 again, too.
  void resetWith(std::uint64_t seed);

  /// Copies what another simulation of the same water needs to continue from here. Waits.
  [[nodiscard]] CarriedState carriedState();
  /// Continues from the state of another simulation instead of the start: same time (to half a tick), water, boats with
  /// their ids, effects and wind sea; resample_state.h says what becomes of each at another resolution. Call it before
  /// a tick is run or after reset(). Parameters are not carried. kInvalidInput, with nothing changed, if it is not the
  /// same water.
  core::Result<void> takeOver(const CarriedState& carried);

  /// Copies everything that another simulation of the same scene, with the same values of its parameters, needs to go
  /// on from here bit for bit. Waits.
  [[nodiscard]] SavedState savedState();
  /// Continues from there: same time since the start, water, particles, boats, effects and wind sea. Gauges record
  /// anew. kInvalidInput, with nothing changed, if the scene lays out other buffers or steps.
  core::Result<void> restore(const SavedState& saved);

  /// Packs a frame of the present state. Returns false when there will be none: all slots are still in use by earlier
  /// frames, or the scene has none of the requested layers.
  bool requestFrame(const FrameRequest& request);
  /// Returns the number of requested frames that takeFrames() has not yet returned, without frames lost through a
  /// change of `particles.count`.
  [[nodiscard]] std::size_t framesInFlight() const;
  /// Returns the finished frames, oldest first, with empty `diagnostics`.
  std::vector<core::FrameView> takeFrames();
  /// Returns the number of levels that downsample this scene: planes, particles.
  [[nodiscard]] core::ReducedCounts reducedCounts() const;

  /// Samples the present state at these points, 1 to kMaxSurfacePoints; takeSamples() returns the values with this
  /// number. Changes nothing in the water. Returns false when there will be none: all slots are still in use by earlier
  /// calls. kInvalidInput without a wave; kInternal when the device fails.
  core::Result<bool> sampleAt(std::span<const SurfacePoint> points, std::uint64_t number);
  /// Returns the values that have arrived, oldest first. Never waits.
  std::vector<SurfaceSamples> takeSamples();
  /// Returns the number of calls of sampleAt() whose values takeSamples() has not yet returned.
  [[nodiscard]] std::size_t samplesInFlight() const;

  /// Returns the newest available health.
  [[nodiscard]] const Health& health() const { return health_; }
  /// Returns the readings of the scene's gauges since the start or the last reset(); null in scenes without gauges.
  /// Like health(), it is some ticks behind.
  [[nodiscard]] std::shared_ptr<const GaugeHistory> gauges() const { return gauges_; }
  /// Measures at these positions, too, from the next tick on; replaces those of the last call. A gauge that was there
  /// keeps its history, which begins with it, and anew at a reset(). kInvalidInput without a wave, or with more than
  /// core::kMaxGauges together with the scene's; kInternal when the device fails; then nothing changes.
  core::Result<void> placeGauges(std::span<const GaugePlace> places);
  /// Returns what this one has read; null for an unknown id.
  [[nodiscard]] std::shared_ptr<const GaugeHistory> placedGauge(std::uint32_t gauge_id) const;
  /// Sums of health() since creation, and the number of times that the watchdog restored the last good checkpoint.
  [[nodiscard]] std::uint64_t nonfiniteCount() const { return nonfinite_count_; }
  [[nodiscard]] std::uint64_t escapedCount() const { return escaped_count_; }
  [[nodiscard]] std::uint64_t recoveredCount() const { return recovered_count_; }
  /// Returns the sum since creation of Health::crowded_count.
  [[nodiscard]] std::uint64_t crowdedCount() const { return crowded_count_; }
  /// Returns the mean cost of each pass since the last call, per scope.
  std::vector<gpu::PassCost> takePassCosts() { return timers_.take(); }

  [[nodiscard]] std::uint64_t tick() const { return tick_; }
  /// Returns the simulated time since the start or the last reset().
  [[nodiscard]] double time_s() const { return static_cast<double>(tick_ - start_tick_) * derived_.tick_s; }
  [[nodiscard]] const core::Scene& scene() const { return scene_; }
  [[nodiscard]] const Derived& derived() const { return derived_; }

  /// Waits for the device, then looks at the health of all ticks so far: gauges have their readings, and the watchdog
  /// has acted if it has to.
  void takeHealth();
  /// Copies the present state. Waits.
  StateCopy copyState();
  /// Replaces what the copy has (sizes must match); the rest of what lasts stays. For tests that need a given state.
  void setState(const StateCopy& state);
  /// Returns hashOf(savedState()): everything that lasts. Equal hashes for equal runs on the same device. Waits.
  std::uint64_t stateHash();
  /// Returns what the parts declare about their buffers. For tests.
  [[nodiscard]] StateBuffers stateBuffers();

 private:
  struct Parts;
  WaterSim(gpu::Context& ctx, core::Scene scene, Derived derived);

  core::Result<void> build(BasinStore* basins);
  bool waitForDevice();
  void uploadStartingState();
  std::vector<double> copyElevation();
  /// nullopt in scenes without.
  std::optional<StateBuffer> carriedBuffer(std::string_view name);
  /// Returns the state that lasts outside the buffers.
  [[nodiscard]] HostState hostState() const;
  /// Continues from there, at so many ticks since the start, with the buffers as they are now.
  void continueWith(const HostState& host, std::uint64_t run_tick);
  core::Result<void> replaceParticles(const PreparedScene& prepared);
  void uploadBasin();
  void startEvents();
  void advanceWave();
  /// Returns the sea that comes in during a wave step; null when none does.
  const gpu::TexelBuffer* advanceSea(std::uint32_t substep);
  void stirParticles();
  void sampleSurface();
  void breakWaves();
  void moveBodies();
  /// Makes the passes for moved boats and binds the uniforms.
  core::Result<void> prepareMovedBoats();
  void emitParticles(std::uint32_t substep);
  void leadSurface(std::uint32_t substep);
  void movePatch();
  void bindSurroundings();
  void mixLandedWater();
  void fadeFoam();
  void predictParticles();
  void buildGrid();
  void advanceParticles();
  void hitFloaters(std::uint32_t substep);
  void measure();
  void watchHealth();
  void recordGauges(const Health& health);
  void saveCheckpoint();
  void recover(const Health& breach);
  void setCareful(bool careful);

  /// Ticks since the start or the last reset; random numbers depend on it, so that a run can be repeated.
  [[nodiscard]] std::uint32_t runTick() const { return static_cast<std::uint32_t>(tick_ - start_tick_); }

  gpu::Context& ctx_;
  core::Scene scene_;
  Derived derived_;
  gpu::PassTimers timers_;
  std::shared_ptr<GaugeHistory> gauges_;
  using PlacedGauges = std::map<std::uint32_t, std::shared_ptr<GaugeHistory>>;
  PlacedGauges placed_gauges_;
  std::unique_ptr<Parts> parts_;
  std::uint64_t tick_ = 0;  ///< never decreases
  std::uint64_t start_tick_ = 0;
  std::uint64_t revision_ = 0;  ///< incremented by changes of scene, layout and time (reset, recovery); see SceneBasis
  std::uint32_t first_boat_id_ = 1;
  Health health_;
  std::uint64_t nonfinite_count_ = 0;
  std::uint64_t escaped_count_ = 0;
  std::uint64_t recovered_count_ = 0;
  std::uint64_t crowded_count_ = 0;
  /// Volume error of the first good health of this state: a later one that differs is a fault. Unset until there is
  /// one.
  std::optional<std::int64_t> ledger_units_;
  std::uint64_t abandoned_until_tick_ = 0;  ///< health of ticks up to this one belongs to an abandoned state
  std::uint64_t careful_until_tick_ = 0;    ///< after a recovery, twice the substeps are used until then
  bool is_careful_ = false;
  std::optional<core::Error> device_error_;
};

}  // namespace spindrift::sim
