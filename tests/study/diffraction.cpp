#include "diffraction.h"

#include <cmath>
#include <numbers>

namespace spindrift::study {

using Complex = std::complex<double>;
using std::numbers::pi;

Complex fresnelIntegral(double x) {
  // Simpson's rule, with 40 points or more in the shortest turn of the phase pi u^2/2.
  const int intervals = 2 * static_cast<int>(std::ceil(20 * x * x + 20));
  const double h = x / intervals;
  Complex sum;
  for (int i = 0; i <= intervals; ++i) {
    const double weight = i == 0 || i == intervals ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    sum += weight * std::polar(1.0, -0.5 * pi * (i * h) * (i * h));
  }
  return sum * h / 3.0;
}

namespace {

/// From 0 for sigma = -infinity (full shadow) to 1 for +infinity.
Complex light(double sigma) {
  return Complex(0.5, 0.5) * (Complex(0.5, -0.5) + fresnelIntegral(sigma));
}

}  // namespace

Complex pastBreakwaterEnd(double along_m, double behind_m, double k_radpm) {
  const double r_m = std::hypot(along_m, behind_m);
  const double wavelength_m = 2 * pi / k_radpm;
  // The incident wave is missing behind the breakwater, its reflection everywhere but in front of it.
  const bool is_shadow = along_m > 0 && behind_m > 0;
  const bool is_reflected = along_m > 0 && behind_m < 0;
  const double sigma = 2 * std::sqrt(std::max(r_m - behind_m, 0.0) / wavelength_m) * (is_shadow ? -1 : 1);
  const double sigma_reflected = 2 * std::sqrt(std::max(r_m + behind_m, 0.0) / wavelength_m) * (is_reflected ? 1 : -1);
  return std::polar(1.0, -k_radpm * behind_m) * light(sigma) +
         std::polar(1.0, k_radpm * behind_m) * light(sigma_reflected);
}

Complex behindGap(double along_m, double behind_m, double gap_m, double k_radpm) {
  return pastBreakwaterEnd(along_m - gap_m / 2, behind_m, k_radpm) +
         pastBreakwaterEnd(-along_m - gap_m / 2, behind_m, k_radpm) - std::polar(1.0, -k_radpm * behind_m);
}

}  // namespace spindrift::study
