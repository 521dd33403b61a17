// Checks that a client makes on the frames of every layer before it uses their numbers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <spindrift/codec/frame_decoder.h>
#include <spindrift/core/bytes.h>
#include <spindrift/core/result.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::codec {

/// Larger than any scene; keeps every decoded value finite as a float.
inline constexpr double kMaxMagnitude = 1e6;

using core::invalid;
using core::viewOf;

/// Requires min <= value <= kMaxMagnitude; NaN is out of range too.
std::optional<core::Error> checkRange(const char* name, double value, double min);

/// Requires count <= max.
std::optional<core::Error> checkCount(std::size_t count, std::size_t max);

/// Returns room for the particles of a header, and what it says of all of them.
template <typename Header>
ParticleSamples particlesOf(const Header& header) {
  const std::size_t count = header.count();
  return {.count = header.count(),
          .radius_m = header.radius_m(),
          .position_m = std::vector<float>(3 * count),
          .velocity_mps = std::vector<float>(3 * count),
          .tint = core::Bytes(count),
          .foam = core::Bytes(count)};
}

/// Returns the extents in the header of a plane: what is left out along z is as along x.
template <typename Header>
PlaneExtents extentsOf(const Header& header) {
  return {.count = {header.resolution_count(), header.count_z() > 0 ? header.count_z() : header.resolution_count()},
          .length_m = header.side_m(),
          .width_m = header.width_m() != 0.0 ? header.width_m() : header.side_m()};
}
/// Writes them into a header; nothing along z for a square with as many samples along both axes.
template <typename Header>
void setExtents(const PlaneExtents& extents, Header& header) {
  header.set_resolution_count(extents.count.x);
  header.set_side_m(extents.length_m);
  if (extents.count.z == extents.count.x && extents.width_m == extents.length_m) return;
  header.set_count_z(extents.count.z);
  header.set_width_m(extents.width_m);
}

/// Returns the kind of this number; a crate for one that only a newer server knows.
v1::FloaterKind floaterKindOf(std::uint8_t number);

/// Requires 1 to kSurfaceMaxResolutionCount samples along each axis, and an extent.
std::optional<core::Error> checkExtents(const PlaneExtents& extents);

/// Checks layer, time and checksum.
std::optional<core::Error> checkFrame(const v1::LayerFrame& frame, v1::Layer layer);

/// Checks a plain frame; it must also be a keyframe and have the length that its header gives.
std::optional<core::Error> checkPlainFrame(const v1::LayerFrame& frame, v1::Layer layer, std::size_t payload_bytes);

}  // namespace spindrift::codec
