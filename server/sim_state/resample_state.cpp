#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

#include <shared/fixed_point.h>
#include <shared/groups.h>
#include <shared/pool.h>

#include <spindrift/core/random.h>
#include <spindrift/sim_setup/basin.h>
#include <spindrift/sim_setup/fill_up.h>
#include <spindrift/sim_setup/resample.h>
#include <spindrift/sim_setup/scene_parts.h>
#include <spindrift/sim_state/relay_particles.h>
#include <spindrift/sim_state/resample_state.h>

namespace spindrift::sim {
namespace {

/// Shifts of the faces that a cell owns, in the order of shaders/wave/wave_faces.glsl.
constexpr std::array<std::array<double, 2>, 4> kFaceShifts = {{{0.5, 0.0}, {0.0, 0.5}, {0.5, 0.5}, {0.5, 0.5}}};

/// A wave's grid with its basin.
struct Grid {
  Grid(const core::Scene& scene, const WaveLayout& layout)
      : count(layout.counts()), foam_count(layout.foamCounts()), basin(layOutBasin(scene, layout)) {
    wet.reserve(basin.depth_m.size());
    for (std::size_t i = 0; i < basin.depth_m.size(); ++i) {
      bed_units.push_back(bedUnits(isNonlinear(scene) ? basin.bed[i][2] : basin.depth_m[i]));
      wet.push_back(basin.depth_m[i] > 0 ? 1 : 0);
    }
  }
  [[nodiscard]] std::size_t cellCount() const { return count.total(); }
  /// Water at rest, and the sum of its elevations, which counts ground above it. [units]
  [[nodiscard]] std::int64_t restingWater() const {
    return std::accumulate(bed_units.begin(), bed_units.end(), std::int64_t{0},
                           [](std::int64_t sum, std::int64_t bed) { return sum + std::max<std::int64_t>(bed, 0); });
  }
  [[nodiscard]] std::int64_t restingElevation() const {
    return restingWater() - std::accumulate(bed_units.begin(), bed_units.end(), std::int64_t{0});
  }

  core::CellCounts count, foam_count;
  Basin basin;
  std::vector<char> wet;
  std::vector<std::int64_t> bed_units;
};

/// Adds `lack_units` to the cells that hold water, evenly, or takes them in proportion to what they hold.
void spread(std::int64_t lack_units, std::vector<std::int64_t>& held_units) {
  const std::int64_t sum = std::accumulate(held_units.begin(), held_units.end(), std::int64_t{0});
  if (sum <= 0) return;
  if (lack_units < 0) {
    std::int64_t left = std::min(-lack_units, sum);
    const double share = static_cast<double>(left) / static_cast<double>(sum);
    for (std::int64_t& held : held_units) {
      const auto part = std::min({static_cast<std::int64_t>(static_cast<double>(held) * share), held, left});
      held -= part;
      left -= part;
    }
    for (std::size_t i = 0; left > 0; i = (i + 1) % held_units.size()) {
      if (held_units[i] == 0) continue;
      --held_units[i];
      --left;
    }
    return;
  }
  const auto wet_count = std::ranges::count_if(held_units, [](std::int64_t held) { return held > 0; });
  std::int64_t rest = lack_units % wet_count;
  for (std::int64_t& held : held_units) {
    if (held == 0) continue;
    held += lack_units / wet_count + (rest > 0 ? 1 : 0);
    if (rest > 0) --rest;
  }
}

class SurfaceCarrier {
 public:
  SurfaceCarrier(const CarriedState& before, const core::Scene& scene, const Derived& derived)
      : before_(before),
        scene_(scene),
        from_(before.scene, *before.derived.wave),
        to_(scene, *derived.wave),
        x_{.shift_cells = 0.0, .is_periodic = isPeriodicX(*scene.wave)},
        z_{.shift_cells = 0.0, .is_periodic = isPeriodicZ(*scene.wave)} {}

  /// Units of a new cell per unit of an old cell, by their areas.
  [[nodiscard]] double unitRatio() const {
    return static_cast<double>(to_.cellCount()) / static_cast<double>(from_.cellCount());
  }

  /// Sum of the elevations of water at rest in the new cells. [units]
  [[nodiscard]] std::int64_t restingElevation() const { return to_.restingElevation(); }

  /// `extra_units`: volume that is added, in units of the new cells.
  [[nodiscard]] std::vector<std::int32_t> elevation(std::int64_t extra_units) const {
    if (isNonlinear(scene_)) return shallowElevation(extra_units);
    std::vector<double> units(before_.state.elevation_m.size());
    std::ranges::transform(before_.state.elevation_m, units.begin(),
                           [](double eta_m) { return eta_m * double{ELEVATION_UNITS_PER_M}; });
    const double total = std::accumulate(units.begin(), units.end(), 0.0);
    const Field moved = onWetCells(std::move(units));
    const auto whole = wholeWithTotal(moved.mean, to_.wet, std::llround(total * unitRatio()) + extra_units);
    std::vector<std::int32_t> out;
    out.reserve(whole.size());
    for (const std::int64_t each : whole) out.push_back(static_cast<std::int32_t>(each));
    (void)fillUp(to_.bed_units, out, exchangesWater(scene_) ? Lack::kComesFromOutside : Lack::kStays);
    return out;
  }

  [[nodiscard]] std::vector<std::int32_t> elevationX() const {
    const auto& units = before_.state.elevation_x_units;
    const Field moved = onWetCells(std::vector<double>(units.begin(), units.end()));
    std::vector<std::int32_t> out(to_.cellCount(), 0);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const bool is_in_layer = to_.basin.bed[i][1] + to_.basin.bed[i][3] > 0;
      if (is_in_layer) out[i] = static_cast<std::int32_t>(std::lround(moved.mean[i]));
    }
    return out;
  }

  [[nodiscard]] std::vector<float> flow() const {
    const std::vector<float>& old = before_.state.flow_m2ps;
    const std::size_t components = old.size() / from_.cellCount();
    std::vector<float> out(to_.cellCount() * components, 0.0f);
    for (std::size_t c = 0; c < components; ++c) {
      Field field{std::vector<double>(from_.cellCount()), std::vector<double>(from_.cellCount(), 1.0)};
      for (std::size_t i = 0; i < field.mean.size(); ++i) field.mean[i] = old[components * i + c];
      SampleAxis x = x_, z = z_;
      // A nonlinear bulk has velocities and moved water at the same two faces.
      const std::size_t face = isNonlinear(scene_) ? c % 2 : c;
      x.shift_cells = kFaceShifts[face][0];
      z.shift_cells = kFaceShifts[face][1];
      const Field moved = resample(field, from_.count, to_.count, x, z);
      for (std::size_t i = 0; i < moved.mean.size(); ++i) {
        if (to_.basin.conductance_m[i][face] > 0) out[components * i + c] = static_cast<float>(moved.mean[i]);
      }
    }
    return out;
  }

  /// Texels of 4 floats, one per cell; the nearest one.
  [[nodiscard]] std::vector<float> nearest(std::span<const float> texels) const {
    std::vector<float> out(4 * to_.cellCount());
    const auto from = [](std::uint32_t k, std::uint32_t from_count, std::uint32_t to_count) {
      return std::min(static_cast<std::size_t>((k + 0.5) * from_count / to_count), std::size_t{from_count} - 1);
    };
    for (std::uint32_t z = 0; z < to_.count.z; ++z) {
      const std::size_t row = from_.count.x * from(z, from_.count.z, to_.count.z);
      for (std::uint32_t x = 0; x < to_.count.x; ++x) {
        const std::size_t i = x + std::size_t{to_.count.x} * z;
        if (!to_.wet[i]) continue;
        const std::size_t at = row + from(x, from_.count.x, to_.count.x);
        std::copy_n(texels.begin() + static_cast<std::ptrdiff_t>(4 * at), 4,
                    out.begin() + static_cast<std::ptrdiff_t>(4 * i));
      }
    }
    return out;
  }

  /// Texels of 4 floats, one per two cells along each axis.
  [[nodiscard]] std::vector<float> meansOfFoam(std::span<const float> texels) const {
    const std::size_t count = from_.foam_count.total();
    std::vector<float> out(4 * to_.foam_count.total());
    for (std::size_t c = 0; c < 4; ++c) {
      Field field{std::vector<double>(count), std::vector<double>(count, 1.0)};
      for (std::size_t i = 0; i < count; ++i) field.mean[i] = texels[4 * i + c];
      const Field moved = resample(field, from_.foam_count, to_.foam_count, x_, z_);
      for (std::size_t i = 0; i < moved.mean.size(); ++i) out[4 * i + c] = static_cast<float>(moved.mean[i]);
    }
    return out;
  }

 private:
  /// Nonlinear bulk: the level of the water where there is some, over the new ground. What the water holds beyond water
  /// at rest stays to the unit.
  [[nodiscard]] std::vector<std::int32_t> shallowElevation(std::int64_t extra_units) const {
    Field field{std::vector<double>(from_.cellCount()), std::vector<double>(from_.cellCount())};
    std::int64_t excess_units = -from_.restingWater();
    for (std::size_t i = 0; i < field.mean.size(); ++i) {
      const std::int64_t eta = std::llround(before_.state.elevation_m[i] * double{ELEVATION_UNITS_PER_M});
      const std::int64_t held = eta + from_.bed_units[i];
      excess_units += held;
      if (held <= 0) continue;
      field.mean[i] = static_cast<double>(eta);
      field.share[i] = 1.0;
    }
    const Field moved = resample(field, from_.count, to_.count, x_, z_);
    std::vector<std::int64_t> held(to_.cellCount());
    std::int64_t lack_units =
        std::llround(static_cast<double>(excess_units) * unitRatio()) + extra_units + to_.restingWater();
    for (std::size_t i = 0; i < held.size(); ++i) {
      if (moved.share[i] >= 0.5) held[i] = std::max<std::int64_t>(std::llround(moved.mean[i]) + to_.bed_units[i], 0);
      lack_units -= held[i];
    }
    spread(lack_units, held);
    std::vector<std::int32_t> out(held.size());
    for (std::size_t i = 0; i < held.size(); ++i) out[i] = static_cast<std::int32_t>(held[i] - to_.bed_units[i]);
    return out;
  }

  [[nodiscard]] Field onWetCells(std::vector<double> values) const {
    Field field{std::move(values), std::vector<double>(from_.wet.begin(), from_.wet.end())};
    for (std::size_t i = 0; i < field.mean.size(); ++i)
      if (!from_.wet[i]) field.mean[i] = 0.0;
    Field moved = resample(field, from_.count, to_.count, x_, z_);
    settleOn(to_.wet, to_.count, x_.is_periodic, z_.is_periodic, moved);
    return moved;
  }

  const CarriedState& before_;
  const core::Scene& scene_;
  Grid from_, to_;
  SampleAxis x_, z_;
};

/// Drops of a two-way scene.
struct Spray {
  std::vector<float> position, velocity;
  std::vector<std::uint32_t> pool;
  std::int64_t rest_units = 0;  ///< volume that no drop holds, in units of the new cells
};

Spray resampleSpray(const CarriedState& before, const core::Scene& scene, const Derived& derived, double unit_ratio) {
  std::vector<std::size_t> alive;
  const std::vector<float>& old = before.state.position;
  for (std::size_t at = 0; at + 3 < old.size(); at += 4) {
    const auto own = std::span(old).subspan(at, 4);
    if (own[3] != DEAD_ID && std::ranges::all_of(own, [](float v) { return std::isfinite(v); })) alive.push_back(at);
  }
  const std::int64_t held_units =
      std::llround(static_cast<double>(alive.size()) * before.derived.uniforms.droplet_units * unit_ratio);
  const std::int64_t drop_units = derived.uniforms.droplet_units;
  const auto count = static_cast<std::size_t>(
      std::min<std::int64_t>(drop_units > 0 ? held_units / drop_units : 0, derived.particles->count));
  Spray out;
  out.rest_units = held_units - static_cast<std::int64_t>(count) * drop_units;
  const ParticleLayout& layout = *derived.particles;
  // Several drops of an old one start within its size, so that they do not push each other apart.
  const double spread_m = count > alive.size() ? 0.5 * before.derived.particles->spacing_m : 0.0;
  core::SplitMix64 random(scene.seed);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t at = alive[k * alive.size() / count];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double place_m = old[at + axis] + spread_m * random.symmetric();
      out.position.push_back(static_cast<float>(std::clamp(place_m, layout.min_m[axis], layout.max_m[axis])));
    }
    out.position.push_back(old[at + 3]);
    for (std::size_t c = 0; c < 4; ++c) out.velocity.push_back(before.state.velocity[at + c]);
  }
  out.pool.assign(POOL_WORDS, 0);
  out.pool[POOL_COUNT] = out.pool[POOL_LIVE] = out.pool[POOL_EMITTED] = static_cast<std::uint32_t>(count);
  if (count > 0) {
    // A frame may be packed before the next tick plans its dispatches.
    out.pool[POOL_PARTICLE_ARGS] = static_cast<std::uint32_t>((count + POOL_GROUP - 1) / POOL_GROUP);
    out.pool[POOL_PARTICLE_ARGS + 1] = out.pool[POOL_PARTICLE_ARGS + 2] = 1;
  }
  return out;
}

/// core::WaveScene without what its level and live parameters decide.
core::WaveScene fixedPart(core::WaveScene wave) {
  const core::WaveScene any;
  wave.resolution_count = any.resolution_count;
  wave.width_m = any.width_m;  // isSameWater() compares it
  wave.depth_m = any.depth_m;
  wave.damping_per_s = any.damping_per_s;
  wave.steepening_ratio = any.steepening_ratio;
  wave.manning_spm13 = any.manning_spm13;
  wave.fixed_substeps_count = any.fixed_substeps_count;
  return wave;
}

/// Levels round the width to whole cells of their own.
bool hasSameWidth(const core::WaveCells& a, const core::WaveCells& b) {
  return std::abs(a.width_m - b.width_m) <= std::max(a.cell_m, b.cell_m);
}

bool hasSameParticles(const core::ParticleScene& a, const core::ParticleScene& b) {
  return a.solver == b.solver && a.box_side_m == b.box_side_m && a.box_width_m == b.box_width_m &&
         a.boundary_x == b.boundary_x && a.boundary_z == b.boundary_z && a.periodic_y == b.periodic_y;
}

}  // namespace

bool isSameWater(const core::Scene& a, const core::Scene& b) {
  const auto same_presence = [](const auto& x, const auto& y) { return x.has_value() == y.has_value(); };
  if (!same_presence(a.wave, b.wave) || !same_presence(a.particles, b.particles) ||
      !same_presence(a.coupling, b.coupling) || !same_presence(a.foam, b.foam) || !same_presence(a.boats, b.boats) ||
      !same_presence(a.storm, b.storm) || !same_presence(a.floaters, b.floaters)) {
    return false;
  }
  if (a.wave && !(fixedPart(*a.wave) == fixedPart(*b.wave) &&
                  hasSameWidth(core::waveCellsOf(*a.wave), core::waveCellsOf(*b.wave))))
    return false;
  if (a.particles && !hasSameParticles(*a.particles, *b.particles)) return false;
  if (a.coupling && a.coupling->mode != b.coupling->mode) return false;
  if (a.wave && hasSurfaceFoam(a) != hasSurfaceFoam(b)) return false;
  if (a.boats && a.boats->capacity_count != b.boats->capacity_count) return false;
  if (a.floaters && a.floaters->capacity_count != b.floaters->capacity_count) return false;
  return a.obstacles == b.obstacles && a.beaches == b.beaches && a.bed == b.bed && a.wave_makers == b.wave_makers;
}

ResampledState resampleState(const CarriedState& before, const core::Scene& scene, const Derived& derived) {
  ResampledState out;
  out.state.boats = before.state.boats;
  out.state.floaters = before.state.floaters;
  if (derived.particles && !isTwoWay(scene)) {
    RelaidParticles relaid = scene.wave ? relayParticles(scene, before.derived, before.state, *derived.particles)
                                        : refillParticles(scene, before.derived, before.state, *derived.particles);
    out.state.position = std::move(relaid.position);
    out.state.velocity = std::move(relaid.velocity);
  }
  if (!derived.wave) return out;
  const SurfaceCarrier carrier(before, scene, derived);
  std::int64_t spray_units = 0, rest_units = 0;
  if (isTwoWay(scene)) {
    Spray spray = resampleSpray(before, scene, derived, carrier.unitRatio());
    rest_units = spray.rest_units;
    spray_units = std::int64_t{spray.pool[POOL_EMITTED]} * derived.uniforms.droplet_units;
    out.state.position = std::move(spray.position);
    out.state.velocity = std::move(spray.velocity);
    out.state.pool = std::move(spray.pool);
  }
  std::int64_t surface_units = isNonlinear(scene) ? -carrier.restingElevation() : 0;
  for (const std::int32_t units : carrier.elevation(rest_units)) {
    surface_units += units;
    out.state.elevation_m.push_back(units * double{ELEVATION_UNIT_M});
  }
  out.outflow_units = -surface_units - spray_units;
  out.state.flow_m2ps = carrier.flow();
  if (!before.state.elevation_x_units.empty()) out.state.elevation_x_units = carrier.elevationX();
  if (!before.state.breaking.empty()) out.state.breaking = carrier.nearest(before.state.breaking);
  if (!before.state.foam.empty()) out.state.foam = carrier.meansOfFoam(before.state.foam);
  return out;
}

}  // namespace spindrift::sim
