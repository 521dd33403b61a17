#include "side_response.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <spindrift/sim_setup/sea_state.h>

namespace spindrift::sim {
namespace {

using std::numbers::pi;

/// Nodes of the integral over wavenumbers.
constexpr int kNodeCount = 2000;
/// Shortest wave with an answer, in cells.
constexpr double kShortest_cells = 4.0;

}  // namespace

SideResponse::SideResponse(double gravity_mps2, double depth_m, double cell_m, double dt_s, bool disperses)
    : gravity_mps2_(gravity_mps2),
      depth_m_(depth_m),
      cell_m_(cell_m),
      dt_s_(dt_s),
      disperses_(disperses),
      long_mps_(std::sqrt(gravity_mps2 * depth_m)) {
  const double step = pi / cell_m / kNodeCount;
  for (int j = 0; j < kNodeCount; ++j) {
    const double k = (j + 0.5) * step;
    k_radpm_.push_back(k);
    const double cosine = std::cos(0.5 * k * cell_m);
    weight_.push_back(step * cosine * cosine);
    square_.push_back(square(k));
  }
  // The frequency of the step is lower: 2/dt sin(w dt/2) = w(k).
  const double shortest = std::sqrt(square(2 * pi / (kShortest_cells * cell_m)));
  highest_radps_ = 2 / dt_s * std::asin(std::min(0.5 * dt_s * shortest, 1.0));
}

double SideResponse::square(double k_radpm) const {
  if (disperses_) return gravity_mps2_ * k_radpm * std::tanh(k_radpm * depth_m_);
  const double slope = 2 / cell_m_ * std::sin(0.5 * k_radpm * cell_m_);
  return gravity_mps2_ * depth_m_ * slope * slope;
}

double SideResponse::squareSlope(double k_radpm) const {
  if (disperses_) {
    const double t = std::tanh(k_radpm * depth_m_);
    return gravity_mps2_ * (t + k_radpm * depth_m_ * (1 - t * t));
  }
  return gravity_mps2_ * depth_m_ * 2 / cell_m_ * std::sin(k_radpm * cell_m_);
}

double SideResponse::wavenumber(double omega_radps) const {
  if (disperses_) return waveNumber(omega_radps, gravity_mps2_, depth_m_);
  return 2 / cell_m_ * std::asin(0.5 * cell_m_ * omega_radps / long_mps_);
}

std::optional<SideResponse::Answer> SideResponse::at(double omega_radps) const {
  if (!(omega_radps > 0.0) || !(omega_radps <= highest_radps_)) return std::nullopt;
  const double w = 2 / dt_s_ * std::sin(0.5 * omega_radps * dt_s_);
  const double k = wavenumber(w);
  const double slope = squareSlope(k);
  const double cosine = std::cos(0.5 * k * cell_m_);
  // Principal value: 1/(k - k0) is taken out of the integrand and integrated by itself.
  const double residue = cosine * cosine / slope;
  double sum = residue * std::log((pi / cell_m_ - k) / k);
  const double step = pi / cell_m_ / kNodeCount;
  for (std::size_t j = 0; j < k_radpm_.size(); ++j) {
    const double off = k_radpm_[j] - k;
    if (std::abs(off) < 1e-6 * step) continue;
    sum += weight_[j] / (square_[j] - w * w) - step * residue / off;
  }
  const std::complex<double> impedance = 2 / pi * w * std::complex<double>(pi * residue, sum);
  const std::complex<double> later = std::polar(1.0, 0.5 * omega_radps * dt_s_);
  const std::complex<double> seen = impedance * later - 0.5 * dt_s_ / cell_m_;
  const double flow_mps = slope / (2 * w * cosine);
  Answer out{.wavenumber_radpm = k, .flow_mps = flow_mps, .edge = flow_mps * seen, .absorbing_mps = 0, .sent_back = 1};
  const std::complex<double> missing = 2 * cosine / flow_mps * later - seen;
  constexpr int kTryCount = 400;
  for (int n = 1; n <= kTryCount; ++n) {
    const double absorbing_mps = 4.0 * n / kTryCount / std::abs(missing);
    const double sent_back = std::abs((1.0 - absorbing_mps * missing) / (1.0 + absorbing_mps * seen));
    if (sent_back >= out.sent_back) continue;
    out.sent_back = sent_back;
    out.absorbing_mps = absorbing_mps;
  }
  return out;
}

// With the forces of both sides of the mirror and the flow q at x = 0, the level is
//   (2 i w q + r)/(w(k)^2 - w^2) over wave numbers k, and r has a pole at the forced wave's. The pole of the free wave
//   k_f
// vanishes with q = level (w(k)^2 - w^2)/(k^2 - k_f^2) w k/w(k)^2 for a pressure, which the dispersion filters, and
// with k_f^2/(w k) in place of the last factor for a force that it does not filter: here their geometric mean, for
// both.
double SideResponse::forcedFlow_mps(double omega_radps, double k_radpm) const {
  const double w = 2 / dt_s_ * std::sin(0.5 * omega_radps * dt_s_);
  const double free_radpm = wavenumber(w);
  const double slope = (square(k_radpm) - w * w) / (k_radpm * k_radpm - free_radpm * free_radpm);
  return slope * free_radpm / (std::sqrt(square(k_radpm)) * std::cos(0.5 * k_radpm * cell_m_));
}

}  // namespace spindrift::sim
