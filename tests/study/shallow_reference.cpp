#include "shallow_reference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace spindrift::study {
namespace {

constexpr double kGravity_mps2 = 9.81;
/// Of the generalized minmod limiter: 1 is the most diffusive, 2 the least.
constexpr double kTheta = 1.3;
constexpr double kCourant = 0.45;
/// Velocities of thinner water are reduced, so that they stay bounded. [m]
constexpr double kThin_m = 1e-3;

double minmod(double a, double b, double c) {
  if (a > 0 && b > 0 && c > 0) return std::min({a, b, c});
  if (a < 0 && b < 0 && c < 0) return std::max({a, b, c});
  return 0.0;
}

/// Slope of a cell times half its length.
double halfRise(double before, double here, double after) {
  return 0.5 * minmod(kTheta * (here - before), 0.5 * (after - before), kTheta * (after - here));
}

struct Side {
  double depth_m;
  double velocity_mps;
};

/// Velocity of a flow through water of this depth.
double velocityOf(double depth_m, double flow_m2ps) {
  if (depth_m <= 0) return 0.0;
  if (depth_m >= kThin_m) return flow_m2ps / depth_m;
  const double fourth = std::pow(depth_m / kThin_m, 4);
  return std::sqrt(2.0) * depth_m * flow_m2ps / (kThin_m * kThin_m * std::sqrt(fourth + 1.0));
}

Side sideOf(double level_m, double flow_m2ps, double edge_m) {
  const double depth_m = std::max(level_m - edge_m, 0.0);
  return {depth_m, velocityOf(depth_m, flow_m2ps)};
}

}  // namespace

double betweenCells(std::span<const double> values, double cells) {
  const double at = std::clamp(cells - 0.5, 0.0, static_cast<double>(values.size()) - 1.0);
  const std::size_t i = std::min(static_cast<std::size_t>(at), values.size() - 2);
  return std::lerp(values[i], values[i + 1], at - static_cast<double>(i));
}

ShallowReference::ShallowReference(double length_m, std::size_t cell_count,
                                   const std::function<double(double x_m)>& ground_m,
                                   const std::function<Water(double x_m)>& start)
    : cell_m_(length_m / static_cast<double>(cell_count)) {
  for (std::size_t i = 0; i <= cell_count; ++i) edge_m_.push_back(ground_m(static_cast<double>(i) * cell_m_));
  for (std::size_t i = 0; i < cell_count; ++i) {
    ground_m_.push_back(0.5 * (edge_m_[i] + edge_m_[i + 1]));
    const Water water = start((static_cast<double>(i) + 0.5) * cell_m_);
    level_m_.push_back(std::max(water.level_m, ground_m_[i]));
    flow_m2ps_.push_back((level_m_[i] - ground_m_[i]) * water.velocity_mps);
  }
  level_rate_mps_.resize(cell_count);
  flow_rate_m2ps2_.resize(cell_count);
}

double ShallowReference::findRates(const std::vector<double>& level_m, const std::vector<double>& flow_m2ps) {
  const std::size_t n = level_m.size();
  double fastest_mps = 0.0;
  double level_flux = 0.0, flow_flux = 0.0;  // of the edge before the cell
  // Water beyond a wall is the mirror image.
  const auto edgesOf = [&](std::size_t i, Side& left, Side& right) {
    const double level_before = level_m[i > 0 ? i - 1 : 0], level_after = level_m[i + 1 < n ? i + 1 : n - 1];
    const double flow_before = i > 0 ? flow_m2ps[i - 1] : -flow_m2ps[0];
    const double flow_after = i + 1 < n ? flow_m2ps[i + 1] : -flow_m2ps[n - 1];
    const double rise_m = halfRise(level_before, level_m[i], level_after);
    const double rise_m2ps = halfRise(flow_before, flow_m2ps[i], flow_after);
    double low_m = level_m[i] - rise_m, high_m = level_m[i] + rise_m;
    // The level at an edge is not below its ground; the mean stays.
    if (low_m < edge_m_[i]) {
      low_m = edge_m_[i];
      high_m = 2 * level_m[i] - edge_m_[i];
    } else if (high_m < edge_m_[i + 1]) {
      high_m = edge_m_[i + 1];
      low_m = 2 * level_m[i] - edge_m_[i + 1];
    }
    left = sideOf(low_m, flow_m2ps[i] - rise_m2ps, edge_m_[i]);
    right = sideOf(high_m, flow_m2ps[i] + rise_m2ps, edge_m_[i + 1]);
  };
  Side left{}, right{}, next_left{}, next_right{};
  edgesOf(0, left, right);
  const auto fluxOf = [&](const Side& a, const Side& b, double edge_m) {
    const double wave_a = std::sqrt(kGravity_mps2 * a.depth_m), wave_b = std::sqrt(kGravity_mps2 * b.depth_m);
    const double up = std::max({a.velocity_mps + wave_a, b.velocity_mps + wave_b, 0.0});
    const double down = std::min({a.velocity_mps - wave_a, b.velocity_mps - wave_b, 0.0});
    fastest_mps = std::max({fastest_mps, up, -down});
    const double q_a = a.depth_m * a.velocity_mps, q_b = b.depth_m * b.velocity_mps;
    if (up - down < std::numeric_limits<double>::min()) return std::pair{0.0, 0.0};
    const double f_a = q_a * a.velocity_mps + 0.5 * kGravity_mps2 * a.depth_m * a.depth_m;
    const double f_b = q_b * b.velocity_mps + 0.5 * kGravity_mps2 * b.depth_m * b.depth_m;
    const double spread = up * down / (up - down);
    const double level_a = a.depth_m + edge_m, level_b = b.depth_m + edge_m;
    return std::pair{(up * q_a - down * q_b) / (up - down) + spread * (level_b - level_a),
                     (up * f_a - down * f_b) / (up - down) + spread * (q_b - q_a)};
  };
  const Side mirrored{left.depth_m, -left.velocity_mps};
  std::tie(level_flux, flow_flux) = fluxOf(mirrored, left, edge_m_[0]);
  for (std::size_t i = 0; i < n; ++i) {
    const double depth_before_m = left.depth_m;
    if (i + 1 < n) {
      edgesOf(i + 1, next_left, next_right);
    } else {
      next_left = {right.depth_m, -right.velocity_mps};
    }
    const auto [level_next, flow_next] = fluxOf(right, next_left, edge_m_[i + 1]);
    // The pressure of the ground: exact for level water.
    const double pressed = 0.5 * kGravity_mps2 * (right.depth_m + depth_before_m) * (edge_m_[i + 1] - edge_m_[i]);
    level_rate_mps_[i] = (level_flux - level_next) / cell_m_;
    flow_rate_m2ps2_[i] = (flow_flux - flow_next - pressed) / cell_m_;
    level_flux = level_next;
    flow_flux = flow_next;
    left = next_left;
    right = next_right;
  }
  return fastest_mps;
}

void ShallowReference::advance(double duration_s) {
  const double end_s = time_s_ + duration_s;
  const std::size_t n = level_m_.size();
  // Thin water has no more flow than its bounded velocity carries.
  const auto settle = [&](std::size_t i, double level_m, double flow_m2ps) {
    const double depth_m = level_m - ground_m_[i];
    return depth_m * velocityOf(depth_m, flow_m2ps);
  };
  while (time_s_ < end_s - 1e-12) {
    const double fastest_mps = findRates(level_m_, flow_m2ps_);
    const double dt_s = std::min(kCourant * cell_m_ / std::max(fastest_mps, 1e-9), end_s - time_s_);
    next_level_m_.resize(n);
    next_flow_m2ps_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      next_level_m_[i] = std::max(level_m_[i] + dt_s * level_rate_mps_[i], ground_m_[i]);
      next_flow_m2ps_[i] = settle(i, next_level_m_[i], flow_m2ps_[i] + dt_s * flow_rate_m2ps2_[i]);
    }
    findRates(next_level_m_, next_flow_m2ps_);
    for (std::size_t i = 0; i < n; ++i) {
      level_m_[i] = std::max(0.5 * (level_m_[i] + next_level_m_[i] + dt_s * level_rate_mps_[i]), ground_m_[i]);
      flow_m2ps_[i] = settle(i, level_m_[i], 0.5 * (flow_m2ps_[i] + next_flow_m2ps_[i] + dt_s * flow_rate_m2ps2_[i]));
    }
    time_s_ += dt_s;
  }
}

double ShallowReference::levelAt(double x_m) const {
  return betweenCells(level_m_, x_m / cell_m_);
}

double ShallowReference::waterBeyond(double x_m) const {
  double sum_m2 = 0.0;
  for (std::size_t i = 0; i < level_m_.size(); ++i) {
    const double first_m = static_cast<double>(i) * cell_m_;
    const double share = std::clamp((first_m + cell_m_ - x_m) / cell_m_, 0.0, 1.0);
    sum_m2 += share * cell_m_ * (level_m_[i] - ground_m_[i]);
  }
  return sum_m2;
}

}  // namespace spindrift::study
