#include "relay_particles.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lattice.h"
#include "starting_state.h"

namespace spindrift::sim {
namespace {

/// The old particles by cell, for sums around any place.
class OldParticles {
 public:
  OldParticles(const core::Scene& scene, const ParticleLayout& layout, const StateCopy& state)
      : scene_(scene), layout_(layout), state_(state), start_(layout.cell_count + 1, 0) {
    const std::size_t n = state.position.size() / 4;
    std::vector<std::size_t> cell_of(n, layout.cell_count);
    for (std::size_t i = 0; i < n; ++i) {
      bool finite = true;
      for (std::size_t k = 4 * i; k < 4 * i + 4; ++k)
        finite = finite && std::isfinite(state.position[k]) && std::isfinite(state.velocity[k]);
      if (!finite) continue;
      cell_of[i] = flat(cellAt(state.position.data() + 4 * i));
      ++start_[cell_of[i] + 1];
    }
    for (std::size_t c = 0; c < layout.cell_count; ++c) start_[c + 1] += start_[c];
    member_.resize(start_.back());
    std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
    for (std::size_t i = 0; i < n; ++i) {
      if (cell_of[i] < layout.cell_count) member_[next[cell_of[i]]++] = i;
    }
  }

  /// Shepard mean of velocity and foam at x.
  std::array<double, 4> meanAt(const float* x) const {
    const double H = layout_.support_radius_m;
    const std::array<int, 3> centre = cellAt(x);
    std::array<double, 4> sum{};
    double weight = 0.0;
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dx = -1; dx <= 1; ++dx) {
        for (int dy = -1; dy <= 1; ++dy) {
          std::array<int, 3> cell = {centre[0] + dx, centre[1] + dy, centre[2] + dz};
          std::array<double, 3> shift{};
          if (!wrap(cell, shift)) continue;
          const std::size_t c = flat(cell);
          for (std::size_t k = start_[c]; k < start_[c + 1]; ++k) {
            const float* other = state_.position.data() + 4 * member_[k];
            double r2 = 0.0;
            for (std::size_t axis = 0; axis < 3; ++axis) {
              const double r = static_cast<double>(x[axis]) + shift[axis] - other[axis];
              r2 += r * r;
            }
            const double w = densityKernel(scene_.particles->kernel_set, std::sqrt(r2), H);
            weight += w;
            for (std::size_t axis = 0; axis < 4; ++axis) sum[axis] += w * state_.velocity[4 * member_[k] + axis];
          }
        }
      }
    }
    if (weight > 0) {
      for (double& value : sum) value /= weight;
    }
    return sum;
  }

 private:
  std::array<int, 3> cellAt(const float* x) const {
    std::array<int, 3> cell{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double u = std::floor((x[axis] - layout_.min_m[axis]) / layout_.support_radius_m);
      cell[axis] = static_cast<int>(std::clamp(u, 0.0, static_cast<double>(layout_.cells[axis] - 1)));
    }
    return cell;
  }
  std::size_t flat(const std::array<int, 3>& cell) const {
    return static_cast<std::size_t>(cell[1]) +
           layout_.cells[1] *
               (static_cast<std::size_t>(cell[0]) + layout_.cells[0] * static_cast<std::size_t>(cell[2]));
  }
  /// Brings a neighbouring cell round a periodic side; false outside of the domain.
  bool wrap(std::array<int, 3>& cell, std::array<double, 3>& shift_m) const {
    for (const std::size_t axis : {0u, 1u, 2u}) {
      const int cells = static_cast<int>(layout_.cells[axis]);
      if (cell[axis] >= 0 && cell[axis] < cells) continue;
      const core::Boundary side = axis == 0 ? scene_.particles->boundary_x : scene_.particles->boundary_z;
      if (axis == 1 || side != core::Boundary::kPeriodic) return false;
      const double side_m = layout_.max_m[axis] - layout_.min_m[axis];
      shift_m[axis] = cell[axis] < 0 ? side_m : -side_m;
      cell[axis] += cell[axis] < 0 ? cells : -cells;
    }
    return true;
  }

  const core::Scene& scene_;
  const ParticleLayout& layout_;
  const StateCopy& state_;
  std::vector<std::size_t> start_;
  std::vector<std::size_t> member_;
};

/// Elevation of the nearest wave cell.
double elevationAt(const WaveLayout& wave, const std::vector<double>& eta, double x_m, double z_m) {
  const auto nearest = [&](double at_m) {
    const double cell = std::floor((at_m + wave.side_m / 2) / wave.cell_m);
    return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(wave.resolution_count - 1)));
  };
  return eta[nearest(x_m) + wave.resolution_count * nearest(z_m)];
}

}  // namespace

RelaidParticles relayParticles(const core::Scene& scene, const Derived& before, const StateCopy& state,
                               const ParticleLayout& after) {
  RelaidParticles out;
  out.position = startingPositions(scene, after);
  out.velocity.reserve(out.position.size());
  const OldParticles old(scene, *before.particles, state);
  for (std::size_t i = 0; i < out.position.size(); i += 4) {
    float* x = out.position.data() + i;
    if (scene.coupling) {
      const double eta_m = elevationAt(*before.wave, state.elevation_m, x[0], x[2]);
      x[1] =
          static_cast<float>(std::clamp(x[1] + (std::isfinite(eta_m) ? eta_m : 0.0), after.min_m[1], after.max_m[1]));
    }
    for (const double value : old.meanAt(x)) out.velocity.push_back(static_cast<float>(value));
  }
  return out;
}

}  // namespace spindrift::sim
