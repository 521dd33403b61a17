// What a client can subscribe to: a layer in one packing, at one level of detail.
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
/// 0 .. kStreamCount - 1; plain ones are numbered as their layers.
constexpr std::size_t indexOf(Stream stream) {
  return static_cast<std::size_t>(stream.packing) * v1::Layer_ARRAYSIZE + static_cast<std::size_t>(stream.layer);
}
/// The stream for a subscription: the plain one where the layer has no packed form.
Stream streamOf(v1::Layer layer, v1::Packing packing);
/// All streams.
std::span<const Stream> allStreams();

/// True for layers that come in levels of detail.
bool hasLevels(v1::Layer layer);
/// "full", "coarse", ...
std::string nameOf(core::Level level);
/// Number of levels that downsample this layer, out of the counts for the scene's planes and particles.
std::uint32_t reducedCountOf(v1::Layer layer, const core::ReducedCounts& counts);

/// The level's number on the wire.
v1::Level toWire(core::Level level);
/// nullopt for a number that is not a level.
std::optional<core::Level> fromWire(v1::Level level);

}  // namespace spindrift::codec
