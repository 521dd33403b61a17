// Streams that a client can subscribe to: a layer in one packing, with levels of detail.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <spindrift/core/level.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::codec {

/// A layer in one packing. A layer without a packed form has one stream.
struct Stream {
  v1::Layer layer = v1::LAYER_UNSPECIFIED;
  v1::Packing packing = v1::PACKING_PLAIN;
};
inline constexpr std::size_t kStreamCount = 2 * v1::Layer_ARRAYSIZE;
/// 0 .. kStreamCount - 1; plain streams have the number of their layer.
constexpr std::size_t indexOf(Stream stream) {
  return static_cast<std::size_t>(stream.packing) * v1::Layer_ARRAYSIZE + static_cast<std::size_t>(stream.layer);
}
/// Returns the stream for a subscription: the plain one if the layer has no packed form.
Stream streamOf(v1::Layer layer, v1::Packing packing);
std::span<const Stream> allStreams();

bool hasLevels(v1::Layer layer);
/// Returns "full", "coarse", ...
std::string nameOf(core::Level level);
/// Returns the number of levels that reduce this stream, from the counts for the scene's planes and particles.
std::uint32_t reducedCountOf(Stream stream, const core::ReducedCounts& counts);
/// Returns the levels whose sessions take the layer from a frame that is due for the levels in `due`: these levels. The
/// diagnostics are not a part of the picture; sessions of every level take them.
core::LevelSet levelsTaking(v1::Layer layer, core::LevelSet due);

v1::Level toWire(core::Level level);
/// Returns nullopt for a number that is not a level.
std::optional<core::Level> fromWire(v1::Level level);

}  // namespace spindrift::codec
