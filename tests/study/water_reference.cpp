#include <algorithm>
#include <cmath>
#include <numbers>

#include <spindrift/study/water_reference.h>

namespace spindrift::study {
namespace {

using std::numbers::pi;

using core::KernelSet;

double cubic(double r, double H) {
  const double q = r / H;
  if (q >= 1) return 0;
  return 8 / (pi * H * H * H) * (q <= 0.5 ? 6 * q * q * (q - 1) + 1 : 2 * std::pow(1 - q, 3));
}
double cubicGradient(double r, double H) {
  const double q = r / H;
  if (q >= 1) return 0;
  return 8 / (pi * H * H * H) * (q <= 0.5 ? 18 * q * q - 12 * q : -6 * (1 - q) * (1 - q)) / H;
}

double densityKernel(KernelSet set, double r, double H) {
  const double q = r / H;
  if (q >= 1) return 0;
  if (set == KernelSet::kMuller) return 315 / (64 * pi * std::pow(H, 9)) * std::pow(H * H - r * r, 3);
  if (set == KernelSet::kCubicSpline) return cubic(r, H);
  return 21 / (2 * pi * H * H * H) * std::pow(1 - q, 4) * (4 * q + 1);
}
/// dW/dr
double pressureGradient(KernelSet set, double r, double H) {
  const double q = r / H;
  if (q >= 1) return 0;
  if (set == KernelSet::kMuller) return -45 / (pi * std::pow(H, 6)) * (H - r) * (H - r);
  if (set == KernelSet::kCubicSpline) return cubicGradient(r, H);
  return -21 / (2 * pi * H * H * H) * 20 * q * std::pow(1 - q, 3) / H;
}
double viscosityLaplacian(double r, double H) {
  return r < H ? 45 / (pi * std::pow(H, 6)) * (H - r) : 0;
}
double length(const Vec3& a) {
  return std::hypot(a[0], a[1], a[2]);
}

/// Returns x_i - x_j, the shortest way across periodic sides.
Vec3 between(const core::Scene& scene, const sim::Derived& d, const Vec3& a, const Vec3& b) {
  Vec3 r = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  const bool periodic[3] = {scene.particles->boundary_x == core::Boundary::kPeriodic, scene.particles->periodic_y,
                            scene.particles->boundary_z == core::Boundary::kPeriodic};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double side = d.particles->max_m[axis] - d.particles->min_m[axis];
    if (periodic[axis]) r[axis] -= side * std::round(r[axis] / side);
  }
  return r;
}

int wrap(int i, int n, bool periodic) {
  return periodic ? (i % n + n) % n : std::clamp(i, 0, n - 1);
}

/// The cell at (x, z); beyond a side the one across or beside it.
std::size_t cellAt(const sim::WaveLayout& wave, int x, int z) {
  const int nx = static_cast<int>(wave.count_x);
  const int nz = static_cast<int>(wave.count_z);
  return static_cast<std::size_t>(wrap(x, nx, wave.is_periodic_x) + nx * wrap(z, nz, wave.is_periodic_z));
}

struct Floor {
  const core::Scene& scene;
  const sim::Derived& d;
  const ReferenceSurface& s;

  bool flat() const { return s.eta_m.empty(); }
  std::size_t at(int x, int z) const { return cellAt(*d.wave, x, z); }

  /// Value of the nearest cell, extrapolated along its gradient.
  double height(double x, double z) const {
    if (flat()) return -d.particles->band_m;
    const double u = (x + d.wave->length_m / 2) / d.wave->cell_m;
    const double w = (z + d.wave->width_m / 2) / d.wave->cell_m;
    const std::size_t i = at(static_cast<int>(std::floor(u)), static_cast<int>(std::floor(w)));
    return s.eta_m[i] + s.slope_x[i] * (u - std::floor(u) - 0.5) * d.wave->cell_m +
           s.slope_z[i] * (w - std::floor(w) - 0.5) * d.wave->cell_m - d.particles->band_m;
  }

  double bilinear(const std::vector<double>& field, double x, double z) const {
    const double u = (x + d.wave->length_m / 2) / d.wave->cell_m - 0.5;
    const double w = (z + d.wave->width_m / 2) / d.wave->cell_m - 0.5;
    const int i = static_cast<int>(std::floor(u));
    const int k = static_cast<int>(std::floor(w));
    const double a = u - i;
    const double b = w - k;
    return (1 - b) * ((1 - a) * field[at(i, k)] + a * field[at(i + 1, k)]) +
           b * ((1 - a) * field[at(i, k + 1)] + a * field[at(i + 1, k + 1)]);
  }

  Vec3 velocity(double x, double z) const {
    if (flat()) return {0, 0, 0};
    return {bilinear(s.flow_x_mps, x, z), bilinear(s.rate_mps, x, z), bilinear(s.flow_z_mps, x, z)};
  }

  /// Remaining reach at x of a flat floor, which supports like a wall; 0 in a box without one.
  double reach(const Vec3& x) const {
    if (scene.particles->periodic_y) return 0;
    return std::max(1 - std::max(x[1] + d.particles->band_m, 0.0) / d.particles->wall_reach_m, 0.0);
  }

  /// The floor's share of the density. [kg/m^3]
  double density(const Vec3& x) const {
    if (!scene.coupling) return scene.particles->rest_density_kgpm3 * d.particles->wall_share * reach(x) * reach(x);
    double sum = 0;
    for (const Vec3& r : lattice(x))
      sum += d.particles->virtual_mass_kg * cubic(length(r), d.particles->support_radius_m);
    return sum;
  }

  /// Gradient of that share: under coupled water the sum over the virtual particles, whose heights count as fixed.
  /// [kg/m^4]
  Vec3 gradient(const Vec3& x) const {
    const double slope = -2 * scene.particles->rest_density_kgpm3 * d.particles->wall_share / d.particles->wall_reach_m;
    if (!scene.coupling) return {0, slope * reach(x), 0};
    Vec3 sum = {0, 0, 0};
    for (const Vec3& r : lattice(x)) {
      const double factor =
          d.particles->virtual_mass_kg * cubicGradient(length(r), d.particles->support_radius_m) / length(r);
      for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += factor * r[axis];
    }
    return sum;
  }

  /// Laplacian for the viscosity against the floor. [1/m^2]
  double drag(const Vec3& x) const {
    if (!scene.coupling) return d.particles->floor_drag_pm2 * reach(x) * reach(x);
    double sum = 0;
    for (const Vec3& r : lattice(x))
      sum += d.particles->virtual_mass_kg / scene.particles->rest_density_kgpm3 *
             viscosityLaplacian(length(r), d.particles->support_radius_m);
    return sum;
  }

  /// Vectors from each virtual particle in reach to the particle. Coupled water only.
  std::vector<Vec3> lattice(const Vec3& x) const {
    std::vector<Vec3> out;
    if (x[1] - height(x[0], x[2]) + d.particles->spacing_m / 2 >= d.particles->support_radius_m) return out;
    const int points = static_cast<int>(scene.coupling->lattice_count);
    const double spacing = d.particles->spacing_m;
    for (int k = -(points / 2); k <= points / 2; ++k) {
      for (int i = -(points / 2); i <= points / 2; ++i)
        out.push_back(
            {-i * spacing, x[1] - height(x[0] + i * spacing, x[2] + k * spacing) + spacing / 2, -k * spacing});
    }
    return out;
  }
};

double pressure(const core::Scene& scene, const sim::Derived& d, double rho) {
  const core::ParticleScene& s = *scene.particles;
  const double rho_0 = s.rest_density_kgpm3;
  // c0^2 over the virial of the starting lattice, times the ratio after settling.
  const double settled = s.kernel_set == core::KernelSet::kMuller ? 1.0 : 0.97;
  const double H = d.particles->support_radius_m;
  double virial = 0;
  for (int z = -4; z <= 4; ++z) {
    for (int y = -4; y <= 4; ++y) {
      for (int x = -4; x <= 4; ++x) {
        const double r = d.particles->spacing_m * length({1.0 * x, 1.0 * y, 1.0 * z});
        virial -= d.particles->mass_kg / rho_0 * r * pressureGradient(s.kernel_set, r, H) / 3;
      }
    }
  }
  const double k = s.sound_speed_mps * s.sound_speed_mps / (virial * settled);
  const double p = s.equation_of_state == core::EquationOfState::kTait ? rho_0 * k / 7 * (std::pow(rho / rho_0, 7) - 1)
                                                                       : k * (rho - rho_0);
  return s.cohesion ? p : std::max(p, 0.0);
}

/// Of a pair that approaches with this speed, over the rest density. [m^2/s^2]
double collisionStress(const sim::Derived& d, double approach_mps) {
  constexpr double kCollisionFactor = 6.0;
  return approach_mps * std::min(kCollisionFactor * approach_mps, d.particles->spacing_m / (4 * d.dt_s));
}

double length2(const Vec3& a) {
  return a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
}

/// Density beyond floor and walls: the shares combine like independent covers.
double boundaryDensity(const core::Scene& scene, const sim::Derived& d, const Floor& floor, const Vec3& x) {
  const double rho_0 = scene.particles->rest_density_kgpm3;
  double open = 1;
  for (const std::size_t axis : {0u, 2u}) {
    const auto side = axis == 0 ? scene.particles->boundary_x : scene.particles->boundary_z;
    if (side == core::Boundary::kPeriodic) continue;
    double share = 0;
    for (const double distance : {x[axis] - d.particles->min_m[axis], d.particles->max_m[axis] - x[axis]}) {
      const double u = 1 - std::max(distance, 0.0) / d.particles->wall_reach_m;
      if (u > 0) share += d.particles->wall_share * u * u;
    }
    open *= 1 - share;
  }
  return rho_0 * (1 - open * (1 - floor.density(x) / rho_0));
}

/// Gradient of that density, numerical for walls.
Vec3 boundaryGradient(const core::Scene& scene, const sim::Derived& d, const Floor& floor, const Vec3& x) {
  const double H = d.particles->support_radius_m;
  const double rho_0 = scene.particles->rest_density_kgpm3;
  const double floor_density = floor.density(x);
  Vec3 gradient = floor.gradient(x);
  const double open = (rho_0 - boundaryDensity(scene, d, floor, x)) / (rho_0 - floor_density);
  for (double& g : gradient) g *= open;
  for (const std::size_t axis : {0u, 2u}) {
    const auto side = axis == 0 ? scene.particles->boundary_x : scene.particles->boundary_z;
    if (side == core::Boundary::kPeriodic) continue;
    // Far above the floor only walls count.
    const double e = 1e-5 * H;
    Vec3 low = x;
    Vec3 high = x;
    low[1] = high[1] = 1e6;
    low[axis] -= e;
    high[axis] += e;
    gradient[axis] += (1 - floor_density / rho_0) *
                      (boundaryDensity(scene, d, floor, high) - boundaryDensity(scene, d, floor, low)) / (2 * e);
  }
  return gradient;
}

}  // namespace

ReferenceSurface surfaceFrom(const core::Scene& scene, const sim::Derived& d, const std::vector<double>& eta,
                             const std::vector<float>& flow) {
  const int nx = static_cast<int>(d.wave->count_x);
  const int nz = static_cast<int>(d.wave->count_z);
  const auto at = [&](int x, int z) { return cellAt(*d.wave, x, z); };
  // Closed faces carry no flow, so wrapping is correct for walls, too.
  const auto flowAt = [&](int x, int z, int axis) -> double {
    return flow[2 * static_cast<std::size_t>(wrap(x, nx, true) + nx * wrap(z, nz, true)) +
                static_cast<std::size_t>(axis)];
  };
  ReferenceSurface s;
  for (int z = 0; z < nz; ++z) {
    for (int x = 0; x < nx; ++x) {
      s.eta_m.push_back(eta[at(x, z)]);
      s.rate_mps.push_back((flowAt(x - 1, z, 0) - flowAt(x, z, 0) + flowAt(x, z - 1, 1) - flowAt(x, z, 1)) /
                           d.wave->cell_m);
      s.slope_x.push_back((eta[at(x + 1, z)] - eta[at(x - 1, z)]) / (2 * d.wave->cell_m));
      s.slope_z.push_back((eta[at(x, z + 1)] - eta[at(x, z - 1)]) / (2 * d.wave->cell_m));
      s.flow_x_mps.push_back((flowAt(x - 1, z, 0) + flowAt(x, z, 0)) / (2 * scene.wave->depth_m));
      s.flow_z_mps.push_back((flowAt(x, z - 1, 1) + flowAt(x, z, 1)) / (2 * scene.wave->depth_m));
    }
  }
  return s;
}

std::vector<double> referenceDensity(const core::Scene& scene, const sim::Derived& d, const ReferenceSurface& surface,
                                     const std::vector<Vec3>& x) {
  const double H = d.particles->support_radius_m;
  const Floor floor{scene, d, surface};
  std::vector<double> rho(x.size(), 0.0);
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (const Vec3& other : x)
      rho[i] +=
          d.particles->mass_kg * densityKernel(scene.particles->kernel_set, length(between(scene, d, x[i], other)), H);
    rho[i] += boundaryDensity(scene, d, floor, x[i]);
  }
  return rho;
}

std::vector<Vec3> referenceAcceleration(const core::Scene& scene, const sim::Derived& d,
                                        const ReferenceSurface& surface, const std::vector<Vec3>& x,
                                        const std::vector<Vec3>& v, const std::vector<double>& rho) {
  const double H = d.particles->support_radius_m;
  const double m = d.particles->mass_kg;
  const double mu = scene.particles->viscosity_pas;
  const Floor floor{scene, d, surface};
  std::vector<Vec3> out(x.size());
  std::vector<double> p;
  p.reserve(rho.size());
  for (const double rho_i : rho) p.push_back(pressure(scene, d, rho_i));
  for (std::size_t i = 0; i < x.size(); ++i) {
    Vec3 a = {0, -scene.gravity_mps2, 0};
    const double own = p[i];
    const double own_term = own / (rho[i] * rho[i]);
    for (std::size_t j = 0; j < x.size(); ++j) {
      if (j == i) continue;
      const Vec3 r = between(scene, d, x[i], x[j]);
      const double distance = length(r);
      if (distance >= H) continue;
      const double other = p[j];
      const double pair = scene.particles->pressure_force == core::PressureForce::kMean
                              ? (own + other) / (2 * rho[i] * rho[j])
                              : own_term + other / (rho[j] * rho[j]);
      double closing = 0;
      for (int axis = 0; axis < 3; ++axis) closing -= (v[i][axis] - v[j][axis]) * r[axis] / distance;
      const double collision = collisionStress(d, std::max(closing, 0.0)) / scene.particles->rest_density_kgpm3;
      const double push =
          -m * (pair + collision) * pressureGradient(scene.particles->kernel_set, distance, H) / distance;
      const double drag = mu / rho[i] * m / rho[j] * viscosityLaplacian(distance, H);
      for (int axis = 0; axis < 3; ++axis) a[axis] += push * r[axis] + drag * (v[j][axis] - v[i][axis]);
    }
    const Vec3 floor_velocity = floor.velocity(x[i][0], x[i][2]);
    double floor_drag = mu / rho[i] * floor.drag(x[i]);
    if (!scene.coupling) floor_drag /= 1 + d.dt_s * floor_drag;  // implicit
    for (int axis = 0; axis < 3; ++axis) a[axis] += floor_drag * (floor_velocity[axis] - v[i][axis]);
    const Vec3 gradient = boundaryGradient(scene, d, floor, x[i]);
    for (std::size_t axis = 0; axis < 3; ++axis) a[axis] -= std::max(own_term, 0.0) * gradient[axis];
    if (scene.coupling) {
      const double above = std::max(x[i][1] - (floor.height(x[i][0], x[i][2]) + d.particles->band_m), 0.0);
      a[1] -= scene.coupling->downforce_per_m_s2 * above * above;
    }
    out[i] = a;
  }
  return out;
}

ReferenceProjection referenceProjection(const core::Scene& scene, const sim::Derived& d,
                                        const ReferenceSurface& surface, const std::vector<Vec3>& x) {
  const double H = d.particles->support_radius_m;
  const double rho_0 = scene.particles->rest_density_kgpm3;
  const double volume = d.particles->mass_kg / rho_0;
  const Floor floor{scene, d, surface};
  ReferenceProjection out;
  out.rho = referenceDensity(scene, d, surface, x);
  // grad W of a pair, [1/m^4]
  const auto gradient = [&](std::size_t i, std::size_t j) {
    Vec3 r = between(scene, d, x[i], x[j]);
    const double distance = length(r);
    for (double& c : r) c *= distance < H ? pressureGradient(scene.particles->kernel_set, distance, H) / distance : 0;
    return r;
  };
  for (std::size_t i = 0; i < x.size(); ++i) {
    Vec3 own = boundaryGradient(scene, d, floor, x[i]);
    for (double& c : own) c /= rho_0;
    double squares = 0;
    for (std::size_t j = 0; j < x.size(); ++j) {
      if (j == i) continue;
      const Vec3 g = gradient(i, j);
      for (std::size_t axis = 0; axis < 3; ++axis) own[axis] += volume * g[axis];
      squares += volume * volume * length2(g);
    }
    double constraint = out.rho[i] / rho_0 - 1;
    if (!scene.particles->cohesion) constraint = std::max(constraint, 0.0);
    out.lambda_m2.push_back(-constraint / (length2(own) + squares + d.particles->constraint_softness_pm2));
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    Vec3 move = boundaryGradient(scene, d, floor, x[i]);
    for (double& c : move) c *= std::min(out.lambda_m2[i], 0.0) / rho_0;
    for (std::size_t j = 0; j < x.size(); ++j) {
      if (j == i) continue;
      const Vec3 g = gradient(i, j);
      for (std::size_t axis = 0; axis < 3; ++axis)
        move[axis] += volume * (out.lambda_m2[i] + out.lambda_m2[j]) * g[axis];
    }
    const double longest = d.particles->spacing_m / 4;
    const double scale = std::min(1.0, longest / std::max(length(move), 1e-12));
    for (double& c : move) c *= scale;
    out.move_m.push_back(move);
  }
  return out;
}

std::vector<double> referenceWaveStep(const core::Scene& scene, const sim::Derived& d, const std::vector<double>& eta,
                                      const std::vector<double>& eta_previous) {
  const int nx = static_cast<int>(d.wave->count_x);
  const int nz = static_cast<int>(d.wave->count_z);
  const auto at = [&](int x, int z) { return eta[cellAt(*d.wave, x, z)]; };
  const double s2 = std::pow(d.wave->speed_mps * d.wave->dt_s / d.wave->cell_m, 2);
  const double damping = 0.5 * scene.wave->damping_per_s * d.wave->dt_s;
  std::vector<double> next;
  for (int z = 0; z < nz; ++z) {
    for (int x = 0; x < nx; ++x) {
      const double centre = at(x, z);
      const double sides = at(x - 1, z) + at(x + 1, z) + at(x, z - 1) + at(x, z + 1);
      const double corners = at(x - 1, z - 1) + at(x + 1, z - 1) + at(x - 1, z + 1) + at(x + 1, z + 1);
      const double laplacian = scene.wave->stencil == core::Stencil::kNinePoint
                                   ? (4 * sides + corners - 20 * centre) / 6
                                   : sides - 4 * centre;
      next.push_back(
          (2 * centre - (1 - damping) * eta_previous[static_cast<std::size_t>(x + nx * z)] + s2 * laplacian) /
          (1 + damping));
    }
  }
  return next;
}

}  // namespace spindrift::study
