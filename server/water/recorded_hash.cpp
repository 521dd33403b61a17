#include <span>

#include <fmt/format.h>

#include <spindrift/water/recorded_hash.h>

namespace spindrift::water {
namespace {

std::uint64_t hashOfVersion0(const sim::StateCopy& state) {
  std::uint64_t hash = 0xcbf29ce484222325ull;  // 64-bit FNV-1a over bytes
  const auto add = [&](const auto& values) {
    for (const std::byte b : std::as_bytes(std::span(values)))
      hash = (hash ^ static_cast<std::uint64_t>(b)) * 0x100000001b3ull;
  };
  add(state.position);
  add(state.velocity);
  add(state.elevation_m);
  add(state.flow_m2ps);
  add(state.boats);
  add(state.pool);
  add(state.elevation_x_units);
  return hash;
}

}  // namespace

core::Result<std::uint64_t> recordedHash(sim::WaterSim& water, std::uint32_t version) {
  if (version == 0) return hashOfVersion0(water.copyState());
  if (version == kStateHashVersion) return water.stateHash();
  return core::invalid(fmt::format(
      "its state hashes are of version {}, and this program knows versions up to {}: use the program that wrote them",
      version, kStateHashVersion));
}

}  // namespace spindrift::water
