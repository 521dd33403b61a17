#include <bit>
#include <cassert>
#include <cstddef>
#include <span>
#include <utility>

#include <google/protobuf/io/coded_stream.h>

#include <spindrift/stream/crc32c.h>
#include <spindrift/stream/frame_encoder.h>
#include <spindrift/stream/server_message.h>

namespace spindrift::stream {
namespace {

static_assert(std::endian::native == std::endian::little, "packed words are sent as they lie in memory");

using google::protobuf::io::CodedOutputStream;

constexpr std::uint32_t kWireFixed32 = 5;
constexpr std::uint32_t kWireLengthDelimited = 2;

constexpr std::uint32_t tagOf(int field_number, std::uint32_t wire_type) {
  return static_cast<std::uint32_t>(field_number) << 3 | wire_type;
}

constexpr std::uint32_t kFrameTag = tagOf(v1::ServerMessage::kFrameFieldNumber, kWireLengthDelimited);
constexpr std::uint32_t kCrcTag = tagOf(v1::LayerFrame::kCrc32CFieldNumber, kWireFixed32);
constexpr std::uint32_t kPayloadTag = tagOf(v1::LayerFrame::kPayloadFieldNumber, kWireLengthDelimited);
static_assert(kFrameTag < 0x80 && kCrcTag < 0x80 && kPayloadTag < 0x80, "tags are written as one byte");
constexpr std::size_t kCrcFieldBytes = 1 + 4;

std::uint8_t* appendMessage(const google::protobuf::MessageLite& message, std::uint8_t* at) {
  return message.SerializeWithCachedSizesToArray(at);
}

/// A keyframe as ServerMessage bytes. The payload is written by hand so that the words are copied exactly once;
/// serialized pieces of a message may be concatenated, and here they stand in the order of their field numbers.
core::SharedBytes serializeKeyframe(const core::FrameView& frame, v1::Layer layer, const v1::LayerFrame& codec,
                                    std::span<const std::uint32_t> words) {
  v1::LayerFrame head;
  head.set_layer(layer);
  head.set_tick(frame.tick);
  head.set_time_s(frame.time_s);
  head.set_keyframe(true);

  const auto payload_size = static_cast<std::uint32_t>(words.size_bytes());
  const std::size_t before_payload =
      head.ByteSizeLong() + kCrcFieldBytes + codec.ByteSizeLong() + 1 + CodedOutputStream::VarintSize32(payload_size);
  const auto frame_size = static_cast<std::uint32_t>(before_payload + payload_size);
  const std::size_t prefix_size = 1 + CodedOutputStream::VarintSize32(frame_size) + before_payload;

  core::Bytes bytes;
  bytes.reserve(prefix_size + payload_size);
  bytes.resize(prefix_size);
  // The checksum reads the copy: the words may lie in memory mapped from the device, slow to read twice.
  const auto* payload = reinterpret_cast<const std::uint8_t*>(words.data());
  bytes.insert(bytes.end(), payload, payload + payload_size);
  const std::uint32_t crc = crc32c(core::ByteView(bytes).subspan(prefix_size));

  std::uint8_t* at = bytes.data();
  *at++ = static_cast<std::uint8_t>(kFrameTag);
  at = CodedOutputStream::WriteVarint32ToArray(frame_size, at);
  at = appendMessage(head, at);
  *at++ = static_cast<std::uint8_t>(kCrcTag);
  at = CodedOutputStream::WriteLittleEndian32ToArray(crc, at);
  at = appendMessage(codec, at);
  *at++ = static_cast<std::uint8_t>(kPayloadTag);
  at = CodedOutputStream::WriteVarint32ToArray(payload_size, at);
  assert(at == bytes.data() + prefix_size);
  return core::share(std::move(bytes));
}

class SurfaceFixed16Codec final : public LayerCodec {
 public:
  v1::Layer layer() const override { return v1::LAYER_SURFACE; }

  core::SharedBytes encode(const core::FrameView& frame) override {
    if (!frame.surface) return nullptr;
    const core::SurfaceView& surface = *frame.surface;
    assert(surface.words.size() * 2 == std::size_t{surface.resolution_count} * surface.resolution_count);
    v1::LayerFrame codec;
    v1::SurfaceFixed16& header = *codec.mutable_surface_fixed16();
    header.set_resolution_count(surface.resolution_count);
    header.set_side_m(surface.side_m);
    header.set_quantum_m(surface.quantum_m);
    return serializeKeyframe(frame, v1::LAYER_SURFACE, codec, surface.words);
  }

  void requestKeyframe() override {}
};

class ParticlesFixed12Codec final : public LayerCodec {
 public:
  v1::Layer layer() const override { return v1::LAYER_PARTICLES; }

  core::SharedBytes encode(const core::FrameView& frame) override {
    if (!frame.particles) return nullptr;
    const core::ParticleView& particles = *frame.particles;
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
    return serializeKeyframe(frame, v1::LAYER_PARTICLES, codec, particles.words);
  }

  void requestKeyframe() override {}
};

class FoamFixed8Codec final : public LayerCodec {
 public:
  v1::Layer layer() const override { return v1::LAYER_FOAM; }

  core::SharedBytes encode(const core::FrameView& frame) override {
    if (!frame.foam) return nullptr;
    const core::FoamView& foam = *frame.foam;
    assert(foam.words.size() * 4 == std::size_t{foam.resolution_count} * foam.resolution_count);
    v1::LayerFrame codec;
    codec.mutable_foam_fixed8()->set_resolution_count(foam.resolution_count);
    codec.mutable_foam_fixed8()->set_side_m(foam.side_m);
    return serializeKeyframe(frame, v1::LAYER_FOAM, codec, foam.words);
  }

  void requestKeyframe() override {}
};

class BodiesFixed28Codec final : public LayerCodec {
 public:
  v1::Layer layer() const override { return v1::LAYER_BODIES; }

  core::SharedBytes encode(const core::FrameView& frame) override {
    if (!frame.bodies) return nullptr;
    assert(frame.bodies->words.size() == std::size_t{7} * frame.bodies->count);
    v1::LayerFrame codec;
    codec.mutable_bodies_fixed28()->set_count(frame.bodies->count);
    return serializeKeyframe(frame, v1::LAYER_BODIES, codec, frame.bodies->words);
  }

  void requestKeyframe() override {}
};

class DiagnosticsCodec final : public LayerCodec {
 public:
  v1::Layer layer() const override { return v1::LAYER_DIAGNOSTICS; }
  core::SharedBytes encode(const core::FrameView& frame) override { return diagnostics(frame); }
  void requestKeyframe() override {}
};

}  // namespace

std::unique_ptr<LayerCodec> makeSurfaceFixed16Codec() {
  return std::make_unique<SurfaceFixed16Codec>();
}
std::unique_ptr<LayerCodec> makeParticlesFixed12Codec() {
  return std::make_unique<ParticlesFixed12Codec>();
}
std::unique_ptr<LayerCodec> makeFoamFixed8Codec() {
  return std::make_unique<FoamFixed8Codec>();
}
std::unique_ptr<LayerCodec> makeBodiesFixed28Codec() {
  return std::make_unique<BodiesFixed28Codec>();
}
std::unique_ptr<LayerCodec> makeDiagnosticsCodec() {
  return std::make_unique<DiagnosticsCodec>();
}

FrameEncoder::FrameEncoder() {
  slots_[v1::LAYER_SURFACE].codec = makeSurfaceFixed16Codec();
  slots_[v1::LAYER_PARTICLES].codec = makeParticlesFixed12Codec();
  slots_[v1::LAYER_FOAM].codec = makeFoamFixed8Codec();
  slots_[v1::LAYER_BODIES].codec = makeBodiesFixed28Codec();
  slots_[v1::LAYER_DIAGNOSTICS].codec = makeDiagnosticsCodec();
}

FrameEncoder::FrameEncoder(std::vector<std::unique_ptr<LayerCodec>> codecs) {
  for (std::unique_ptr<LayerCodec>& codec : codecs) {
    const v1::Layer layer = codec->layer();
    slots_.at(static_cast<std::size_t>(layer)).codec = std::move(codec);
  }
}

core::SharedBytes FrameEncoder::encode(v1::Layer layer, const core::FrameView& frame) {
  Slot& slot = slots_.at(static_cast<std::size_t>(layer));
  if (!slot.codec) return nullptr;
  core::SharedBytes bytes = slot.codec->encode(frame);
  if (bytes) slot.encode_count.fetch_add(1, std::memory_order_relaxed);
  return bytes;
}

void FrameEncoder::requestKeyframe(v1::Layer layer) {
  if (Slot& slot = slots_.at(static_cast<std::size_t>(layer)); slot.codec) slot.codec->requestKeyframe();
}

std::uint64_t FrameEncoder::encodeCount(v1::Layer layer) const {
  return slots_.at(static_cast<std::size_t>(layer)).encode_count.load(std::memory_order_relaxed);
}

}  // namespace spindrift::stream
