
#include <algorithm>
#include <cmath>
#include <numbers>

#include <spindrift/sim_setup/lattice.h>

namespace spindrift::sim {
namespace {

using core::KernelSet;
using std::numbers::pi;

double cubicShape(double q) {
  return q >= 1 ? 0.0 : q <= 0.5 ? 6 * q * q * (q - 1) + 1 : 2 * std::pow(1 - q, 3);
}
double cubicSlope(double q) {
  return q >= 1 ? 0.0 : q <= 0.5 ? 6 * q * (2 - 3 * q) : 6 * (1 - q) * (1 - q);
}

int layersWithin(double s, double H) {
  return static_cast<int>(std::ceil(H / s));
}

/// Sum of f(r) over the layers low..high of an infinite lattice, counted in spacings above the particle.
template <typename F>
double sumLayers(double s, double H, int low, int high, F f) {
  const int reach = layersWithin(s, H);
  double sum = 0.0;
  for (int y = low; y <= high; ++y) {
    for (int z = -reach; z <= reach; ++z) {
      for (int x = -reach; x <= reach; ++x) sum += f(s * std::sqrt(x * x + y * y + z * z));
    }
  }
  return sum;
}

/// The same over all layers within H.
template <typename F>
double sumLattice(double s, double H, F f) {
  const int reach = layersWithin(s, H);
  return sumLayers(s, H, -reach, reach, f);
}

/// Squared horizontal distances from the centre to the points of a square lattice with 2 reach + 1 points per side.
std::vector<double> lateralSquares(double s, int reach) {
  std::vector<double> out;
  for (int z = -reach; z <= reach; ++z) {
    for (int x = -reach; x <= reach; ++x) out.push_back(s * s * (x * x + z * z));
  }
  return out;
}

/// Sum of f(distance, height) over the points of a layer, as a table over heights from 0 to H; zero above H. Linear
/// between 4096 heights: the error is 1e-7 of the largest value.
class HeightTable {
 public:
  template <typename F>
  HeightTable(double H, const std::vector<double>& lateral, F f) : per_m_(kIntervals / H) {
    for (int k = 0; k <= kIntervals; ++k) {
      const double dy = k / per_m_;
      double sum = 0.0;
      for (const double d2 : lateral) sum += f(std::sqrt(d2 + dy * dy), dy);
      sum_.push_back(sum);
    }
  }
  double operator()(double height_m) const {
    const double u = height_m * per_m_;
    if (u >= kIntervals) return 0.0;
    const auto k = static_cast<std::size_t>(u);
    const double t = u - static_cast<double>(k);
    return (1 - t) * sum_[k] + t * sum_[k + 1];
  }

 private:
  static constexpr int kIntervals = 4096;
  double per_m_;
  std::vector<double> sum_;
};

}  // namespace

double densityNorm(KernelSet set, double H) {
  switch (set) {
    case KernelSet::kMuller:
      return 315.0 / (64.0 * pi * std::pow(H, 9));
    case KernelSet::kCubicSpline:
      return cubicNorm(H);
    case KernelSet::kWendlandC2:
      break;
  }
  return 21.0 / (2.0 * pi * std::pow(H, 3));
}

double slopeNorm(KernelSet set, double H) {
  switch (set) {
    case KernelSet::kMuller:
      return viscosityNorm(H);  // the spiky gradient has the same factor
    case KernelSet::kCubicSpline:
      return cubicNorm(H) / H;
    case KernelSet::kWendlandC2:
      break;
  }
  return 20.0 * densityNorm(set, H) / H;
}

double viscosityNorm(double H) {
  return 45.0 / (pi * std::pow(H, 6));
}
double cubicNorm(double H) {
  return 8.0 / (pi * std::pow(H, 3));
}

double densityKernel(KernelSet set, double r, double H) {
  if (r >= H) return 0.0;
  const double q = r / H;
  const double norm = densityNorm(set, H);
  if (set == KernelSet::kMuller) return norm * std::pow(H * H - r * r, 3);
  if (set == KernelSet::kCubicSpline) return norm * cubicShape(q);
  return norm * std::pow(1 - q, 4) * (4 * q + 1);
}

double pressureSlope(KernelSet set, double r, double H) {
  if (r >= H) return 0.0;
  const double q = r / H;
  const double norm = slopeNorm(set, H);
  if (set == KernelSet::kMuller) return norm * (H - r) * (H - r);
  if (set == KernelSet::kCubicSpline) return norm * cubicSlope(q);
  return norm * q * std::pow(1 - q, 3);
}

double latticeNeighbours(double s, double H) {
  return sumLattice(s, H, [&](double r) { return r <= H * (1 + 1e-9) ? 1.0 : 0.0; }) - 1.0;
}

double calibratedMass(KernelSet set, double s, double H, double rho_0) {
  return rho_0 / sumLattice(s, H, [&](double r) { return densityKernel(set, r, H); });
}

double calibratedVirtualMass(KernelSet set, double s, double H, double rho_0, double mass_kg, int points) {
  const double missing =
      rho_0 - mass_kg * sumLayers(s, H, 0, layersWithin(s, H), [&](double r) { return densityKernel(set, r, H); });
  const double depth = 0.5 + kVirtualDepthRatio;
  double lattice = 0.0;
  for (const double d2 : lateralSquares(s, points / 2))
    lattice += cubicNorm(H) * cubicShape(std::sqrt(d2 + s * s * depth * depth) / H);
  return missing / lattice;
}

WallSupport calibratedWall(KernelSet set, double s, double H, double rho_0, double mass_kg) {
  const int reach = layersWithin(s, H);
  double share = 0.0;
  double slope_pm = 0.0;
  for (int y = 1; y <= reach; ++y) {
    for (const double d2 : lateralSquares(s, reach)) {
      const double r = std::sqrt(d2 + s * s * y * y);
      share += mass_kg * densityKernel(set, r, H) / rho_0;
      slope_pm += mass_kg * pressureSlope(set, r, H) * s * y / r / rho_0;
    }
  }
  WallSupport wall;
  wall.reach_m = s / 2 + share / slope_pm;  // f'/f = -2 / (D - s/2) = -2 slope / share
  wall.share = share / std::pow(1 - s / 2 / wall.reach_m, 2);
  return wall;
}

double calibratedFloorDrag(double s, double H, double rho_0, double mass_kg, const WallSupport& wall) {
  double laplacian_pm2 = 0.0;
  for (int y = 1; y <= layersWithin(s, H); ++y) {
    for (const double d2 : lateralSquares(s, layersWithin(s, H)))
      laplacian_pm2 += 2 * y * mass_kg / rho_0 * viscosityNorm(H) * std::max(H - std::sqrt(d2 + s * s * y * y), 0.0);
  }
  return laplacian_pm2 / std::pow(1 - s / 2 / wall.reach_m, 2);
}

double latticeConstraintSlope2(KernelSet set, double s, double H, double rho_0, double mass_kg) {
  return sumLattice(s, H,
                    [&](double r) { return r > 0 ? std::pow(mass_kg * pressureSlope(set, r, H) / rho_0, 2) : 0.0; });
}

double latticeStressRatio(KernelSet set, double s, double H, double rho_0, double mass_kg) {
  return sumLattice(s, H, [&](double r) { return mass_kg / rho_0 * r * pressureSlope(set, r, H) / 3; });
}

double settledStressRatio(KernelSet set) {
  return set == KernelSet::kMuller ? 1.0 : 0.97;
}

double pressureOf(core::EquationOfState equation, double stiffness_m2ps2, double rho_0, double rho) {
  if (equation == core::EquationOfState::kLinear) return stiffness_m2ps2 * (rho - rho_0);
  return stiffness_m2ps2 * rho_0 / 7 * (std::pow(rho / rho_0, 7) - 1);
}

std::vector<double> restingLayers(const core::ParticleScene& water, const ParticleLayout& layout,
                                  double stiffness_m2ps2, double gravity_mps2, int floor_points) {
  const double s = layout.spacing_m;
  const double H = layout.support_radius_m;
  const KernelSet set = water.kernel_set;
  const auto n = std::size_t{layout.layers_count};
  std::vector<double> y(n);
  for (std::size_t k = 0; k < n; ++k) y[k] = (static_cast<double>(k) + 0.5) * s;
  if (gravity_mps2 <= 0) return y;  // nothing presses on the lattice
  constexpr int kMaxIterations = 20'000;
  constexpr double kVelocityKeep = 0.98;  // damps the fall within a few dozen steps
  constexpr double kToleranceOfGravity = 1e-3;
  const double dt_s = 0.1 * H / std::sqrt(std::max(stiffness_m2ps2, gravity_mps2 * H));
  // Contribution of a whole layer at the height difference dy: summed over its particles once, then read from a table.
  const std::vector<double> lateral = lateralSquares(s, layersWithin(s, H));
  const std::vector<double> floor_lateral = lateralSquares(s, floor_points / 2);
  const HeightTable density_of(H, lateral, [&](double r, double) { return densityKernel(set, r, H); });
  const HeightTable push_of(H, lateral,
                            [&](double r, double dy) { return r > 0 ? pressureSlope(set, r, H) * dy / r : 0.0; });
  const HeightTable lattice_density_of(H, floor_lateral,
                                       [&](double r, double) { return cubicNorm(H) * cubicShape(r / H); });
  const HeightTable lattice_push_of(H, floor_lateral, [&](double r, double dy) {
    return r > 0 ? cubicNorm(H) / H * cubicSlope(r / H) * dy / r : 0.0;
  });
  // The floor's density at a height, and minus its slope.
  const bool is_flat = floor_points == 0;
  const auto floor_density_of = [&](double height_m) {
    if (!is_flat) return layout.virtual_mass_kg * lattice_density_of(height_m + kVirtualDepthRatio * s);
    const double u = std::max(1 - height_m / layout.wall_reach_m, 0.0);
    return water.rest_density_kgpm3 * layout.wall_share * u * u;
  };
  const auto floor_push_of = [&](double height_m) {
    if (!is_flat) return layout.virtual_mass_kg * lattice_push_of(height_m + kVirtualDepthRatio * s);
    const double u = std::max(1 - height_m / layout.wall_reach_m, 0.0);
    return water.rest_density_kgpm3 * layout.wall_share * 2 * u / layout.wall_reach_m;
  };

  std::vector<double> v(n, 0.0), pressure(n), density(n);
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    for (std::size_t k = 0; k < n; ++k) {
      double rho = floor_density_of(y[k]);
      for (std::size_t j = 0; j < n; ++j) rho += layout.mass_kg * density_of(std::abs(y[k] - y[j]));
      density[k] = rho;
      pressure[k] = pressureOf(water.equation_of_state, stiffness_m2ps2, water.rest_density_kgpm3, rho);
      if (!water.cohesion) pressure[k] = std::max(pressure[k], 0.0);
    }
    double worst = 0.0;
    for (std::size_t k = 0; k < n; ++k) {
      double a = -gravity_mps2;
      const double own = pressure[k] / (density[k] * density[k]);
      for (std::size_t j = 0; j < n; ++j) {
        const double dy = y[k] - y[j];
        const double push = push_of(std::abs(dy));
        if (push == 0) continue;
        const double pair = water.pressure_force == core::PressureForce::kMean
                                ? (pressure[k] + pressure[j]) / (2 * density[k] * density[j])
                                : own + pressure[j] / (density[j] * density[j]);
        a += layout.mass_kg * pair * std::copysign(push, dy);
      }
      a += std::max(own, 0.0) * floor_push_of(y[k]);
      worst = std::max(worst, std::abs(a));
      v[k] = kVelocityKeep * v[k] + dt_s * a;
    }
    for (std::size_t k = 0; k < n; ++k) y[k] = std::max(y[k] + dt_s * v[k], kFloorGapRatio * s);
    if (worst <= kToleranceOfGravity * gravity_mps2) break;
  }
  return y;
}

}  // namespace spindrift::sim
