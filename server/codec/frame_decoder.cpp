#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>
#include <tuple>

#include <google/protobuf/stubs/logging.h>

#include <spindrift/codec/frame_decoder.h>
#include <spindrift/core/text.h>

#include "frame_checks.h"

namespace spindrift::codec {
namespace {

static_assert(std::endian::native == std::endian::little, "payload integers are loaded as they lie in memory");

constexpr std::size_t kSampleBytes = 2;
constexpr std::size_t kParticleBytes = 12;
constexpr std::size_t kObjectBytes = 28;
/// By which a quaternion of 16-bit numbers may differ from a unit one.
constexpr double kNormTolerance = 1e-3;

template <typename Integer>
Integer load(const std::uint8_t* at) {
  Integer value{};
  std::memcpy(&value, at, sizeof value);
  return value;
}

/// Reads boats or floaters: the id and the position of each, which stand first, and with `read_rest` what follows.
template <typename Sample, typename ReadRest>
core::Result<std::vector<Sample>> decodeObjects(const v1::LayerFrame& frame, v1::Layer layer, std::size_t count,
                                                std::uint32_t Sample::*id, const ReadRest& read_rest) {
  if (auto error = checkCount(count, kBodyMaxCount)) return *error;
  if (auto error = checkPlainFrame(frame, layer, count * kObjectBytes)) return *error;
  const core::ByteView payload = viewOf(frame.payload());
  std::vector<Sample> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* at = payload.data() + i * kObjectBytes;
    Sample& sample = out[i];
    sample.*id = load<std::uint32_t>(at);
    if (sample.*id == 0) {
      return invalid(std::string(layer == v1::LAYER_BODIES ? "boat_id" : "floater_id") +
                     ": 0 is not an id; the frame is damaged");
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      sample.position_m[axis] = load<std::int32_t>(at + 4 + 4 * axis) / 1000.0;
      if (auto error = checkRange("position_m", sample.position_m[axis], -kMaxMagnitude)) return *error;
    }
    if (std::optional<core::Error> error = read_rest(at, sample)) return *error;
  }
  return out;
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
  const auto angle = [](std::int16_t value) { return value / 32767.0 * std::numbers::pi; };
  const auto ratio = [](std::uint8_t byte) { return std::max(static_cast<std::int8_t>(byte) / 127.0, -1.0); };
  const auto read_rest = [&](const std::uint8_t* at, BodySample& body) -> std::optional<core::Error> {
    body.heading_rad = angle(load<std::int16_t>(at + 16));
    body.pitch_rad = angle(load<std::int16_t>(at + 18));
    body.roll_rad = angle(load<std::int16_t>(at + 20));
    body.speed_mps = load<std::int16_t>(at + 22) / 100.0;
    body.throttle_ratio = ratio(at[24]);
    body.rudder_ratio = ratio(at[25]);
    return std::nullopt;
  };
  return decodeObjects(frame, v1::LAYER_BODIES, frame.bodies_fixed28().count(), &BodySample::boat_id, read_rest);
}

core::Result<std::vector<FloaterSample>> decodeFloaters(const v1::LayerFrame& frame) {
  if (!frame.has_floaters_fixed28())
    return invalid("codec: not floaters_fixed28, the only codec of floaters known here");
  const auto read_rest = [](const std::uint8_t* at, FloaterSample& floater) -> std::optional<core::Error> {
    double norm = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      floater.rotation[k] = load<std::int16_t>(at + 16 + 2 * k) / 32767.0;
      norm += floater.rotation[k] * floater.rotation[k];
    }
    norm = std::sqrt(norm);
    if (std::abs(norm - 1.0) > kNormTolerance) {
      return invalid("rotation: a quaternion of norm " + core::formatNumber(norm) + " is no rotation; the frame is " +
                     "damaged");
    }
    floater.size_m = load<std::uint16_t>(at + 24) / 100.0;
    floater.kind = floaterKindOf(at[26]);
    if (floater.kind == v1::FLOATER_KIND_UNSPECIFIED)
      return invalid("kind: 0 is not a kind of floater; the frame is damaged");
    floater.is_held = (at[27] & 1u) != 0;
    return std::nullopt;
  };
  return decodeObjects(frame, v1::LAYER_FLOATERS, frame.floaters_fixed28().count(), &FloaterSample::floater_id,
                       read_rest);
}

}  // namespace spindrift::codec
