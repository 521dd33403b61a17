// Discrete Fourier transform of 2^m values.
#pragma once

#include <complex>
#include <span>

namespace spindrift::core {

enum class Transform { kForward, kInverse };

/// Replaces x by sum_j x_j exp(-+2 pi i j k / n), without a factor (Cooley & Tukey 1965). Precondition: the size is a
/// power of two.
void transform(std::span<std::complex<double>> x, Transform direction);

}  // namespace spindrift::core
