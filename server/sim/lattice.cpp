#include "lattice.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spindrift::sim {
namespace {

using std::numbers::pi;

double poly6(double r2, double H) {
  const double u = H * H - r2;
  return u > 0 ? poly6Norm(H) * u * u * u : 0.0;
}

double cubic(double r, double H) {
  const double q = r / H;
  if (q >= 1) return 0.0;
  return cubicNorm(H) * (q <= 0.5 ? 6 * q * q * (q - 1) + 1 : 2 * std::pow(1 - q, 3));
}

/// Sum of f(r^2) over the layers low..high (in spacings above the particle's own) of an infinite lattice.
template <typename F>
double sumLayers(double s, double H, int low, int high, F f) {
  const int reach = static_cast<int>(std::ceil(H / s));
  double sum = 0.0;
  for (int y = low; y <= high; ++y) {
    for (int z = -reach; z <= reach; ++z) {
      for (int x = -reach; x <= reach; ++x) sum += f(s * s * (x * x + y * y + z * z));
    }
  }
  return sum;
}

int layersWithin(double s, double H) {
  return static_cast<int>(std::ceil(H / s));
}

}  // namespace

double poly6Norm(double H) {
  return 315.0 / (64.0 * pi * std::pow(H, 9));
}
double spikyNorm(double H) {
  return 45.0 / (pi * std::pow(H, 6));
}
double cubicNorm(double H) {
  return 8.0 / (pi * std::pow(H, 3));
}

double latticeNeighbours(double s, double H) {
  const int reach = layersWithin(s, H);
  return sumLayers(s, H, -reach, reach, [&](double r2) { return r2 <= H * H * (1 + 1e-9) ? 1.0 : 0.0; }) - 1.0;
}

double calibratedMass(double s, double H, double rho_0) {
  const int reach = layersWithin(s, H);
  return rho_0 / sumLayers(s, H, -reach, reach, [&](double r2) { return poly6(r2, H); });
}

double calibratedVirtualMass(double s, double H, double rho_0, double mass_kg, int points) {
  const int reach = layersWithin(s, H);
  const double missing = rho_0 - mass_kg * sumLayers(s, H, 0, reach, [&](double r2) { return poly6(r2, H); });
  double lattice = 0.0;
  for (int z = -(points / 2); z <= points / 2; ++z) {
    for (int x = -(points / 2); x <= points / 2; ++x) lattice += cubic(s * std::sqrt(x * x + z * z + 0.25), H);
  }
  return missing / lattice;
}

std::vector<double> restingLayers(const RestingWater& water, int layers_count) {
  const double s = water.spacing_m;
  const double H = water.support_radius_m;
  const auto n = static_cast<std::size_t>(layers_count);
  const int reach = layersWithin(s, H);
  constexpr int kMaxIterations = 20'000;
  constexpr double kVelocityKeep = 0.98;  // damps the fall within a few dozen steps
  constexpr double kToleranceOfGravity = 1e-3;
  const double dt_s = 0.1 * H / std::sqrt(std::max(water.stiffness_m2ps2, water.gravity_mps2 * H));

  // Squared horizontal distances within H of the lattice and of the floor's virtual particles.
  std::vector<double> lateral, floor_lateral;
  for (int z = -reach; z <= reach; ++z) {
    for (int x = -reach; x <= reach; ++x) {
      if (s * s * (x * x + z * z) < H * H) lateral.push_back(s * s * (x * x + z * z));
    }
  }
  for (int z = -(water.floor_points / 2); z <= water.floor_points / 2; ++z) {
    for (int x = -(water.floor_points / 2); x <= water.floor_points / 2; ++x)
      floor_lateral.push_back(s * s * (x * x + z * z));
  }

  std::vector<double> y(n), v(n, 0.0), rho(n), pressure_term(n);
  for (std::size_t k = 0; k < n; ++k) y[k] = (static_cast<double>(k) + 0.5) * s;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const auto forNeighbours = [&](std::size_t k, auto&& visit) {
      for (std::size_t j = 0; j < n; ++j) {
        if (std::abs(y[j] - y[k]) < H) visit(j);
      }
    };
    for (std::size_t k = 0; k < n; ++k) {
      rho[k] = 0.0;
      forNeighbours(k, [&](std::size_t j) {
        for (const double d2 : lateral) rho[k] += water.mass_kg * poly6(d2 + (y[j] - y[k]) * (y[j] - y[k]), H);
      });
      for (const double d2 : floor_lateral) rho[k] += water.virtual_mass_kg * cubic(std::sqrt(d2 + y[k] * y[k]), H);
      pressure_term[k] = std::max(water.stiffness_m2ps2 * (rho[k] - water.rest_density_kgpm3), 0.0) / (rho[k] * rho[k]);
    }
    double worst = 0.0;
    for (std::size_t k = 0; k < n; ++k) {
      double a = -water.gravity_mps2;
      forNeighbours(k, [&](std::size_t j) {
        const double dy = y[k] - y[j];
        if (j == k) return;
        for (const double d2 : lateral) {
          const double r = std::sqrt(d2 + dy * dy);
          if (r < H)
            a += water.mass_kg * (pressure_term[k] + pressure_term[j]) * spikyNorm(H) * (H - r) * (H - r) * dy / r;
        }
      });
      const double mirrored = pressure_term[k] * (1.0 + std::pow(rho[k] / water.rest_density_kgpm3, 2));
      for (const double d2 : floor_lateral) {
        const double r = std::sqrt(d2 + y[k] * y[k]);
        if (r >= H || r <= 0) continue;
        const double q = r / H;
        const double slope = q <= 0.5 ? 6 * q * (2 - 3 * q) : 6 * (1 - q) * (1 - q);
        a += water.virtual_mass_kg * cubicNorm(H) * mirrored * slope / (H * r) * y[k];
      }
      worst = std::max(worst, std::abs(a));
      v[k] = kVelocityKeep * v[k] + dt_s * a;
    }
    for (std::size_t k = 0; k < n; ++k) {
      y[k] = std::max(y[k] + dt_s * v[k], 0.1 * s);
    }
    if (worst <= kToleranceOfGravity * water.gravity_mps2) break;
  }
  return y;
}

}  // namespace spindrift::sim
