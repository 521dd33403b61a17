#include "moved_hulls.h"

#include <cstring>
#include <utility>

#include <shared/bindings.h>
#include <shared/boats.h>

#include "ticks_in_flight.h"

namespace spindrift::sim {
namespace {

constexpr std::size_t kHullFloats = std::size_t{HULL_FORCE_TEXELS} * 4;
constexpr std::size_t kForceSlotCount = 2 * (TicksInFlight::kMaxCount + 1);

/// `texels`: force and moment over the density, 4 floats each.
Wrench wrenchOf(const float* texels, double water_kgpm3) {
  Wrench out;
  for (std::size_t k = 0; k < 3; ++k) {
    out.force_n[k] = water_kgpm3 * double{texels[k]};
    out.moment_nm[k] = water_kgpm3 * double{texels[4 + k]};
  }
  return out;
}

}  // namespace

MovedHulls::MovedHulls(Creation& create, std::size_t slot_count)
    : drift(create.pass("bodies/drift.comp", {{"MOVED", "1"}})),
      kick(create.pass("bodies/kick.comp", {{"MOVED", "1"}})),
      press(create.pass("bodies/press.comp", {{"MOVED", "1"}})),
      feel_(create.pass("bodies/hull_forces.comp")),
      drag_(create.pass("bodies/hull_drag.comp")),
      forces_(create.texels("hull forces", slot_count * HULL_FORCE_TEXELS, gpu::TexelFormat::kRGBA32F)),
      ring_(create.ring("hull forces", slot_count * kHullFloats * sizeof(float), kForceSlotCount)) {}

void MovedHulls::feel(Wave& wave, std::uint32_t place_count) {
  wave.bindTerrain();
  wave.elevation().bindTexel(ELEVATION);
  bindForces();
  feel_.runGroups(place_count);
}

void MovedHulls::bindForces() const {
  forces_.bindStorage(HULL_FORCES);
}

void MovedHulls::drag(Wave& wave) {
  wave.bindBasin();
  wave.elevation().bindTexel(ELEVATION);
  wave.flow().bindStorage(FLOW);
  forces_.bindTexel(HULL_FORCES);
  drag_.run(wave.cellCounts());
}

void MovedHulls::submit(std::uint64_t tick, std::vector<std::uint32_t> boat_ids, double water_kgpm3) {
  auto slot = ring_->begin();
  if (!slot || !slot->copyFrom(forces_, 0, boat_ids.size() * kHullFloats * sizeof(float), 0)) return;
  slot->submit(tick);
  in_flight_.push_back({tick, std::move(boat_ids), water_kgpm3});
}

std::vector<HullForces> MovedHulls::poll() {
  std::vector<HullForces> out;
  for (const auto& slot : ring_->poll()) {
    // A slot whose fence failed is never returned: skip it.
    while (in_flight_.front().tick != slot->tag()) in_flight_.pop_front();
    const Tick tick = std::move(in_flight_.front());
    in_flight_.pop_front();
    std::vector<float> floats(tick.boat_ids.size() * kHullFloats);
    std::memcpy(floats.data(), slot->bytes().data(), floats.size() * sizeof(float));
    HullForces& forces = out.emplace_back(HullForces{.tick = tick.tick});
    for (std::size_t at = 0; at < tick.boat_ids.size(); ++at) {
      if (tick.boat_ids[at] == 0) continue;
      const float* own = floats.data() + at * kHullFloats;
      forces.hulls.push_back({.boat_id = tick.boat_ids[at],
                              .hydrostatic = wrenchOf(own, tick.water_kgpm3),
                              .dynamic = wrenchOf(own + 8, tick.water_kgpm3),
                              .drag = wrenchOf(own + 16, tick.water_kgpm3)});
    }
  }
  return out;
}

}  // namespace spindrift::sim
