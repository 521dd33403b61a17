
#include <algorithm>
#include <cmath>

#include <shared/fixed_point.h>

#include <spindrift/sim_setup/fill_up.h>

namespace spindrift::sim {

std::int64_t bedUnits(double depth_m) {
  return static_cast<std::int64_t>(double{static_cast<float>(depth_m)} * double{ELEVATION_UNITS_PER_M});
}

FillUp fillUp(std::span<const std::int64_t> bed_units, std::span<std::int32_t> elevation_units, Lack lack) {
  std::int64_t lacking_units = 0;
  std::int64_t held_units = 0;
  const auto heldAt = [&](std::size_t i) { return bed_units[i] > 0 ? bed_units[i] + elevation_units[i] : 0; };
  for (std::size_t i = 0; i < bed_units.size(); ++i) {
    lacking_units += std::max<std::int64_t>(-heldAt(i), 0);
    held_units += std::max<std::int64_t>(heldAt(i), 0);
  }
  FillUp out;
  if (lacking_units == 0 || (held_units < lacking_units && lack == Lack::kStays)) return out;
  out.is_changed = true;
  out.from_outside_units = std::max<std::int64_t>(lacking_units - held_units, 0);
  std::int64_t to_take_units = lacking_units - out.from_outside_units;
  const double share = static_cast<double>(to_take_units) / static_cast<double>(std::max<std::int64_t>(held_units, 1));
  for (std::size_t i = 0; i < bed_units.size(); ++i) {
    const std::int64_t held = heldAt(i);
    const auto part = static_cast<std::int64_t>(std::floor(static_cast<double>(held) * share));
    const std::int64_t taken = held > 0 ? std::clamp<std::int64_t>(part, 0, std::min(held, to_take_units)) : held;
    elevation_units[i] -= static_cast<std::int32_t>(taken);
    if (held > 0) to_take_units -= taken;
  }
  // Distribute the remainder of the rounding: less than one unit per cell.
  for (std::size_t i = 0; to_take_units > 0; i = (i + 1) % bed_units.size()) {
    if (heldAt(i) <= 0) continue;
    --elevation_units[i];
    --to_take_units;
  }
  return out;
}

}  // namespace spindrift::sim
