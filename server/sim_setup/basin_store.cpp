#include <algorithm>
#include <utility>

#include <spindrift/sim_setup/basin_store.h>
#include <spindrift/sim_setup/scene_parts.h>

namespace spindrift::sim {
namespace {

template <typename T>
std::size_t bytesOf(const std::vector<T>& values) {
  return values.size() * sizeof(T);
}

}  // namespace

BasinInputs::BasinInputs(const core::Scene& scene, const WaveLayout& layout)
    : wave(*scene.wave),
      speed_mps(layout.speed_mps),
      obstacles(scene.obstacles),
      beaches(scene.beaches),
      bed(scene.bed) {
  // Parameters that may change while running and that no table contains.
  wave.damping_per_s = 0.0;
  wave.steepening_ratio = 0.0;
  wave.manning_spm13 = 0.0;
  wave.fixed_substeps_count = 0;
}

std::size_t BasinTables::sizeBytes() const {
  std::size_t out = bytesOf(basin.depth_m) + bytesOf(basin.conductance_m) + bytesOf(basin.bed) +
                    bytesOf(dispersion.root_c) + bytesOf(terrain.ground) + bytesOf(terrain.landing);
  for (const DispersionLevel& level : dispersion.levels) {
    out +=
        bytesOf(level.stiffness) + bytesOf(level.spread) + bytesOf(level.from_coarse_x) + bytesOf(level.from_coarse_z);
  }
  return out;
}

BasinTables layOutTables(const core::Scene& scene, const WaveLayout& layout, bool with_terrain) {
  BasinTables out{.basin = layOutBasin(scene, layout), .dispersion = {}, .terrain = {}};
  if (disperses(scene)) out.dispersion = layOutDispersion(layout, out.basin);
  if (with_terrain) out.terrain = layOutTerrain(scene, layout, out.basin);
  return out;
}

std::shared_ptr<const BasinTables> BasinStore::of(const core::Scene& scene, const WaveLayout& layout,
                                                  bool with_terrain) {
  BasinInputs inputs(scene, layout);
  const auto known = std::ranges::find_if(
      entries_, [&](const Entry& entry) { return entry.with_terrain == with_terrain && entry.inputs == inputs; });
  if (known != entries_.end()) {
    entries_.splice(entries_.begin(), entries_, known);
    return known->tables;
  }
  ++made_count_;
  auto tables = std::make_shared<const BasinTables>(layOutTables(scene, layout, with_terrain));
  entries_.push_front({std::move(inputs), with_terrain, tables});
  std::size_t left_bytes = max_bytes_;
  entries_.remove_if([&](const Entry& entry) {
    const std::size_t bytes = entry.tables->sizeBytes();
    if (bytes > left_bytes) return true;
    left_bytes -= bytes;
    return false;
  });
  return tables;
}

}  // namespace spindrift::sim
