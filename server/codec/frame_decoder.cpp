#include <algorithm>
#include <bit>
#include <cstring>
#include <numbers>
#include <string>
#include <tuple>

#include <google/protobuf/stubs/logging.h>

#include <spindrift/codec/frame_decoder.h>

#include "frame_checks.h"

namespace spindrift::codec {
namespace {

static_assert(std::endian::native == std::endian::little, "payload integers are loaded as they lie in memory");

constexpr std::size_t kSampleBytes = 2;
constexpr std::size_t kParticleBytes = 12;
constexpr std::size_t kBodyBytes = 28;

template <typename Integer>
Integer load(const std::uint8_t* at) {
  Integer value{};
  std::memcpy(&value, at, sizeof value);
  return value;
}

}  // namespace

core::Result<v1::ServerMessage> parseServerMessage(core::ByteView bytes) {
  if (bytes.size() > kServerMessageMaxBytes) {
    return invalid("message of " + std::to_string(bytes.size()) + " bytes is above " +
                   std::to_string(kServerMessageMaxBytes));
  }
  const google::protobuf::LogSilencer silencer;
  v1::ServerMessage message;
  if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
    return invalid("not a spindrift.v1.ServerMessage: the bytes are damaged or cut short");
  }
  if (message.message_case() == v1::ServerMessage::MESSAGE_NOT_SET) {
    return invalid("server message of a kind that this client does not know");
  }
  return message;
}

core::Result<SurfaceSamples> decodeSurface(const v1::LayerFrame& frame) {
  if (!frame.has_surface_fixed16()) return invalid("codec: not surface_fixed16, the only surface codec known here");
  const v1::SurfaceFixed16& header = frame.surface_fixed16();
  const PlaneExtents extents = extentsOf(header);
  if (auto error = checkExtents(extents)) return *error;
  // With a quantum of 0 all samples would be flat whatever the payload.
  if (auto error = checkRange("quantum_m", header.quantum_m(), 1e-9)) return *error;
  if (auto error = checkPlainFrame(frame, v1::LAYER_SURFACE, extents.count.total() * kSampleBytes)) return *error;
  SurfaceSamples out{extents, header.quantum_m(), {}};
  const core::ByteView payload = viewOf(frame.payload());
  out.elevation_m.resize(payload.size() / kSampleBytes);
  for (std::size_t i = 0; i < out.elevation_m.size(); ++i) {
    out.elevation_m[i] = static_cast<float>(load<std::int16_t>(payload.data() + i * kSampleBytes) * header.quantum_m());
  }
  return out;
}

core::Result<ParticleSamples> decodeParticles(const v1::LayerFrame& frame) {
  if (!frame.has_particles_fixed12())
    return invalid("codec: not particles_fixed12, the only particle codec known here");
  const v1::ParticlesFixed12& header = frame.particles_fixed12();
  if (auto error = checkCount(header.count(), kParticleMaxCount)) return *error;
  const std::tuple<const char*, double, double> ranges[] = {
      {"min_x_m", header.min_x_m(), -kMaxMagnitude},   {"min_y_m", header.min_y_m(), -kMaxMagnitude},
      {"min_z_m", header.min_z_m(), -kMaxMagnitude},   {"max_x_m", header.max_x_m(), header.min_x_m()},
      {"max_y_m", header.max_y_m(), header.min_y_m()}, {"max_z_m", header.max_z_m(), header.min_z_m()},
      {"max_speed_mps", header.max_speed_mps(), 0.0},  {"radius_m", header.radius_m(), 0.0}};
  for (const auto& [name, value, min] : ranges) {
    if (auto error = checkRange(name, value, min)) return *error;
  }
  const std::size_t count = header.count();
  if (auto error = checkPlainFrame(frame, v1::LAYER_PARTICLES, count * kParticleBytes)) return *error;
  ParticleSamples out = particlesOf(header);
  const auto position = [](std::uint16_t value, double min_m, double max_m) {
    return static_cast<float>(min_m + value / 65535.0 * (max_m - min_m));
  };
  const auto velocity = [&](std::uint8_t byte) {
    return static_cast<float>(static_cast<std::int8_t>(byte) / 127.0 * header.max_speed_mps());
  };
  const core::ByteView payload = viewOf(frame.payload());
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* at = payload.data() + i * kParticleBytes;
    out.position_m[3 * i + 0] = position(load<std::uint16_t>(at + 0), header.min_x_m(), header.max_x_m());
    out.position_m[3 * i + 2] = position(load<std::uint16_t>(at + 2), header.min_z_m(), header.max_z_m());
    out.position_m[3 * i + 1] = position(load<std::uint16_t>(at + 4), header.min_y_m(), header.max_y_m());
    for (std::size_t axis = 0; axis < 3; ++axis) out.velocity_mps[3 * i + axis] = velocity(at[6 + axis]);
    out.tint[i] = at[9];
    out.foam[i] = at[10];
  }
  return out;
}

core::Result<FoamSamples> decodeFoam(const v1::LayerFrame& frame) {
  if (!frame.has_foam_fixed8()) return invalid("codec: not foam_fixed8, the only foam codec known here");
  const PlaneExtents extents = extentsOf(frame.foam_fixed8());
  if (auto error = checkExtents(extents)) return *error;
  if (auto error = checkPlainFrame(frame, v1::LAYER_FOAM, extents.count.total())) return *error;
  const core::ByteView payload = viewOf(frame.payload());
  return FoamSamples{extents, {payload.begin(), payload.end()}};
}

core::Result<std::vector<BodySample>> decodeBodies(const v1::LayerFrame& frame) {
  if (!frame.has_bodies_fixed28()) return invalid("codec: not bodies_fixed28, the only codec of bodies known here");
  const std::size_t count = frame.bodies_fixed28().count();
  if (auto error = checkCount(count, kBodyMaxCount)) return *error;
  if (auto error = checkPlainFrame(frame, v1::LAYER_BODIES, count * kBodyBytes)) return *error;
  const core::ByteView payload = viewOf(frame.payload());
  const auto angle = [](std::int16_t value) { return value / 32767.0 * std::numbers::pi; };
  const auto ratio = [](std::uint8_t byte) { return std::max(static_cast<std::int8_t>(byte) / 127.0, -1.0); };
  std::vector<BodySample> out;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* at = payload.data() + i * kBodyBytes;
    BodySample body;
    body.boat_id = load<std::uint32_t>(at);
    if (body.boat_id == 0) return invalid("boat_id: 0 is not a boat; the frame is damaged");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      body.position_m[axis] = load<std::int32_t>(at + 4 + 4 * axis) / 1000.0;
      if (auto error = checkRange("position_m", body.position_m[axis], -kMaxMagnitude)) return *error;
    }
    body.heading_rad = angle(load<std::int16_t>(at + 16));
    body.pitch_rad = angle(load<std::int16_t>(at + 18));
    body.roll_rad = angle(load<std::int16_t>(at + 20));
    body.speed_mps = load<std::int16_t>(at + 22) / 100.0;
    body.throttle_ratio = ratio(at[24]);
    body.rudder_ratio = ratio(at[25]);
    out.push_back(body);
  }
  return out;
}

}  // namespace spindrift::codec
