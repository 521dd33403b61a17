#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include <spindrift/core/fourier.h>

namespace spindrift::core {

void transform(std::span<std::complex<double>> x, Transform direction) {
  const std::size_t n = x.size();
  for (std::size_t i = 1, j = 0; i < n; ++i) {
    std::size_t bit = n / 2;
    for (; (j & bit) != 0; bit /= 2) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(x[i], x[j]);
  }
  const double turn = (direction == Transform::kForward ? -2.0 : 2.0) * std::numbers::pi / static_cast<double>(n);
  std::vector<std::complex<double>> root(n / 2);
  for (std::size_t k = 0; k < root.size(); ++k) root[k] = std::polar(1.0, turn * static_cast<double>(k));
  for (std::size_t half = 1; half < n; half *= 2) {
    const std::size_t stride = n / (2 * half);
    for (std::size_t begin = 0; begin < n; begin += 2 * half) {
      for (std::size_t k = 0; k < half; ++k) {
        const std::complex<double> a = x[begin + k];
        const std::complex<double>& r = root[k * stride];
        const std::complex<double>& c = x[begin + k + half];
        // Written out: the operator of std::complex handles infinities, which takes most of the time.
        const std::complex<double> b(r.real() * c.real() - r.imag() * c.imag(),
                                     r.real() * c.imag() + r.imag() * c.real());
        x[begin + k] = a + b;
        x[begin + k + half] = a - b;
      }
    }
  }
}

}  // namespace spindrift::core
