// Prints server/sim_setup/dispersion_poles.inc: the coefficients of the dispersion's poles by depth in cells, fitted to
// the phase speeds of the V-cycle itself, not of exact solutions. For each depth:
//   - the share F/d that the V-cycle gives a plane wave is measured for single poles with b on a grid of values, for
//   waves of
//     4 to 128 cells along an axis, a diagonal and between;
//   - c follows from weighted least squares, repeated with weights that make the largest error smallest;
//   - b is sought by the method of Nelder and Mead, from the solution for the depth before; there the error of the
//   group speed
//     counts too, because ripples of the phase speed are larger in its derivative, and wakes depend on that.
// Neighbouring depths have similar coefficients (kStay), so that a wave over a slope meets no jump.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <numeric>
#include <vector>

#include "dispersion_reference.h"

namespace {

using namespace spindrift;
using sim::kPoleCount;
using Two = std::array<double, kPoleCount>;

/// Cells per side. Deep water needs more, and then not all waves are measured.
constexpr int kSide = 128;
constexpr int kDeepSide = 256;
constexpr double kDeep_cells = 17.0;
/// A group speed so many times as far off as a phase speed counts as much.
constexpr double kGroupTolerance = 12.0;
constexpr double kCell_m = 0.125;
constexpr double kStayB = 0.001;
constexpr double kStayC = 0.005;
constexpr double kStepB = 0.8;

struct Wave {
  int mx = 0;
  int mz = 0;
  double cells = 0.0;
  double kd = 0.0;
  double weight = 0.0;
  double laplacian = 0.0;       ///< of the grid, times the squared cell
  double wanted = 0.0;          ///< F/d of the closed form, for the Laplacian of the grid
  std::vector<double> share{};  ///< F/d of the V-cycle for each value of b
};

/// Cubic interpolation in log b.
double mix(const std::vector<double>& share, double log_b, double first_log_b) {
  const double last = static_cast<double>(share.size()) - 2.001;
  const double u = std::clamp((first_log_b - log_b) / -std::log(kStepB), 1.0, last);
  const auto k = static_cast<std::size_t>(u);
  const double t = u - static_cast<double>(k);
  return -share[k - 1] * t * (t - 1) * (t - 2) / 6 + share[k] * (t + 1) * (t - 1) * (t - 2) / 2 -
         share[k + 1] * (t + 1) * t * (t - 2) / 2 + share[k + 2] * (t + 1) * t * (t - 1) / 6;
}

struct Fit {
  Two log_b, c;
  double cost;
};

class Fitting {
 public:
  Fitting(double depth_cells, const Fit* before)
      : before_(before), n_(depth_cells > kDeep_cells ? kDeepSide : kSide), at_once_(sim::shareAtOnce(depth_cells)) {
    core::Scene scene;
    scene.wave.emplace();
    scene.wave->resolution_count = static_cast<std::uint32_t>(n_);
    scene.wave->side_m = n_ * kCell_m;
    scene.wave->depth_m = depth_cells * kCell_m;
    scene.wave->dispersion = core::Dispersion::kAiry;
    const sim::WaveLayout layout = *sim::derive(scene)->wave;
    const sim::Basin basin = sim::layOutBasin(scene, layout);
    for (int m = 1; m <= n_ / 4; m = n_ == kSide ? m + 1 : std::max(m + 1, static_cast<int>(1.13 * m))) {
      for (const auto& [mx, mz] : {std::pair{m, 0}, std::pair{m, m}, std::pair{m, m / 2}}) add(mx, mz, depth_cells);
    }
    for (double b = 0.7; b > 4e-5; b *= kStepB * kStepB) {
      log_b_.push_back(std::log(b));
      log_b_.push_back(std::log(b * kStepB));
      const sim::DispersionReference cycle(sim::layOutDispersion(layout, basin, [b](double) {
        return sim::Poles{{b, b * kStepB}, {1.0, 1.0}};
      }));
      for (Wave& wave : waves_) measure(cycle, scene.wave->depth_m, wave);
    }
  }

  [[nodiscard]] Fit best(Two start) const {
    constexpr int kRounds = 200;
    std::vector<Fit> simplex{tried(start)};
    for (std::size_t j = 0; j < kPoleCount; ++j) {
      Two moved = start;
      moved[j] -= 0.4;
      simplex.push_back(tried(moved));
    }
    for (int round = 0; round < kRounds; ++round) {
      std::ranges::sort(simplex, {}, &Fit::cost);
      Fit& worst = simplex.back();
      Two centre{};
      for (std::size_t k = 0; k + 1 < simplex.size(); ++k) {
        for (std::size_t j = 0; j < kPoleCount; ++j) centre[j] += simplex[k].log_b[j] / kPoleCount;
      }
      const auto at = [&](double t) {
        Two out;
        for (std::size_t j = 0; j < kPoleCount; ++j) out[j] = centre[j] + t * (worst.log_b[j] - centre[j]);
        return tried(out);
      };
      Fit next = at(-1);
      if (next.cost < simplex.front().cost) {
        if (const Fit further = at(-2); further.cost < next.cost) next = further;
      } else if (next.cost >= simplex[simplex.size() - 2].cost) {
        next = at(0.5);
      }
      if (next.cost < worst.cost) {
        worst = next;
        continue;
      }
      for (std::size_t k = 1; k < simplex.size(); ++k) {
        Two closer;
        for (std::size_t j = 0; j < kPoleCount; ++j)
          closer[j] = std::midpoint(simplex[k].log_b[j], simplex.front().log_b[j]);
        simplex[k] = tried(closer);
      }
    }
    return *std::ranges::min_element(simplex, {}, &Fit::cost);
  }

  /// Largest error of the phase speed: waves of 8 cells and longer, of 4 to 8 cells; the same for kd above 10. [%]
  /// Last, that of the group speed of waves of 8 cells and longer along an axis, kd up to 10.
  [[nodiscard]] std::array<double, 5> errors(const Fit& fit) const {
    std::array<double, 5> out{};
    for (const Wave& wave : waves_) {
      double& largest = out[(wave.cells >= 8 ? 0 : 1) + (wave.kd <= 10 ? 0 : 2)];
      largest = std::max(largest, 100 * std::abs(std::sqrt(shareOf(wave, fit) / wave.wanted) - 1));
    }
    out[4] = 100 * groupError(fit);
    return out;
  }

 private:
  void add(int mx, int mz, double depth_cells) {
    Wave wave{.mx = mx, .mz = mz};
    wave.cells = n_ / std::hypot(mx, mz);
    if (wave.cells < 3.999) return;
    const double k = 2 * std::numbers::pi / wave.cells;
    const double laplacian =
        4 * (std::pow(std::sin(std::numbers::pi * mx / n_), 2) + std::pow(std::sin(std::numbers::pi * mz / n_), 2));
    wave.laplacian = laplacian;
    wave.kd = k * depth_cells;
    wave.weight = (wave.cells >= 7.99 ? 1.0 : 0.38) * (wave.kd <= 10.3 ? 1.0 : 0.12);
    wave.wanted = k * std::tanh(wave.kd) / (laplacian * depth_cells);
    waves_.push_back(wave);
  }

  void measure(const sim::DispersionReference& cycle, double depth_m, Wave& wave) const {
    const sim::DispersionLevel& grid = cycle.dispersion().levels.front();
    std::vector<double> level(grid.stiffness.size());
    for (int z = 0; z < n_; ++z) {
      for (int x = 0; x < n_; ++x) {
        level[grid.index(x, z)] = std::cos(2 * std::numbers::pi * (wave.mx * x + wave.mz * z) / n_ + 0.3);
      }
    }
    const auto poles = cycle.poles(level);
    Two sum{};
    double plain = 0.0;
    for (int z = 0; z < n_; ++z) {
      for (int x = 0; x < n_; ++x) {
        const std::size_t i = grid.index(x, z);
        const double slope[2] = {level[grid.index(x + 1, z)] - level[i], level[grid.index(x, z + 1)] - level[i]};
        for (std::size_t axis = 0; axis < 2; ++axis) {
          plain += slope[axis] * slope[axis];
          for (std::size_t j = 0; j < kPoleCount; ++j) sum[j] += slope[axis] * poles[i][2 * axis + j];
        }
      }
    }
    for (const double s : sum) wave.share.push_back(s / (plain * std::sqrt(depth_m)));
  }

  [[nodiscard]] double shareOf(const Wave& wave, const Fit& fit) const {
    double sum = at_once_;
    for (std::size_t j = 0; j < kPoleCount; ++j) sum += fit.c[j] * mix(wave.share, fit.log_b[j], log_b_.front());
    return std::max(sum, 1e-12);
  }

  /// Largest relative error of the group speed, from differences between neighbouring waves along an axis.
  [[nodiscard]] double groupError(const Fit& fit) const {
    const Wave* last = nullptr;
    double largest = 0.0;
    for (const Wave& wave : waves_) {
      if (wave.mz != 0 || wave.cells < 7.99 || wave.kd > 10.3) continue;
      if (last) {
        const auto rise = [&](auto share) {
          return std::sqrt(wave.laplacian * share(wave)) - std::sqrt(last->laplacian * share(*last));
        };
        const double measured = rise([&](const Wave& w) { return shareOf(w, fit); });
        largest = std::max(largest, std::abs(measured / rise([](const Wave& w) { return w.wanted; }) - 1));
      }
      last = &wave;
    }
    return largest;
  }

  /// The best c for these b, and what they cost.
  [[nodiscard]] Fit tried(const Two& log_b) const {
    Fit fit{.log_b = log_b, .c = {}, .cost = 1e9};
    double penalty = std::max(0.0, log_b[1] + 0.5 - log_b[0]);
    for (std::size_t j = 0; j < kPoleCount; ++j) {
      penalty += std::max(0.0, log_b[j] - log_b_.front()) + std::max(0.0, log_b_.back() - log_b[j]);
      if (before_) penalty += kStayB * std::pow(log_b[j] - before_->log_b[j], 2);
    }
    std::vector<Two> share(waves_.size());
    std::vector<double> weight(waves_.size());
    for (std::size_t i = 0; i < waves_.size(); ++i) {
      weight[i] = waves_[i].weight;
      for (std::size_t j = 0; j < kPoleCount; ++j)
        share[i][j] = mix(waves_[i].share, log_b[j], log_b_.front()) / waves_[i].wanted;
    }
    constexpr int kRounds = 25;
    for (int round = 0; round < kRounds; ++round) {
      double a[2][2] = {{0, 0}, {0, 0}};
      double r[2] = {0, 0};
      for (std::size_t i = 0; i < waves_.size(); ++i) {
        const double w = weight[i] * weight[i];
        for (std::size_t j = 0; j < 2; ++j) {
          r[j] += w * share[i][j] * (1 - at_once_ / waves_[i].wanted);
          for (std::size_t k = 0; k < 2; ++k) a[j][k] += w * share[i][j] * share[i][k];
        }
      }
      for (std::size_t j = 0; before_ && j < 2; ++j) {
        const double stay = kStayC * a[j][j];
        a[j][j] += stay;
        r[j] += stay * before_->c[j];
      }
      const double determinant = a[0][0] * a[1][1] - a[0][1] * a[1][0];
      const Two c{(r[0] * a[1][1] - r[1] * a[0][1]) / determinant, (r[1] * a[0][0] - r[0] * a[1][0]) / determinant};
      double largest = 0.0;
      std::vector<double> error(waves_.size());
      for (std::size_t i = 0; i < waves_.size(); ++i) {
        const double ratio = at_once_ / waves_[i].wanted + c[0] * share[i][0] + c[1] * share[i][1];
        error[i] = waves_[i].weight * std::abs(ratio > 0 ? std::sqrt(ratio) - 1 : 1);
        largest = std::max(largest, error[i]);
      }
      const Fit now{.log_b = log_b, .c = c, .cost = 0.0};
      const double cost =
          std::max(largest, groupError(now) / kGroupTolerance) + penalty + std::max(0.0, -c[0]) + std::max(0.0, -c[1]);
      if (cost < fit.cost) {
        fit.c = c;
        fit.cost = cost;
      }
      for (std::size_t i = 0; i < waves_.size(); ++i) weight[i] *= std::sqrt(error[i] / largest + 0.1);
    }
    return fit;
  }

  const Fit* before_;
  int n_;
  double at_once_;
  std::vector<Wave> waves_;
  std::vector<double> log_b_;
};

}  // namespace

int main() {
  std::vector<std::pair<double, Fit>> fits;
  for (double depth_cells = 64 / std::numbers::sqrt2; depth_cells > 0.7;
       depth_cells /= std::sqrt(std::numbers::sqrt2)) {
    const Fitting fitting(depth_cells, fits.empty() ? nullptr : &fits.back().second);
    const Fit fit = fitting.best(fits.empty() ? Two{std::log(0.25), std::log(0.003)} : fits.back().second.log_b);
    const auto [long_off, short_off, long_deep_off, short_deep_off, group_off] = fitting.errors(fit);
    std::fprintf(
        stderr,
        "%7.4f cells deep: %.2f %% at 8 cells and more, %.2f %% at 4; beyond kd 10 %.2f, %.2f %%; group %.2f %%\n",
        depth_cells, long_off, short_off, long_deep_off, short_deep_off, group_off);
    fits.emplace_back(depth_cells, fit);
  }
  for (auto row = fits.rbegin(); row != fits.rend(); ++row) {
    const auto& [depth_cells, fit] = *row;
    std::printf("    {%.5g, {{%.5g, %.5g}, {%.5g, %.5g}}},\n", depth_cells, std::exp(fit.log_b[0]),
                std::exp(fit.log_b[1]), fit.c[0], fit.c[1]);
  }
}
