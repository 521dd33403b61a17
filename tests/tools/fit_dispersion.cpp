// Prints server/sim_setup/dispersion_poles.inc: the coefficients of the dispersion's poles by depth in cells, fitted to
// the speeds of plane waves under the V-cycle itself (dispersion_symbol.h), not under exact solutions.
//
// For each depth the largest of these is made small: the errors of the phase speed, of the group speed along the wave
// and of the group speed across it (0 for Airy waves, whose speed does not depend on the direction), for waves of 4 to
// 256 cells, in five directions from the axis to the diagonal; and, for waves of 4, 8, 16 and 32 cells along an axis,
// the difference between their two standing waves and the errors of both. A wake has the height that the group speed of
// its waves leaves it, so ripples of the phase speed over length and direction would change heights by much more than
// themselves.
//
// Method: Levenberg-Marquardt on sums of powers 2 to 10 of the errors, from the deepest water to the shallowest, each
// from the coefficients of the depth before. A weak pull toward those, and toward one b on all grids, keeps
// coefficients regular where waves do not decide them, so that a wave over a slope meets no jump.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "dispersion_symbol.h"

namespace {

using namespace spindrift;
using sim::DispersionSymbol;
using sim::kFittedGridCount;
using sim::kPoleCount;
using sim::Poles;
using std::numbers::pi;
using Values = std::vector<double>;

/// As with 256 cells per side. Fewer grids make no difference: the coarsest one is solved.
constexpr std::size_t kGridCount = 7;
constexpr double kShortest_cells = 4.0;
constexpr double kLongest_cells = 256.0;
constexpr double kMostKd = 10.0;
constexpr double kDirections_deg[] = {0.0, 15.0, 26.565, 35.0, 45.0};
/// A group speed so many times as far off as a phase speed counts as much.
constexpr double kGroupTolerance = 3.0;
/// Weights of waves of less than 8 cells, and of kd above kMostKd, there falling as 1/kd.
constexpr double kShortWeight = 0.4;
constexpr double kDeepWeight = 0.35;
/// Weights of waves of 4, 8, 16 and 32 cells along an axis with their two frequencies; factors for kd above kMostKd,
/// and for 4 cells in water of 1 cell.
constexpr std::array<double, 4> kSplitWeights{0.4, 0.75, 0.6, 0.6};
constexpr double kDeepSplitWeight = 0.3;
constexpr double kShallowSplitWeight = 0.7;
constexpr double kPull = 0.01;
/// b_j to which the finest grid is pulled.
constexpr std::array<double, kPoleCount> kUsualB{0.31, 0.0085};
constexpr Poles kFirst{{{{0.25, 0.0044}, {0.25, 0.0044}, {0.25, 0.0044}, {0.25, 0.0044}}}, {0.86, 0.1}};

/// The unknowns of pole j, all logarithms: c; b of the finest grid; the factors of b on the grids after it.
constexpr std::size_t kPerPole = 1 + kFittedGridCount;

Poles polesOf(const Values& x) {
  Poles out;
  for (std::size_t j = 0; j < kPoleCount; ++j) {
    const double* const own = &x[kPerPole * j];
    out.c[j] = std::exp(own[0]);
    for (std::size_t k = 0; k < kFittedGridCount; ++k) out.b[k][j] = std::exp(own[1] + (k == 0 ? 0.0 : own[1 + k]));
  }
  return out;
}

Values unknownsOf(const Poles& poles) {
  Values x;
  for (std::size_t j = 0; j < kPoleCount; ++j) {
    x.push_back(std::log(poles.c[j]));
    x.push_back(std::log(poles.b[0][j]));
    for (std::size_t k = 1; k < kFittedGridCount; ++k) x.push_back(std::log(poles.b[k][j] / poles.b[0][j]));
  }
  return x;
}

/// Solves a x = r for a symmetric positive matrix, by its Cholesky factors. Returns whether it is positive.
bool solve(Values a, Values& x) {
  const std::size_t n = x.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = a[i * n + j];
      for (std::size_t k = 0; k < j; ++k) sum -= a[i * n + k] * a[j * n + k];
      if (i == j && sum <= 0.0) return false;
      a[i * n + j] = i == j ? std::sqrt(sum) : sum / a[j * n + j];
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) x[i] -= a[i * n + k] * x[k];
    x[i] /= a[i * n + i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) x[i] -= a[k * n + i] * x[k];
    x[i] /= a[i * n + i];
  }
  return true;
}

struct Errors {
  double long_waves = 0.0, short_waves = 0.0;            ///< phase speed, from 8 cells and of 4 to 8 cells
  double long_deep_waves = 0.0, short_deep_waves = 0.0;  ///< the same for kd above kMostKd
  double split = 0.0;                                    ///< of standing waves of 8 and 16 cells
  double group = 0.0;                                    ///< group speed along the wave, from 8 cells, kd to kMostKd
  double stability = 0.0;  ///< largest eigenvalue of -div F grad over the one that the stable step is made for
};

class Fitting {
 public:
  explicit Fitting(double depth_cells) : depth_cells_(depth_cells) {
    for (double cells = kShortest_cells; cells <= kLongest_cells; cells *= std::pow(2.0, 0.125)) {
      for (const double direction_deg : kDirections_deg) {
        const double k = 2 * pi / cells;
        const double kd = k * depth_cells;
        if (kd < 0.05) continue;
        const double deep = kd <= kMostKd + 0.05 ? 1.0 : kDeepWeight * kMostKd / kd;
        const double a = direction_deg * pi / 180;
        waves_.push_back({.k = k,
                          .kd = kd,
                          .is_long = cells >= 7.99,
                          .weight = (cells >= 7.99 ? 1.0 : kShortWeight) * deep,
                          .group_weight = (cells >= 8.3   ? 1.0
                                           : cells >= 6.0 ? kShortWeight
                                                          : 0.0) *
                                          deep * (kd < 0.3 ? 0.5 : 1.0) / kGroupTolerance,
                          .here = placeOf(k, a),
                          .beside = placeOf(k * (1 + kStep), a),
                          .turned = placeOf(k, a + 2 * kStep)});
      }
    }
  }

  [[nodiscard]] Poles best(const Poles& start, bool is_first) const {
    Values x = unknownsOf(start);
    Values home = x;
    for (std::size_t j = 0; j < kPoleCount; ++j) {
      for (std::size_t i = 1; i < kPerPole; ++i) {
        const double usual = i == 1 ? std::log(kUsualB[j]) : 0.0;
        home[kPerPole * j + i] = is_first ? usual : std::midpoint(x[kPerPole * j + i], usual);
      }
    }
    for (const double power : {2.0, 3.0, 4.0, 6.0, 8.0, 10.0}) {
      if (is_first || power >= 4.0) minimise(x, home, power);
    }
    return polesOf(x);
  }

  [[nodiscard]] Errors errors(const Poles& poles) const {
    const DispersionSymbol symbol(depth_cells_, poles, kGridCount);
    Errors out;
    for (const Wave& wave : waves_) {
      const bool is_deep = wave.kd > kMostKd + 0.05;
      const double phase = std::abs(frequency(symbol, wave.here) / wave.here.wanted - 1);
      double& largest = wave.is_long ? (is_deep ? out.long_deep_waves : out.long_waves)
                                     : (is_deep ? out.short_deep_waves : out.short_waves);
      largest = std::max(largest, phase);
      if (wave.is_long && !is_deep) out.group = std::max(out.group, std::abs(groupError(symbol, wave)));
    }
    out.split = std::max(symbol.split(2), symbol.split(3));
    constexpr int kSamples = 64;
    double highest = 0.0;
    for (int x = 0; x <= kSamples; ++x) {
      for (int z = 0; z <= x; ++z) {
        if (x == 0) continue;
        const double kx = pi * x / kSamples;
        const double kz = pi * z / kSamples;
        highest = std::max(highest, symbol.laplacian(kx, kz) * symbol.share(kx, kz));
      }
    }
    double shortest = sim::shareAtOnce(depth_cells_);
    for (std::size_t j = 0; j < kPoleCount; ++j)
      shortest += poles.c[j] / (1 + 8 * poles.b[0][j] * depth_cells_ * depth_cells_);
    out.stability = highest / (8 * shortest);
    return out;
  }

 private:
  static constexpr double kStep = 0.03;  ///< of wave number, for differences

  /// A wave number vector, and what belongs to it [depth = 1, g = 1 cell].
  struct Place {
    double kx, kz, laplacian, wanted;  ///< wanted: frequency of Airy waves
  };
  struct Wave {
    double k, kd;
    bool is_long;
    double weight, group_weight;
    Place here, beside, turned;
  };

  [[nodiscard]] Place placeOf(double k, double direction_rad) const {
    const double kx = k * std::cos(direction_rad);
    const double kz = k * std::sin(direction_rad);
    return {kx, kz, DispersionSymbol::laplacian(kx, kz), std::sqrt(k * std::tanh(k * depth_cells_))};
  }

  [[nodiscard]] double frequency(const DispersionSymbol& symbol, const Place& at) const {
    return std::sqrt(std::max(depth_cells_ * at.laplacian * symbol.share(at.kx, at.kz), 1e-12));
  }

  [[nodiscard]] double groupError(const DispersionSymbol& symbol, const Wave& wave) const {
    return (frequency(symbol, wave.beside) - frequency(symbol, wave.here)) / (wave.beside.wanted - wave.here.wanted) -
           1;
  }

  /// Weighted errors [%].
  [[nodiscard]] Values weightedErrors(const Values& x) const {
    const DispersionSymbol symbol(depth_cells_, polesOf(x), kGridCount);
    Values out;
    for (const Wave& wave : waves_) {
      const double here = frequency(symbol, wave.here);
      out.push_back(100 * wave.weight * (here / wave.here.wanted - 1));
      if (wave.group_weight <= 0.0) continue;
      const double group = (wave.beside.wanted - wave.here.wanted) / (kStep * wave.k);
      out.push_back(100 * wave.group_weight * groupError(symbol, wave));
      out.push_back(100 * wave.group_weight * (frequency(symbol, wave.turned) - here) / (2 * kStep * wave.k * group));
    }
    for (std::size_t grid = 1; grid < 5; ++grid) {
      const double k = 2 * pi / std::pow(2.0, static_cast<double>(grid + 1));
      const Place wave = placeOf(k, 0.0);
      const double phase = frequency(symbol, wave) / wave.wanted - 1;
      const double split = symbol.split(grid);
      // In the shallowest water the errors of 4 cells are those of the 5-point stencil, in any direction.
      const double shallow =
          grid == 1 ? std::lerp(kShallowSplitWeight, 1.0, std::clamp(depth_cells_ - 1, 0.0, 1.0)) : 1.0;
      const double deep = k * depth_cells_ > kMostKd + 0.05 ? kDeepSplitWeight : 1.0;
      const double weight = 100 * kSplitWeights[grid - 1] * shallow * deep;
      out.push_back(weight * (phase + 0.5 * split));
      out.push_back(weight * (phase - 0.5 * split));
      out.push_back(weight * (grid == 1 ? 0.5 : 0.8) * split);
    }
    return out;
  }

  /// Makes sum |error/scale|^power + the pull toward `home` small, from x.
  void minimise(Values& x, const Values& home, double power) const {
    constexpr int kRounds = 60;
    constexpr double kMost = 0.5;  // change of an unknown in one round
    const std::size_t n = x.size();
    Values error = weightedErrors(x);
    const std::size_t count = error.size();
    double scale = 0.0;
    for (const double e : error) scale = std::max(scale, std::abs(e));
    const auto isPulled = [](std::size_t i) { return i % kPerPole != 0; };
    const double pull = kPull * static_cast<double>(count);
    const auto costOf = [&](const Values& e, const Values& at) {
      double sum = 0.0;
      for (const double v : e) sum += std::pow(std::abs(v) / scale, power);
      for (std::size_t i = 0; i < n; ++i) sum += isPulled(i) ? pull * std::pow(at[i] - home[i], 2) : 0.0;
      return sum;
    };
    double cost = costOf(error, x);
    double damping = 0.01;
    for (int round = 0; round < kRounds; ++round) {
      constexpr double kDifference = 1e-5;
      std::vector<Values> slope;
      for (std::size_t i = 0; i < n; ++i) {
        Values moved = x;
        moved[i] += kDifference;
        slope.push_back(weightedErrors(moved));
        for (std::size_t e = 0; e < count; ++e) slope[i][e] = (slope[i][e] - error[e]) / (kDifference * scale);
      }
      Values matrix(n * n);
      Values downhill(n);
      for (std::size_t e = 0; e < count; ++e) {
        const double size = std::max(std::abs(error[e]) / scale, 1e-12);
        const double first = power * std::pow(size, power - 2);
        for (std::size_t i = 0; i < n; ++i) {
          downhill[i] -= first * error[e] / scale * slope[i][e];
          for (std::size_t j = 0; j < n; ++j) matrix[i * n + j] += first * (power - 1) * slope[i][e] * slope[j][e];
        }
      }
      for (std::size_t i = 0; i < n; ++i) {
        if (!isPulled(i)) continue;
        matrix[i * n + i] += 2 * pull;
        downhill[i] -= 2 * pull * (x[i] - home[i]);
      }
      bool is_better = false;
      double gain = 0.0;
      for (int trial = 0; trial < 12 && !is_better; ++trial) {
        Values damped = matrix;
        for (std::size_t i = 0; i < n; ++i) damped[i * n + i] += damping * (matrix[i * n + i] + 1e-9);
        Values step = downhill;
        if (solve(std::move(damped), step)) {
          double largest = kMost;
          for (const double s : step) largest = std::max(largest, std::abs(s));
          Values next = x;
          for (std::size_t i = 0; i < n; ++i) next[i] += step[i] * kMost / largest;
          const Values next_error = weightedErrors(next);
          const double next_cost = costOf(next_error, next);
          if (next_cost < cost) {
            gain = cost - next_cost;
            x = next;
            error = next_error;
            cost = next_cost;
            is_better = true;
          }
        }
        damping = is_better ? std::max(0.3 * damping, 1e-9) : 4 * damping;
      }
      if (!is_better || gain < 1e-7 * cost) return;
    }
  }

  double depth_cells_;
  std::vector<Wave> waves_;
};

}  // namespace

int main() {
  std::vector<std::pair<double, Poles>> fits;
  for (double depth_cells = 64 / std::numbers::sqrt2; depth_cells > 0.7;
       depth_cells /= std::sqrt(std::numbers::sqrt2)) {
    const Fitting fitting(depth_cells);
    const Poles poles = fitting.best(fits.empty() ? kFirst : fits.back().second, fits.empty());
    const Errors off = fitting.errors(poles);
    std::fprintf(stderr,
                 "%7.4f cells deep: %.2f %% at 8 cells and more, %.2f %% at 4; beyond kd %.0f %.2f, %.2f %%; group "
                 "%.2f %%; two frequencies %.2f %% apart; highest frequency %.2f of the step's\n",
                 depth_cells, 100 * off.long_waves, 100 * off.short_waves, kMostKd, 100 * off.long_deep_waves,
                 100 * off.short_deep_waves, 100 * off.group, 100 * off.split, std::sqrt(off.stability));
    fits.emplace_back(depth_cells, poles);
  }
  for (auto row = fits.rbegin(); row != fits.rend(); ++row) {
    const auto& [depth_cells, poles] = *row;
    std::printf("    {%.5g, {{{", depth_cells);
    for (std::size_t k = 0; k < kFittedGridCount; ++k)
      std::printf("%s{%.4g, %.4g}", k == 0 ? "" : ", ", poles.b[k][0], poles.b[k][1]);
    std::printf("}}, {%.4g, %.4g}}},\n", poles.c[0], poles.c[1]);
  }
}
