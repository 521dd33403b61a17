#include "wave_reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace spindrift::sim {
namespace {

/// A face between two cells and its conductance: still depth times the stencil's weight, 0 if it is closed. [m]
struct Face {
  std::size_t from, to;
  double conductance_m;
};

class Faces {
 public:
  Faces(const core::Scene& scene, const Derived& derived, const ReferenceBed& bed)
      : wave_(*scene.wave),
        depth_m_(bed.depth_m),
        nx_(static_cast<int>(derived.wave->count_x)),
        nz_(static_cast<int>(derived.wave->count_z)) {}

  [[nodiscard]] std::size_t count() const { return wave_.stencil == core::Stencil::kNinePoint ? 4 : 2; }

  /// Face k of the cell (x, z).
  [[nodiscard]] Face at(int x, int z, std::size_t k) const {
    const bool nine = count() == 4;
    switch (k) {
      case 0:
        return between(x, z, x + 1, z, nine ? 2.0 / 3.0 + folded(x, z) + folded(x, z - 1) : 1.0);
      case 1:
        return between(x, z, x, z + 1, nine ? 2.0 / 3.0 + folded(x, z) + folded(x - 1, z) : 1.0);
      case 2:
        return between(x, z, x + 1, z + 1, 1.0 / 6.0 - folded(x, z));
      default:
        return between(x + 1, z, x, z + 1, 1.0 / 6.0 - folded(x, z));
    }
  }

 private:
  [[nodiscard]] std::size_t index(int x, int z) const {
    return static_cast<std::size_t>((x + nx_) % nx_ + nx_ * ((z + nz_) % nz_));
  }
  [[nodiscard]] bool isWet(int x, int z) const {
    const bool periodic_x = wave_.boundary_minus_x == core::WaveBoundary::kPeriodic;
    const bool periodic_z = wave_.boundary_minus_z == core::WaveBoundary::kPeriodic;
    if ((!periodic_x && (x < 0 || x >= nx_)) || (!periodic_z && (z < 0 || z >= nz_))) return false;
    return depth_m_[index(x, z)] > 0;
  }
  /// Weight of the diagonals of a square with a dry corner; it goes to the faces beside the square.
  [[nodiscard]] double folded(int x, int z) const {
    return isWet(x, z) && isWet(x + 1, z) && isWet(x, z + 1) && isWet(x + 1, z + 1) ? 0.0 : 1.0 / 6.0;
  }
  [[nodiscard]] Face between(int x, int z, int to_x, int to_z, double weight) const {
    const double a_m = isWet(x, z) ? depth_m_[index(x, z)] : 0.0;
    const double b_m = isWet(to_x, to_z) ? depth_m_[index(to_x, to_z)] : 0.0;
    return {index(x, z), index(to_x, to_z), a_m > 0 && b_m > 0 ? weight * 2 / (1 / a_m + 1 / b_m) : 0.0};
  }

  const core::WaveScene& wave_;
  const std::vector<double>& depth_m_;
  int nx_, nz_;
};

}  // namespace

ReferenceBed::ReferenceBed(const core::Scene& scene, const Basin& basin) {
  for (std::size_t i = 0; i < basin.depth_m.size(); ++i) {
    const bool is_matched = hasMatchedLayer(scene);
    depth_m.push_back(basin.depth_m[i]);
    flow_loss_per_s.push_back(basin.bed[i][0]);
    elevation_loss_per_s.push_back(is_matched ? 0.0 : basin.bed[i][1]);
    if (!is_matched) continue;
    layer_x_per_s.push_back(basin.bed[i][1]);
    layer_z_per_s.push_back(basin.bed[i][3]);
  }
}

void referenceFlowStep(const core::Scene& scene, const Derived& derived, const ReferenceBed& bed, ReferenceWater& water,
                       const DispersionReference* dispersion) {
  const Faces faces(scene, derived, bed);
  const int nx = static_cast<int>(derived.wave->count_x);
  const int nz = static_cast<int>(derived.wave->count_z);
  const double dt_s = derived.wave->dt_s;
  const double dt_per_dx = dt_s / derived.wave->cell_m;
  const auto forEachFace = [&](auto&& visit) {
    for (int z = 0; z < nz; ++z) {
      for (int x = 0; x < nx; ++x) {
        for (std::size_t k = 0; k < faces.count(); ++k) {
          const Face face = faces.at(x, z, k);
          visit(face, water.flow_m2ps[static_cast<std::size_t>(x + nx * z) * faces.count() + k], x, z, k);
        }
      }
    }
  };
  const bool is_matched = !bed.layer_x_per_s.empty();
  if (is_matched) water.elevation_x_m.resize(water.elevation_m.size());
  std::vector<std::array<double, 2>> dispersed;
  if (dispersion) dispersed = dispersion->apply(water.elevation_m);
  std::vector<double> leaving_m(water.elevation_m.size(), 0.0);
  forEachFace([&](const Face& face, double& flow_m2ps, int x, int z, std::size_t k) {
    // Diagonals have the loss rate of the cell that owns them.
    const double own_per_s = bed.flow_loss_per_s[static_cast<std::size_t>(x + nx * z)];
    double loss_per_s = k < 2 ? 0.5 * (own_per_s + bed.flow_loss_per_s[face.to]) : own_per_s;
    if (is_matched) {
      const std::vector<double>& layer = k == 0 ? bed.layer_x_per_s : bed.layer_z_per_s;
      loss_per_s += 0.5 * (layer[face.from] + layer[face.to]);
    }
    const double a = 0.5 * dt_s * (scene.wave->damping_per_s + loss_per_s);
    const double slope = water.elevation_m[face.to] - water.elevation_m[face.from];
    const double pull_m2 = dispersion ? dispersed[face.from][k] : face.conductance_m * slope;
    flow_m2ps = ((1 - a) * flow_m2ps - scene.gravity_mps2 * dt_per_dx * pull_m2) / (1 + a);
    leaving_m[flow_m2ps > 0 ? face.from : face.to] += std::abs(flow_m2ps) * dt_per_dx;
  });
  std::vector<double> share(water.elevation_m.size(), 1.0);
  water.limited_count = 0;
  for (std::size_t i = 0; i < share.size(); ++i) {
    const double held_m = std::max(water.elevation_m[i] + bed.depth_m[i], 0.0);
    if (leaving_m[i] <= held_m) continue;
    share[i] = held_m / leaving_m[i];
    ++water.limited_count;
  }
  std::vector<double> gain_m(water.elevation_m.size(), 0.0);
  std::vector<double> gain_x_m(water.elevation_m.size(), 0.0);
  forEachFace([&](const Face& face, double& flow_m2ps, int, int, std::size_t k) {
    flow_m2ps *= share[flow_m2ps > 0 ? face.from : face.to];
    gain_m[face.from] -= flow_m2ps * dt_per_dx;
    gain_m[face.to] += flow_m2ps * dt_per_dx;
    if (k != 0) return;
    gain_x_m[face.from] -= flow_m2ps * dt_per_dx;
    gain_x_m[face.to] += flow_m2ps * dt_per_dx;
  });
  const auto lossOf = [&](double level_m, double gained_m, double rate_per_s) {
    const double b = 0.5 * dt_s * rate_per_s;
    return (2 * level_m + gained_m) * b / (1 + b);
  };
  for (std::size_t i = 0; i < gain_m.size(); ++i) {
    const double held_m = std::max(water.elevation_m[i] + gain_m[i] + bed.depth_m[i], 0.0);
    double wanted_m = lossOf(water.elevation_m[i], gain_m[i], bed.elevation_loss_per_s[i]);
    if (is_matched && bed.layer_x_per_s[i] + bed.layer_z_per_s[i] > 0) {
      const double x_m = water.elevation_x_m[i];
      const double wanted_x_m = lossOf(x_m, gain_x_m[i], bed.layer_x_per_s[i]);
      wanted_m = wanted_x_m + lossOf(water.elevation_m[i] - x_m, gain_m[i] - gain_x_m[i], bed.layer_z_per_s[i]);
      water.elevation_x_m[i] += gain_x_m[i] - (wanted_x_m - 0.5 * std::max(wanted_m - held_m, 0.0));
    }
    const double lost_m = std::min(wanted_m, held_m);
    water.elevation_m[i] += gain_m[i] - lost_m;
    water.lost_m += lost_m;
  }
}

}  // namespace spindrift::sim
