#include <algorithm>
#include <cmath>

#include <shared/boats.h>

#include <spindrift/study/hull_pressure.h>

namespace spindrift::study {
namespace {

/// Half of the integral of exp(-q^4): Gamma(5/4).
constexpr double kHalfIntegral = 0.9064;

/// Integral of exp(-q^4) cos(kappa q) over the reach, by Simpson's rule.
double transform(double kappa) {
  constexpr int kSteps = 256;
  const double step = double{HULL_REACH} / kSteps;
  double sum = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const double q = i * step;
    const double weight = i == 0 || i == kSteps ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
    sum += weight * std::exp(-q * q * q * q) * std::cos(kappa * q);
  }
  return 2.0 * sum * step / 3.0;
}

}  // namespace

HullPressure hullPressure(const core::Boat& boat, double cell_m) {
  HullPressure out{};
  out.half_length_m = std::max(boat.length_m / 2, 1.5 * cell_m);
  out.half_beam_m = std::max(boat.beam_m / 2, 1.5 * cell_m);
  out.volume_m3 = boat.length_m * boat.beam_m * boat.height_m * boat.density_ratio;
  out.peak_m = out.volume_m3 / (4 * out.half_length_m * out.half_beam_m * kHalfIntegral * kHalfIntegral);
  return out;
}

double HullPressure::head_m(double along_m, double across_m) const {
  const double a = along_m / half_length_m;
  const double b = across_m / half_beam_m;
  if (std::max(std::abs(a), std::abs(b)) > double{HULL_REACH}) return 0.0;
  return peak_m * std::exp(-std::pow(a, 4) - std::pow(b, 4));
}

double HullPressure::spectrum_m3(double k_along_radpm, double k_across_radpm) const {
  return peak_m * half_length_m * transform(k_along_radpm * half_length_m) * half_beam_m *
         transform(k_across_radpm * half_beam_m);
}

}  // namespace spindrift::study
