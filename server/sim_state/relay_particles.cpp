#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include <spindrift/core/random.h>
#include <spindrift/sim_state/relay_particles.h>

namespace spindrift::sim {
namespace {

/// W(q) over W(0) of a kernel set; a weighted mean needs no norm.
double weightOf(core::KernelSet set, double q) {
  const double u = 1 - q;
  if (set == core::KernelSet::kMuller) {
    const double v = 1 - q * q;
    return v * v * v;
  }
  if (set == core::KernelSet::kCubicSpline) return q <= 0.5 ? 1 - 6 * q * q * u : 2 * u * u * u;
  return u * u * u * u * (4 * q + 1);
}

/// The old particles in the order of their cells, y fastest as in shaders/grid/grid_hash.glsl, so that the neighbours
/// in a column of cells are contiguous.
class OldParticles {
 public:
  OldParticles(const core::Scene& scene, const ParticleLayout& layout, const StateCopy& state)
      : scene_(scene), layout_(layout), start_(std::size_t{layout.cell_count} + 1, 0) {
    const std::size_t n = state.position.size() / 4;
    const std::uint32_t nowhere = layout.cell_count;
    std::vector<std::uint32_t> cell_of(n, nowhere);
    for (std::size_t i = 0; i < n; ++i) {
      bool finite = true;
      for (std::size_t k = 4 * i; k < 4 * i + 4; ++k)
        finite = finite && std::isfinite(state.position[k]) && std::isfinite(state.velocity[k]);
      if (!finite) continue;
      cell_of[i] = static_cast<std::uint32_t>(flat(cellAt(state.position.data() + 4 * i)));
      ++start_[cell_of[i] + 1];
    }
    for (std::size_t c = 0; c < layout.cell_count; ++c) start_[c + 1] += start_[c];
    member_.resize(start_.back());
    std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
    for (std::size_t i = 0; i < n; ++i) {
      if (cell_of[i] == nowhere) continue;
      Member& m = member_[next[cell_of[i]]++];
      std::copy_n(state.position.data() + 4 * i, 3, m.position.data());
      std::copy_n(state.velocity.data() + 4 * i, 4, m.velocity.data());
    }
  }

  /// Old water around a position: the sum of W, and the Shepard mean of velocity and foam.
  struct Around {
    double weight = 0.0;
    std::array<double, 4> mean{};
  };
  Around around(const float* x) const {
    const auto H = static_cast<float>(layout_.support_radius_m);
    const std::array<int, 3> centre = cellAt(x);
    const int low_y = std::max(centre[1] - 1, 0);
    const int high_y = std::min(centre[1] + 1, static_cast<int>(layout_.cells[1]) - 1);
    Around out;
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dx = -1; dx <= 1; ++dx) {
        std::array<int, 3> cell = {centre[0] + dx, low_y, centre[2] + dz};
        std::array<float, 3> at = {x[0], x[1], x[2]};
        if (!wrap(cell, at)) continue;
        const std::size_t first = start_[flat(cell)];
        const std::size_t last = start_[flat({cell[0], high_y, cell[2]}) + 1];
        // As in the device's search: a pile of particles must not cost the square of its number.
        const std::size_t stop = std::min(last, first + kMaxCandidates);
        for (std::size_t k = first; k < stop; ++k) {
          const Member& m = member_[k];
          const float rx = at[0] - m.position[0];
          const float ry = at[1] - m.position[1];
          const float rz = at[2] - m.position[2];
          const float r2 = rx * rx + ry * ry + rz * rz;
          if (r2 >= H * H) continue;
          const double w = weightOf(scene_.particles->kernel_set, std::sqrt(r2) / layout_.support_radius_m);
          out.weight += w;
          for (std::size_t axis = 0; axis < 4; ++axis) out.mean[axis] += w * m.velocity[axis];
        }
      }
    }
    if (out.weight > 0) {
      for (double& value : out.mean) value /= out.weight;
    }
    return out;
  }

 private:
  static constexpr std::size_t kMaxCandidates = 4096;
  struct Member {
    std::array<float, 3> position;
    std::array<float, 4> velocity;
  };

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
  /// Wraps a neighbouring column, and the position with it, around periodic sides; false outside the domain.
  bool wrap(std::array<int, 3>& cell, std::array<float, 3>& at_m) const {
    for (const std::size_t axis : {0u, 2u}) {
      const int cells = static_cast<int>(layout_.cells[axis]);
      if (cell[axis] >= 0 && cell[axis] < cells) continue;
      const core::Boundary side = axis == 0 ? scene_.particles->boundary_x : scene_.particles->boundary_z;
      if (side != core::Boundary::kPeriodic) return false;
      const auto side_m = static_cast<float>(layout_.max_m[axis] - layout_.min_m[axis]);
      at_m[axis] += cell[axis] < 0 ? side_m : -side_m;
      cell[axis] += cell[axis] < 0 ? cells : -cells;
    }
    return true;
  }

  const core::Scene& scene_;
  const ParticleLayout& layout_;
  std::vector<std::uint32_t> start_;
  std::vector<Member> member_;
};

/// Elevation of the nearest wave cell.
double elevationAt(const WaveLayout& wave, const std::vector<double>& eta, double x_m, double z_m) {
  const auto nearest = [&](double at_m, double side_m, std::uint32_t count) {
    const double cell = std::floor((at_m + side_m / 2) / wave.cell_m);
    return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(count - 1)));
  };
  return eta[nearest(x_m, wave.length_m, wave.count_x) + wave.count_x * nearest(z_m, wave.width_m, wave.count_z)];
}

}  // namespace

std::vector<float> startingPositions(const core::Scene& scene, const ParticleLayout& layout) {
  core::SplitMix64 random(scene.seed);
  const double jitter_m = scene.particles->jitter_ratio * layout.spacing_m;
  std::vector<float> out;
  out.reserve(std::size_t{layout.count} * 4);
  std::uint32_t id = 0;
  for (std::uint32_t y = 0; y < layout.layers_count; ++y) {
    for (std::uint32_t z = 0; z < layout.columns_z_count; ++z) {
      for (std::uint32_t x = 0; x < layout.columns_x_count; ++x) {
        out.push_back(
            static_cast<float>(layout.min_m[0] + (x + 0.5) * layout.pitch_x_m + jitter_m * random.symmetric()));
        out.push_back(static_cast<float>(-layout.band_m + layout.layer_heights_m[y] + jitter_m * random.symmetric()));
        out.push_back(
            static_cast<float>(layout.min_m[2] + (z + 0.5) * layout.pitch_z_m + jitter_m * random.symmetric()));
        out.push_back(static_cast<float>(id++));
      }
    }
  }
  return out;
}

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
    for (const double value : old.around(x).mean) out.velocity.push_back(static_cast<float>(value));
  }
  return out;
}

RelaidParticles refillParticles(const core::Scene& scene, const Derived& before, const StateCopy& state,
                                const ParticleLayout& after) {
  struct Candidate {
    std::array<float, 3> place_m;
    OldParticles::Around water;
  };
  const OldParticles old(scene, *before.particles, state);
  std::vector<Candidate> candidates;
  const auto point = [](double min_m, double pitch_m, std::uint32_t k) { return min_m + (k + 0.5) * pitch_m; };
  const auto countOf = [](double length_m, double pitch_m) {
    return static_cast<std::uint32_t>(std::max(1.0, std::floor(length_m / pitch_m + 1e-6)));
  };
  const std::uint32_t x_count = countOf(after.max_m[0] - after.min_m[0], after.pitch_x_m);
  const std::uint32_t z_count = countOf(after.max_m[2] - after.min_m[2], after.pitch_z_m);
  // The resting layers, and above them layers one spacing apart.
  std::vector<double> heights_m;
  for (const double height_m : after.layer_heights_m) heights_m.push_back(-after.band_m + height_m);
  while (heights_m.back() + 1.5 * after.spacing_m < after.max_m[1])
    heights_m.push_back(heights_m.back() + after.spacing_m);
  for (const double y_m : heights_m) {
    for (std::uint32_t z = 0; z < z_count; ++z) {
      for (std::uint32_t x = 0; x < x_count; ++x) {
        Candidate one{{static_cast<float>(point(after.min_m[0], after.pitch_x_m, x)), static_cast<float>(y_m),
                       static_cast<float>(point(after.min_m[2], after.pitch_z_m, z))},
                      {}};
        one.water = old.around(one.place_m.data());
        candidates.push_back(one);
      }
    }
  }
  // Stable: equal water is taken from below, so that a run repeats.
  std::ranges::stable_sort(candidates, std::ranges::greater(), [](const Candidate& c) { return c.water.weight; });
  RelaidParticles out;
  core::SplitMix64 random(scene.seed);
  const double jitter_m = scene.particles->jitter_ratio * after.spacing_m;
  for (std::uint32_t k = 0; k < after.count; ++k) {
    // The box has more lattice points than particles; a box that is full to the brim might not.
    const Candidate& from = candidates[k % candidates.size()];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double place_m = from.place_m[axis] + jitter_m * random.symmetric();
      out.position.push_back(static_cast<float>(std::clamp(place_m, after.min_m[axis], after.max_m[axis])));
    }
    out.position.push_back(static_cast<float>(k));
    for (const double value : from.water.mean) out.velocity.push_back(static_cast<float>(value));
  }
  return out;
}

}  // namespace spindrift::sim
