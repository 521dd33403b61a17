#include <cassert>
#include <cstddef>
#include <utility>

#include <google/protobuf/io/coded_stream.h>

#include <spindrift/codec/frame_encoder.h>
#include <spindrift/codec/stream.h>
#include <spindrift/core/crc32c.h>

#include "layer_encoders.h"

namespace spindrift::codec {
namespace {

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

}  // namespace

core::SharedBytes serialized(const google::protobuf::MessageLite& message) {
  core::Bytes bytes(message.ByteSizeLong());
  message.SerializeWithCachedSizesToArray(bytes.data());
  return core::share(std::move(bytes));
}

// The payload is written by hand so that it is copied exactly once. Serialized parts of a message may be concatenated;
// here all fields except server_time_s and state_id are in the order of their numbers.
core::SharedBytes serializeFrame(const core::FrameView& frame, v1::Layer layer, core::Level level,
                                 std::optional<std::uint64_t> base_tick, const v1::LayerFrame& codec,
                                 core::ByteView payload) {
  v1::LayerFrame head;
  head.set_layer(layer);
  head.set_tick(frame.tick);
  head.set_time_s(frame.time_s);
  head.set_keyframe(!base_tick);
  head.set_base_tick(base_tick.value_or(0));
  head.set_server_time_s(frame.asked_s);
  head.set_state_id(frame.state_id);
  v1::LayerFrame tail;
  tail.set_level(toWire(level));

  const auto payload_size = static_cast<std::uint32_t>(payload.size());
  const std::size_t before_payload = head.ByteSizeLong() + kCrcFieldBytes + tail.ByteSizeLong() + codec.ByteSizeLong() +
                                     1 + CodedOutputStream::VarintSize32(payload_size);
  const auto frame_size = static_cast<std::uint32_t>(before_payload + payload_size);
  const std::size_t prefix_size = 1 + CodedOutputStream::VarintSize32(frame_size) + before_payload;

  core::Bytes bytes;
  bytes.reserve(prefix_size + payload_size);
  bytes.resize(prefix_size);
  // The checksum is computed from the copy: the payload may be in memory mapped from the device, which is slow to read
  // twice.
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  const std::uint32_t crc = core::crc32c(core::ByteView(bytes).subspan(prefix_size));

  std::uint8_t* at = bytes.data();
  *at++ = static_cast<std::uint8_t>(kFrameTag);
  at = CodedOutputStream::WriteVarint32ToArray(frame_size, at);
  at = head.SerializeWithCachedSizesToArray(at);
  *at++ = static_cast<std::uint8_t>(kCrcTag);
  at = CodedOutputStream::WriteLittleEndian32ToArray(crc, at);
  at = tail.SerializeWithCachedSizesToArray(at);
  at = codec.SerializeWithCachedSizesToArray(at);
  *at++ = static_cast<std::uint8_t>(kPayloadTag);
  at = CodedOutputStream::WriteVarint32ToArray(payload_size, at);
  assert(at == bytes.data() + prefix_size);
  return core::share(std::move(bytes));
}

void writeGauge(const core::DiagnosticsView::GaugeNow& gauge, v1::GaugeReading& out) {
  out.set_name(gauge.name);
  out.set_elevation_m(gauge.elevation_m);
  out.set_velocity_x_mps(gauge.velocity_x_mps);
  out.set_velocity_z_mps(gauge.velocity_z_mps);
  out.set_highest_m(gauge.highest_m);
  out.set_lowest_m(gauge.lowest_m);
  out.set_x_m(gauge.x_m);
  out.set_z_m(gauge.z_m);
  out.set_gauge_id(gauge.gauge_id);
  out.set_person_id(gauge.person_id);
  out.set_unread(gauge.is_unread);
}

core::SharedBytes serializeDiagnostics(const core::FrameView& frame) {
  if (!frame.diagnostics) return nullptr;
  const core::DiagnosticsView& in = *frame.diagnostics;
  v1::ServerMessage message;
  v1::Diagnostics& out = *message.mutable_diagnostics();
  out.set_tick(frame.tick);
  out.set_time_s(frame.time_s);
  out.set_step_ms(in.step_ms);
  out.set_real_time_factor(in.real_time_factor);
  out.set_substeps_count(in.substeps_count);
  out.set_particle_count(in.particle_count);
  out.set_max_particle_speed_mps(in.max_particle_speed_mps);
  out.set_max_elevation_m(in.max_elevation_m);
  out.set_kinetic_energy_j(in.kinetic_energy_j);
  out.set_potential_energy_j(in.potential_energy_j);
  out.set_wave_energy_j(in.wave_energy_j);
  out.set_mean_density_ratio(in.mean_density_ratio);
  out.set_max_density_ratio(in.max_density_ratio);
  out.set_nonfinite_count(in.nonfinite_count);
  out.set_escaped_count(in.escaped_count);
  out.set_recovered_count(in.recovered_count);
  out.set_boat_count(in.boat_count);
  out.set_volume_error_units(in.volume_error_units);
  out.set_emitted_m3(in.emitted_m3);
  out.set_absorbed_m3(in.absorbed_m3);
  out.set_breaking_ratio(in.breaking_ratio);
  out.set_state_id(frame.state_id);
  for (const core::DiagnosticsView::PassTime& pass : in.passes) {
    v1::Diagnostics::PassTime& time = *out.add_passes();
    time.set_name(pass.name);
    time.set_ms(pass.ms);
  }
  for (const core::DiagnosticsView::GaugeNow& gauge : in.gauges) writeGauge(gauge, *out.add_gauges());
  out.set_gauges_time_s(in.gauges_time_s);
  return serialized(message);
}

}  // namespace spindrift::codec
