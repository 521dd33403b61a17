// Frames for the stream: quantized and packed on the device, copied into a readback ring, handed over when the fence
// says so.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include <spindrift/core/frame_view.h>
#include <spindrift/core/result.h>
#include <spindrift/gpu/buffer.h>
#include <spindrift/gpu/program.h>
#include <spindrift/gpu/readback_ring.h>
#include <spindrift/sim/derive.h>

#include "boats.h"
#include "particle_buffers.h"
#include "particle_pool.h"
#include "surface_foam.h"
#include "wave.h"

namespace spindrift::sim {

class FramePacker {
 public:
  static core::Result<std::unique_ptr<FramePacker>> create(gpu::Context& ctx, const core::Scene& scene,
                                                           const Derived& derived, const gpu::Defines& defines);

  /// Buffers for another number of particles, the same programs; frames on their way are lost. An error changes
  /// nothing.
  core::Result<void> resize(const Derived& derived);

  /// What a frame should hold; parts that are null it does not. `population` goes with `particles`.
  struct Parts {
    Wave* wave = nullptr;
    const ParticleBuffers* particles = nullptr;
    const Population* population = nullptr;
    SurfaceFoam* foam = nullptr;
    Boats* boats = nullptr;
  };
  /// False when every slot is still in use: the frame is dropped.
  bool pack(std::uint64_t tick, double time_s, const Parts& parts);
  /// Frames whose copy has finished, oldest first.
  std::vector<core::FrameView> poll(const core::Scene& scene, const Derived& derived);

 private:
  explicit FramePacker(gpu::Context& ctx) : ctx_(ctx) {}

  /// What a submitted slot holds.
  struct Pending {
    std::uint64_t tick;
    double time_s;
    bool has_surface;
    bool has_particles;
    bool has_foam;
    std::uint32_t boat_count;
    bool has_boats;
  };

  gpu::Context& ctx_;
  std::uint32_t particles_ = 0;
  bool is_pooled_ = false;
  /// A slot holds surface, particles, pool, foam, boats, in this order; absent parts take no room.
  std::size_t surface_words_ = 0;
  std::size_t particle_words_ = 0;
  std::size_t pool_words_ = 0;
  std::size_t foam_words_ = 0;
  std::size_t body_words_ = 0;
  gpu::Buffer packed_surface_, packed_particles_, packed_foam_, packed_bodies_;
  gpu::Program pack_surface_, pack_particles_, pack_foam_, pack_bodies_;
  std::unique_ptr<gpu::ReadbackRing> ring_;
  std::deque<Pending> pending_;
};

}  // namespace spindrift::sim
