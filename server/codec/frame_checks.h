// Checks that a client makes on the frames of every layer before it uses their numbers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <spindrift/core/bytes.h>
#include <spindrift/core/result.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::codec {

/// Larger than any scene; keeps every decoded value finite as a float.
inline constexpr double kMaxMagnitude = 1e6;

core::Error invalid(std::string message);
core::ByteView viewOf(const std::string& bytes);

/// Requires min <= value <= kMaxMagnitude; NaN is out of range too.
std::optional<core::Error> checkRange(const char* name, double value, double min);

/// Requires 1 to kSurfaceMaxResolutionCount samples along each side.
std::optional<core::Error> checkResolution(std::uint32_t resolution_count);

/// Checks layer, time and checksum.
std::optional<core::Error> checkFrame(const v1::LayerFrame& frame, v1::Layer layer);

/// Checks a plain frame; it must also be a keyframe and have the length that its header gives.
std::optional<core::Error> checkPlainFrame(const v1::LayerFrame& frame, v1::Layer layer, std::size_t payload_bytes);

}  // namespace spindrift::codec
