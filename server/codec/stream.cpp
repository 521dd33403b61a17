#include <algorithm>
#include <array>

#include <spindrift/codec/stream.h>

namespace spindrift::codec {
namespace {

/// Indexed by core::Level.
constexpr std::array<v1::Level, core::kLevelCount> kWireLevels{v1::LEVEL_COARSE, v1::LEVEL_MEDIUM, v1::LEVEL_FINE,
                                                               v1::LEVEL_FULL};

}  // namespace

Stream streamOf(v1::Layer layer, v1::Packing packing) {
  return {layer, hasLevels(layer) ? packing : v1::PACKING_PLAIN};  // exactly the layers with levels have a packed form
}

std::span<const Stream> allStreams() {
  static constexpr std::array kStreams = {Stream{v1::LAYER_SURFACE},   Stream{v1::LAYER_SURFACE, v1::PACKING_PACKED},
                                          Stream{v1::LAYER_PARTICLES}, Stream{v1::LAYER_PARTICLES, v1::PACKING_PACKED},
                                          Stream{v1::LAYER_FOAM},      Stream{v1::LAYER_FOAM, v1::PACKING_PACKED},
                                          Stream{v1::LAYER_BODIES},    Stream{v1::LAYER_DIAGNOSTICS},
                                          Stream{v1::LAYER_FLOATERS},  Stream{v1::LAYER_FLOATERS, v1::PACKING_PACKED}};
  return kStreams;
}

bool hasLevels(v1::Layer layer) {
  return layer == v1::LAYER_SURFACE || layer == v1::LAYER_PARTICLES || layer == v1::LAYER_FOAM ||
         layer == v1::LAYER_FLOATERS;
}

std::string nameOf(core::Level level) {
  static constexpr std::array<const char*, core::kLevelCount> kNames{"coarse", "medium", "fine", "full"};
  return kNames[core::indexOf(level)];
}

std::uint32_t reducedCountOf(Stream stream, const core::ReducedCounts& counts) {
  switch (stream.layer) {
    case v1::LAYER_SURFACE:
    case v1::LAYER_FOAM:
      return counts.planes;
    case v1::LAYER_PARTICLES:
      return counts.particles;
    case v1::LAYER_FLOATERS:  // packed frames are more coarse at each level, plain ones have one form
      return stream.packing == v1::PACKING_PACKED ? core::kLevelCount - 1 : 0;
    default:
      return 0;
  }
}

core::LevelSet levelsTaking(v1::Layer layer, core::LevelSet due) {
  return layer == v1::LAYER_DIAGNOSTICS ? core::LevelSet::all() : due;
}

v1::Level toWire(core::Level level) {
  return kWireLevels[core::indexOf(level)];
}

std::optional<core::Level> fromWire(v1::Level level) {
  const auto at = std::ranges::find(kWireLevels, level);
  if (at == kWireLevels.end()) return std::nullopt;
  return static_cast<core::Level>(at - kWireLevels.begin());
}

}  // namespace spindrift::codec
