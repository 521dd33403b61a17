#include "exact_linear_waves.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <spindrift/core/fourier.h>

namespace spindrift::study {

double AiryWater::omega_radps(double k_radpm) const {
  return std::sqrt(k_radpm * (gravity_mps2 + tension_m3ps2 * k_radpm * k_radpm) * std::tanh(k_radpm * depth_m));
}

double AiryWater::phaseSpeed_mps(double k_radpm) const {
  if (k_radpm <= 0) return std::sqrt(gravity_mps2 * depth_m);
  return omega_radps(k_radpm) / k_radpm;
}

double AiryWater::groupSpeed_mps(double k_radpm) const {
  const double twice_kd = 2 * k_radpm * depth_m;
  const double share = twice_kd < 1e-9 ? 1.0 : twice_kd < 600 ? twice_kd / std::sinh(twice_kd) : 0.0;
  return 0.5 * phaseSpeed_mps(k_radpm) * (1 + share);
}

double AiryWater::waveNumber_radpm(double omega_radps_wanted) const {
  const double deep_radpm = omega_radps_wanted * omega_radps_wanted / gravity_mps2;
  // Start on the side from which Newton's method on omega(k), a concave function, converges: k below the solution.
  double k_radpm = std::max(deep_radpm, omega_radps_wanted / std::sqrt(gravity_mps2 * depth_m));
  for (int round = 0; round < 100; ++round) {
    const double change = (omega_radps_wanted - omega_radps(k_radpm)) / groupSpeed_mps(k_radpm);
    k_radpm += change;
    if (std::abs(change) < 1e-14 * k_radpm) break;
  }
  return k_radpm;
}

double AiryWater::stationaryWaveNumber_radpm(double speed_mps) const {
  if (speed_mps >= std::sqrt(gravity_mps2 * depth_m)) return 0.0;
  double low = 0.0;
  double high = gravity_mps2 / (speed_mps * speed_mps);  // that of deep water
  for (int round = 0; round < 200; ++round) {
    const double middle = 0.5 * (low + high);
    (phaseSpeed_mps(middle) > speed_mps ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double humpAt(Hump hump, double r_over_width) {
  const double r2 = r_over_width * r_over_width;
  return (hump == Hump::kRicker ? 1 - r2 : 1.0) * std::exp(-r2);
}

AiryRings::AiryRings(const AiryWater& water, Hump hump, double width_m, double time_s, double reach_m)
    : step_m_(width_m / 64) {
  // The Hankel transform of exp(-(r/w)^2) is (w^2/2) exp(-q), q = (k w/2)^2; that of (r/w)^2 exp(-(r/w)^2) has the
  // further factor 1 - q.
  const double k_max_radpm = 13.0 / width_m;
  const double dk_radpm = 0.2 / (reach_m + water.phaseSpeed_mps(0.0) * time_s + width_m);
  const auto k_count = static_cast<std::size_t>(k_max_radpm / dk_radpm);
  std::vector<double> k_radpm(k_count), share(k_count);
  for (std::size_t i = 0; i < k_count; ++i) {
    const double k = (static_cast<double>(i) + 0.5) * dk_radpm;  // midpoint rule
    const double q = 0.25 * k * k * width_m * width_m;
    k_radpm[i] = k;
    share[i] = dk_radpm * k * 0.5 * width_m * width_m * (hump == Hump::kRicker ? q : 1.0) * std::exp(-q) *
               std::cos(water.omega_radps(k) * time_s);
  }
  const auto r_count = static_cast<std::size_t>(std::ceil(reach_m / step_m_)) + 3;
  for (std::size_t r = 0; r < r_count; ++r) {
    double sum = 0.0;
    for (std::size_t i = 0; i < k_count; ++i) sum += share[i] * ::j0(k_radpm[i] * static_cast<double>(r) * step_m_);
    eta_.push_back(sum);
  }
}

double AiryRings::at(double r_m) const {
  // Cubic interpolation; the rings are even in r.
  const double u = r_m / step_m_;
  const auto i = static_cast<std::size_t>(u);
  const double t = u - static_cast<double>(i);
  const double before = eta_[i == 0 ? 1 : i - 1];
  return -before * t * (t - 1) * (t - 2) / 6 + eta_[i] * (t + 1) * (t - 1) * (t - 2) / 2 -
         eta_[i + 1] * (t + 1) * t * (t - 2) / 2 + eta_[i + 2] * (t + 1) * t * (t - 1) / 6;
}

LinearSea::LinearSea(const AiryWater& water, std::size_t n, double side_m) : n_(n) {
  const double unit_radpm = 2 * std::numbers::pi / side_m;
  for (std::size_t x = 0; x <= n / 2; ++x) {
    for (std::size_t z = 0; z < n; ++z) {
      const auto waves_z = static_cast<double>(z <= n / 2 ? z : n - z);
      omega_radps_.push_back(water.omega_radps(unit_radpm * std::hypot(static_cast<double>(x), waves_z)));
    }
  }
  elevation_m_.resize(omega_radps_.size());
  rate_mps_.resize(omega_radps_.size());
  head_m_.resize(omega_radps_.size());
}

std::vector<LinearSea::Complex> LinearSea::spectrumOf(std::span<const double> field) const {
  std::vector<Complex> out((n_ / 2 + 1) * n_);
  std::vector<Complex> row(n_);
  for (std::size_t z = 0; z < n_; ++z) {
    bool is_empty = true;
    for (std::size_t x = 0; x < n_; ++x) {
      row[x] = field[x + n_ * z];
      is_empty = is_empty && field[x + n_ * z] == 0.0;
    }
    if (is_empty) continue;
    core::transform(row, core::Transform::kForward);
    for (std::size_t x = 0; x <= n_ / 2; ++x) out[z + n_ * x] = row[x];
  }
  for (std::size_t x = 0; x <= n_ / 2; ++x)
    core::transform(std::span(out).subspan(n_ * x, n_), core::Transform::kForward);
  return out;
}

void LinearSea::advance(std::span<const double> head_m, double dt_s) {
  // With y = eta + head, y_tt + omega^2 y = 0 while the head changes linearly: y turns in its phase plane.
  const std::vector<Complex> next_m = spectrumOf(head_m);
  for (std::size_t i = 0; i < omega_radps_.size(); ++i) {
    const double omega = omega_radps_[i];
    const double c = std::cos(omega * dt_s);
    const double s_over_omega = omega > 0 ? std::sin(omega * dt_s) / omega : dt_s;
    const Complex head_rate = (next_m[i] - head_m_[i]) / dt_s;
    const Complex y = elevation_m_[i] + head_m_[i];
    const Complex y_rate = rate_mps_[i] + head_rate;
    elevation_m_[i] = c * y + s_over_omega * y_rate - next_m[i];
    rate_mps_[i] = c * y_rate - omega * omega * s_over_omega * y - head_rate;
    head_m_[i] = next_m[i];
  }
  elevation_m_[0] = rate_mps_[0] = 0.0;  // the pressure moves no water into the square
}

std::vector<double> LinearSea::surface() const {
  std::vector<Complex> columns = elevation_m_;
  for (std::size_t x = 0; x <= n_ / 2; ++x)
    core::transform(std::span(columns).subspan(n_ * x, n_), core::Transform::kInverse);
  std::vector<double> out(n_ * n_);
  std::vector<Complex> row(n_);
  const auto cells = static_cast<double>(n_ * n_);
  for (std::size_t z = 0; z < n_; ++z) {
    for (std::size_t x = 0; x <= n_ / 2; ++x) row[x] = columns[z + n_ * x];
    for (std::size_t x = n_ / 2 + 1; x < n_; ++x) row[x] = std::conj(row[n_ - x]);
    core::transform(row, core::Transform::kInverse);
    for (std::size_t x = 0; x < n_; ++x) out[x + n_ * z] = row[x].real() / cells;
  }
  return out;
}

}  // namespace spindrift::study
