// Frames for the stream: quantized and packed on the device, copied into a readback ring, returned when the copy's
// fence has signalled.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include <spindrift/core/frame_view.h>
#include <spindrift/sim/water_sim.h>

#include "boats.h"
#include "creation.h"
#include "floaters.h"
#include "particle_buffers.h"
#include "particle_pool.h"
#include "surface_foam.h"
#include "wave.h"

namespace spindrift::sim {

class FramePacker {
 public:
  FramePacker(Creation& create, const core::Scene& scene, const Derived& derived);

  /// Replaces the buffers for another number of particles and keeps the programs. Frames in flight are lost. An error
  /// changes nothing.
  void resize(Creation& create, const core::Scene& scene, const Derived& derived);

  /// The parts to pack from. Frames have no layers of parts that are null. `population` belongs to `particles`.
  struct Parts {
    Wave* wave = nullptr;
    const ParticleBuffers* particles = nullptr;
    const Population* population = nullptr;
    SurfaceFoam* foam = nullptr;
    Boats* boats = nullptr;
    Floaters* floaters = nullptr;
  };
  /// `scene` and `derived` are those of the uniforms that are bound: what the packed words mean is noted with the
  /// frame, because parameters may change before poll() returns it. Returns false when there will be no frame: no
  /// requested layer exists, or all slots are in use.
  bool pack(std::uint64_t tick, double time_s, const core::Scene& scene, const Derived& derived, const Parts& parts,
            const FrameRequest& request);
  /// Returns the frames whose copy has finished, oldest first.
  std::vector<core::FrameView> poll();
  /// Number of packed frames that poll() has not yet returned.
  [[nodiscard]] std::size_t inFlightCount() const { return pending_.size(); }

 private:
  /// Offsets of the parts in a slot, in words; absent parts have none.
  struct Places {
    std::optional<std::size_t> surface, particles, foam;
  };
  /// Contents of a submitted slot.
  struct Pending {
    std::uint64_t number = 0;  ///< the slot's tag; increases with each pack()
    /// Without words and lease. The particles have the count of their budget and the radius of all particles.
    core::FrameView frame;
    std::array<Places, core::kLevelCount> places{};
    std::optional<std::size_t> bodies, floaters;
  };

  [[nodiscard]] core::CellCounts surfaceCount(core::Level level) const;
  [[nodiscard]] core::CellCounts foamCount(core::Level level) const;
  [[nodiscard]] std::uint32_t particleBudget(core::Level level) const;
  void packLevel(core::Level level, const LayerRequest& wanted, const core::Scene& scene, const Derived& derived,
                 const Parts& parts, Pending& pending, std::size_t& at);
  void packPlane(Pass& pass, std::size_t at, core::CellCounts count, std::size_t word_count);

  [[nodiscard]] core::ParticleView particleView(core::Level level, const core::Scene& scene,
                                                const Derived& derived) const;

  gpu::Context& ctx_;
  core::CellCounts surface_;  ///< cells of the surface; 0 without one
  std::uint32_t particles_ = 0;
  std::size_t body_words_ = 0;  ///< of a frame, as the next
  std::size_t floater_words_ = 0;
  core::ReducedCounts reduced_counts_;
  gpu::Buffer packed_;  ///< one frame, its parts in a row
  Pass pack_surface_, pack_particles_, pack_foam_, pack_bodies_, pack_floaters_;
  std::unique_ptr<gpu::ReadbackRing> ring_;
  std::deque<Pending> pending_;
  std::uint64_t packed_count_ = 0;
};

}  // namespace spindrift::sim
