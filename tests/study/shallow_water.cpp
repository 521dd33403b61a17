#include "shallow_water.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <spindrift/sim_setup/basin.h>

namespace spindrift::study {

using core::WaveBoundary;

core::Scene shallowScene(std::uint32_t resolution_count, double cell_m, double depth_m, double courant) {
  core::Scene scene;
  scene.name = "shallow";
  scene.wave.emplace();
  scene.wave->resolution_count = resolution_count;
  scene.wave->side_m = cell_m * resolution_count;
  scene.wave->depth_m = depth_m;
  scene.wave->damping_per_s = 0.0;
  scene.wave->bulk = core::Bulk::kNonlinear;
  scene.wave->manning_spm13 = 0.0;
  setBoundaries(*scene.wave, WaveBoundary::kReflect);
  scene.wave->fixed_substeps_count = 1;
  scene.allow_unstable = true;  // the tick is the step, whatever the rule would choose
  scene.tick_rate_hz = std::sqrt(scene.gravity_mps2 * depth_m) / (courant * cell_m);
  return scene;
}

core::Scene shallowChannel(std::uint32_t cells, double cell_m, double depth_m, double courant) {
  constexpr int kAcross = 4;
  core::Scene scene = shallowScene(cells, cell_m, depth_m, courant);
  scene.wave->width_m = kAcross * cell_m;
  return scene;
}

void makePeriodic(core::Scene& scene) {
  setBoundaries(*scene.wave, WaveBoundary::kPeriodic);
}

int fitTicks(core::Scene& scene, double duration_s, double longest_tick_s) {
  const double count = std::ceil(duration_s / longest_tick_s);
  scene.tick_rate_hz = count / duration_s;
  return static_cast<int>(count);
}

void setBed(core::Scene& scene, const Field2& depth_m) {
  const core::WaveCells water = core::waveCellsOf(*scene.wave);
  core::DepthGrid grid;
  grid.columns_count = 2 * water.count.x + 1;
  grid.rows_count = 2 * water.count.z + 1;
  std::vector<float> depths;
  depths.reserve(std::size_t{grid.columns_count} * grid.rows_count);
  for (std::uint32_t r = 0; r < grid.rows_count; ++r) {
    const double z_m = 0.5 * r * water.cell_m - water.width_m / 2;
    for (std::uint32_t c = 0; c < grid.columns_count; ++c) {
      depths.push_back(static_cast<float>(depth_m(0.5 * c * water.cell_m - water.length_m / 2, z_m)));
    }
  }
  grid.depths_m = std::make_shared<const std::vector<float>>(std::move(depths));
  scene.bed.emplace().grid = std::move(grid);
}

std::vector<double> rowOf(sim::WaterSim& water) {
  const std::size_t nx = water.derived().wave->count_x;
  const std::vector<double> eta_m = water.copyState().elevation_m;
  return {eta_m.begin() + static_cast<std::ptrdiff_t>(nx), eta_m.begin() + static_cast<std::ptrdiff_t>(2 * nx)};
}

std::vector<double> placesAlong(const sim::WaterSim& water) {
  const sim::WaveLayout& layout = *water.derived().wave;
  std::vector<double> out(layout.count_x);
  for (std::size_t x = 0; x < out.size(); ++x)
    out[x] = (static_cast<double>(x) + 0.5) * layout.cell_m - layout.length_m / 2;
  return out;
}

std::vector<double> groundDepths(const core::Scene& scene, const sim::WaveLayout& layout) {
  const sim::Basin basin = sim::layOutBasin(scene, layout);
  std::vector<double> out(basin.bed.size());
  std::ranges::transform(basin.bed, out.begin(), [](const auto& cell) { return static_cast<double>(cell[2]); });
  return out;
}

void setShallowState(sim::WaterSim& water, const Field2& eta_m, const Field2& u_mps, const Field2& w_mps) {
  const sim::WaveLayout& layout = *water.derived().wave;
  const std::vector<double> depth_m = groundDepths(water.scene(), layout);
  const std::size_t nx = layout.count_x, nz = layout.count_z;
  const double cell_m = layout.cell_m;
  const auto placeX = [&](std::size_t x) { return (static_cast<double>(x) + 0.5) * cell_m - layout.length_m / 2; };
  const auto placeZ = [&](std::size_t z) { return (static_cast<double>(z) + 0.5) * cell_m - layout.width_m / 2; };
  sim::StateCopy state = water.copyState();
  for (std::size_t i = 0; i < depth_m.size(); ++i) {
    const double x_m = placeX(i % nx);
    const double z_m = placeZ(i / nx);
    // The resting state has the ground in whole units; only water above it is set.
    if (eta_m(x_m, z_m) > -depth_m[i]) {
      state.elevation_m[i] = eta_m(x_m, z_m);
    } else if (depth_m[i] > 0) {
      state.elevation_m[i] = -std::floor(depth_m[i] * (1 << 24)) / (1 << 24);
    }
  }
  const auto water_m = [&](std::size_t i) { return std::max(state.elevation_m[i] + depth_m[i], 0.0); };
  for (std::size_t i = 0; i < depth_m.size(); ++i) {
    const std::size_t x = i % nx, z = i / nx;
    const double x_m = placeX(x);
    const double z_m = placeZ(z);
    const auto set = [&](std::size_t axis, bool is_inside, std::size_t to, double speed_mps) {
      const double carried_m = speed_mps > 0 ? water_m(i) : is_inside ? water_m(to) : 0.0;
      const double u = is_inside && carried_m > 0 ? speed_mps : 0.0;
      state.flow_m2ps[4 * i + axis] = static_cast<float>(u);
      state.flow_m2ps[4 * i + 2 + axis] = static_cast<float>(u * carried_m);
    };
    const auto isOpen = [](bool is_inside, WaveBoundary side) { return is_inside || side == WaveBoundary::kPeriodic; };
    const core::WaveScene& w = *water.scene().wave;
    set(0, isOpen(x + 1 < nx, w.boundary_plus_x), (x + 1) % nx + nx * z, u_mps ? u_mps(x_m + cell_m / 2, z_m) : 0.0);
    set(1, isOpen(z + 1 < nz, w.boundary_plus_z), x + nx * ((z + 1) % nz), w_mps ? w_mps(x_m, z_m + cell_m / 2) : 0.0);
  }
  water.setState(state);
}

DamBreak::Flow DamBreak::at(double x_m, double time_s) const {
  const double g = gravity_mps2;
  const double c = std::sqrt(g * high_m);
  const double xi = x_m / time_s;
  if (xi < -c) return {high_m, 0.0};
  const auto fan = [&]() -> Flow { return {std::pow(2 * c - xi, 2) / (9 * g), 2.0 / 3 * (c + xi)}; };
  if (low_m <= 0) return xi < 2 * c ? fan() : Flow{0.0, 0.0};
  // Depth between fan and bore: the velocity behind the bore is that at the foot of the fan.
  double below = low_m, above = high_m;
  for (int k = 0; k < 100; ++k) {
    const double h = (below + above) / 2;
    const double excess = 2 * (c - std::sqrt(g * h)) - (h - low_m) * std::sqrt(g * (h + low_m) / (2 * h * low_m));
    (excess > 0 ? below : above) = h;
  }
  const double u = 2 * (c - std::sqrt(g * below));
  if (xi < u - std::sqrt(g * below)) return fan();
  return xi < below * u / (below - low_m) ? Flow{below, u} : Flow{low_m, 0.0};
}

}  // namespace spindrift::study
