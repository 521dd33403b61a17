#include <bit>
#include <cassert>
#include <cstddef>
#include <optional>
#include <span>

#include <spindrift/codec/frame_encoder.h>

#include "frame_checks.h"
#include "layer_encoders.h"

namespace spindrift::codec {
namespace {

static_assert(std::endian::native == std::endian::little, "packed words are sent as they lie in memory");

/// Returns a keyframe with the first bytes of the words as its payload.
core::SharedBytes plain(const core::FrameView& frame, v1::Layer layer, core::Level level, const v1::LayerFrame& codec,
                        std::span<const std::uint32_t> words, std::size_t byte_count) {
  assert(byte_count <= words.size_bytes() && byte_count + 4 > words.size_bytes());
  const auto* payload = reinterpret_cast<const std::uint8_t*>(words.data());
  return serializeFrame(frame, layer, level, std::nullopt, codec, {payload, byte_count});
}

core::SharedBytes plainSurface(const core::FrameView& frame, core::Level level) {
  if (!frame.at(level).surface) return nullptr;
  const core::SurfaceView& surface = *frame.at(level).surface;
  v1::LayerFrame codec;
  v1::SurfaceFixed16& header = *codec.mutable_surface_fixed16();
  setExtents({surface.count, surface.length_m, surface.width_m}, header);
  header.set_quantum_m(surface.quantum_m);
  return plain(frame, v1::LAYER_SURFACE, level, codec, surface.words, 2 * surface.count.total());
}

core::SharedBytes plainParticles(const core::FrameView& frame, core::Level level) {
  if (!frame.at(level).particles) return nullptr;
  const core::ParticleView& particles = *frame.at(level).particles;
  assert(particles.words.size() == std::size_t{3} * particles.count);
  v1::LayerFrame codec;
  v1::ParticlesFixed12& header = *codec.mutable_particles_fixed12();
  header.set_count(particles.count);
  header.set_min_x_m(particles.min_m[0]);
  header.set_min_y_m(particles.min_m[1]);
  header.set_min_z_m(particles.min_m[2]);
  header.set_max_x_m(particles.max_m[0]);
  header.set_max_y_m(particles.max_m[1]);
  header.set_max_z_m(particles.max_m[2]);
  header.set_max_speed_mps(particles.max_speed_mps);
  header.set_radius_m(particles.radius_m);
  return plain(frame, v1::LAYER_PARTICLES, level, codec, particles.words, particles.words.size_bytes());
}

core::SharedBytes plainFoam(const core::FrameView& frame, core::Level level) {
  if (!frame.at(level).foam) return nullptr;
  const core::FoamView& foam = *frame.at(level).foam;
  v1::LayerFrame codec;
  setExtents({foam.count, foam.length_m, foam.width_m}, *codec.mutable_foam_fixed8());
  return plain(frame, v1::LAYER_FOAM, level, codec, foam.words, foam.count.total());
}

/// Boats or floaters; `mutableHeader` returns the header of their codec.
template <typename View, typename Header>
core::SharedBytes plainObjects(const core::FrameView& frame, v1::Layer layer, const std::optional<View>& objects,
                               Header* (v1::LayerFrame::*mutableHeader)()) {
  if (!objects) return nullptr;
  assert(objects->words.size() == std::size_t{7} * objects->count);
  v1::LayerFrame codec;
  (codec.*mutableHeader)()->set_count(objects->count);
  return plain(frame, layer, core::Level::kFull, codec, objects->words, objects->words.size_bytes());
}

}  // namespace

struct FrameEncoder::Packed {
  PackedPlanes surface, foam;
  PackedParticles particles;
  PackedFloaters floaters;
};

FrameEncoder::FrameEncoder() : packed_(std::make_unique<Packed[]>(core::kLevelCount)) {}
FrameEncoder::~FrameEncoder() = default;

EncodedFrame FrameEncoder::encode(Stream stream, const core::FrameView& frame, core::Level level, bool wants_keyframe) {
  const bool is_packed = stream.packing == v1::PACKING_PACKED;
  Packed& packed = packed_[core::indexOf(level)];
  if (level != core::Level::kFull && (!hasLevels(stream.layer) || (stream.layer == v1::LAYER_FLOATERS && !is_packed)))
    return {};
  switch (stream.layer) {
    case v1::LAYER_SURFACE:
      if (is_packed) return packed.surface.encode(frame, stream.layer, level, wants_keyframe);
      return {plainSurface(frame, level), nullptr};
    case v1::LAYER_PARTICLES:
      return {is_packed ? packed.particles.encode(frame, level) : plainParticles(frame, level), nullptr};
    case v1::LAYER_FOAM:
      if (is_packed) return packed.foam.encode(frame, stream.layer, level, wants_keyframe);
      return {plainFoam(frame, level), nullptr};
    case v1::LAYER_BODIES:
      if (is_packed) return {};
      return {plainObjects(frame, stream.layer, frame.bodies, &v1::LayerFrame::mutable_bodies_fixed28), nullptr};
    case v1::LAYER_FLOATERS:
      if (is_packed) return packed.floaters.encode(frame, level, wants_keyframe);
      return {plainObjects(frame, stream.layer, frame.floaters, &v1::LayerFrame::mutable_floaters_fixed28), nullptr};
    case v1::LAYER_DIAGNOSTICS:
      return {is_packed ? nullptr : serializeDiagnostics(frame), nullptr};
    default:
      return {};
  }
}

}  // namespace spindrift::codec
