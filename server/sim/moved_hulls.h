// What runs only while another program moves boats: the passes that know such boats, and the forces on their hulls.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include <spindrift/sim/hull_forces.h>

#include "creation.h"
#include "wave.h"

namespace spindrift::sim {

class MovedHulls {
 public:
  MovedHulls(Creation& create, std::size_t slot_count);

  /// In the place of bodies/drift.comp, kick.comp and press.comp for all boats.
  Pass drift, kick, press;

  /// Begins a tick: no force yet.
  void begin() { forces_.clear(); }
  /// Adds the pressure on the hulls in the wave step to come. Boats and uniforms are bound.
  void feel(Wave& wave, std::uint32_t place_count);
  /// Binds HULL_FORCES.
  void bindForces() const;
  /// Gives the water the momentum that the drag of this tick took from the hulls.
  void drag(Wave& wave);
  /// Reads the forces of the tick back. `boat_ids`: by slot, 0 for those that nobody moves. Without a free slot of the
  /// ring they are lost.
  void submit(std::uint64_t tick, std::vector<std::uint32_t> boat_ids, double water_kgpm3);
  /// Returns what has arrived, oldest first. Never waits.
  std::vector<HullForces> poll();
  [[nodiscard]] std::size_t inFlightCount() const { return in_flight_.size(); }

 private:
  struct Tick {
    std::uint64_t tick;
    std::vector<std::uint32_t> boat_ids;
    double water_kgpm3;
  };

  Pass feel_, drag_;
  gpu::TexelBuffer forces_;
  std::unique_ptr<gpu::ReadbackRing> ring_;
  std::deque<Tick> in_flight_;  ///< bounded by the slots of the ring
};

}  // namespace spindrift::sim
