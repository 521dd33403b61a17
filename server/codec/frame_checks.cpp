#include "frame_checks.h"

#include <cmath>

#include <spindrift/core/crc32c.h>
#include <spindrift/core/text.h>

namespace spindrift::codec {

std::optional<core::Error> checkRange(const char* name, double value, double min) {
  if (value >= min && value <= kMaxMagnitude) return std::nullopt;
  return invalid(std::string(name) + ": " + core::formatNumber(value) + " is not a finite number from " +
                 core::formatNumber(min) + " to " + core::formatNumber(kMaxMagnitude) + "; the frame is damaged");
}

std::optional<core::Error> checkCount(std::size_t count, std::size_t max) {
  if (count <= max) return std::nullopt;
  return invalid("count: " + std::to_string(count) + " is above " + std::to_string(max));
}

std::optional<core::Error> checkExtents(const PlaneExtents& extents) {
  const auto check = [](const char* name, std::uint32_t count) -> std::optional<core::Error> {
    if (count >= 1 && count <= kSurfaceMaxResolutionCount) return std::nullopt;
    return invalid(std::string(name) + ": " + std::to_string(count) + " is not from 1 to " +
                   std::to_string(kSurfaceMaxResolutionCount));
  };
  if (auto error = check("resolution_count", extents.count.x)) return error;
  if (auto error = check("count_z", extents.count.z)) return error;
  // With an extent of 0 all samples would be at one position.
  if (auto error = checkRange("side_m", extents.length_m, 1e-6)) return error;
  return checkRange("width_m", extents.width_m, 1e-6);
}

v1::FloaterKind floaterKindOf(std::uint8_t number) {
  return v1::FloaterKind_IsValid(number) ? static_cast<v1::FloaterKind>(number) : v1::FLOATER_KIND_CRATE;
}

std::optional<core::Error> checkFrame(const v1::LayerFrame& frame, v1::Layer layer) {
  if (frame.layer() != layer) {
    return invalid("layer: " + std::to_string(frame.layer()) + " is not " + v1::Layer_Name(layer));
  }
  if (!std::isfinite(frame.time_s()))
    return invalid("time_s: " + core::formatNumber(frame.time_s()) + " is not finite");
  if (!std::isfinite(frame.server_time_s()))
    return invalid("server_time_s: " + core::formatNumber(frame.server_time_s()) + " is not finite");
  if (const std::uint32_t crc = core::crc32c(viewOf(frame.payload())); crc != frame.crc32c()) {
    return invalid("crc32c: the frame says " + std::to_string(frame.crc32c()) + ", its payload has " +
                   std::to_string(crc));
  }
  return std::nullopt;
}

std::optional<core::Error> checkPlainFrame(const v1::LayerFrame& frame, v1::Layer layer, std::size_t payload_bytes) {
  if (!frame.keyframe()) return invalid("keyframe: false, but frames of this codec always stand by themselves");
  if (frame.payload().size() != payload_bytes) {
    return invalid("payload: " + std::to_string(frame.payload().size()) + " bytes, but the header calls for " +
                   std::to_string(payload_bytes));
  }
  return checkFrame(frame, layer);
}

}  // namespace spindrift::codec
