// Checks that a client makes on the frames of every layer before it uses their numbers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <spindrift/core/bytes.h>
#include <spindrift/core/result.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::codec {

/// Far beyond any scene; keeps every decoded value finite as a float.
inline constexpr double kMaxMagnitude = 1e6;

core::Error invalid(std::string message);
core::ByteView viewOf(const std::string& bytes);

/// min <= value <= kMaxMagnitude; NaN is out of range as well.
std::optional<core::Error> checkRange(const char* name, double value, double min);

/// A side's samples, 1 to kSurfaceMaxResolutionCount.
std::optional<core::Error> checkResolution(std::uint32_t resolution_count);

/// Layer, time and checksum.
std::optional<core::Error> checkFrame(const v1::LayerFrame& frame, v1::Layer layer);

/// Checks a plain frame, also that it is a keyframe and as long as its header says.
std::optional<core::Error> checkPlainFrame(const v1::LayerFrame& frame, v1::Layer layer, std::size_t payload_bytes);

}  // namespace spindrift::codec
