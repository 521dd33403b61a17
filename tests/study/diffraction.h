// Diffraction of plane waves by rigid vertical breakwaters, for normal incidence.
#pragma once

#include <complex>

namespace spindrift::study {

/// C(x) - i S(x) = Int_0^x exp(-i pi u^2/2) du.
[[nodiscard]] std::complex<double> fresnelIntegral(double x);

/// Waves past the end of a thin breakwater that reaches to infinity: Sommerfeld's solution, as in Penney & Price (1952,
/// Phil. Trans. R. Soc. A 244). `along_m`: distance from the end, positive beside the breakwater; `behind_m`: distance
/// from its line, positive on the lee side. Returns the elevation over that of the incident wave at the end, with the
/// time factor e^(i omega t).
[[nodiscard]] std::complex<double> pastBreakwaterEnd(double along_m, double behind_m, double k_radpm);

/// Waves behind a gap between two such breakwaters, one positive `along_m` from the middle of the gap and one negative:
/// the sum of the solutions for both less the incident wave, which neglects what one end sends to the other. Penney &
/// Price use it for gaps wider than a wavelength. Precondition: behind_m >= 0.
[[nodiscard]] std::complex<double> behindGap(double along_m, double behind_m, double gap_m, double k_radpm);

}  // namespace spindrift::study
