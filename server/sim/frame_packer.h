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

#include "particle_buffers.h"
#include "wave.h"

namespace spindrift::sim {

class FramePacker {
 public:
  static core::Result<std::unique_ptr<FramePacker>> create(gpu::Context& ctx, const Derived& derived,
                                                           const gpu::Defines& defines);

  /// Buffers for another number of particles, the same programs; frames on their way are lost. An error changes
  /// nothing.
  core::Result<void> resize(const Derived& derived);

  /// Packs what is not null. False when every slot is still in use: the frame is dropped.
  bool pack(std::uint64_t tick, double time_s, const ParticleBuffers* particles, Wave* wave);
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
  };

  gpu::Context& ctx_;
  std::uint32_t particles_ = 0;
  std::size_t surface_words_ = 0;
  gpu::Buffer packed_surface_, packed_particles_;
  gpu::Program pack_surface_, pack_particles_;
  std::unique_ptr<gpu::ReadbackRing> ring_;
  std::deque<Pending> pending_;
};

}  // namespace spindrift::sim
