#include <complex>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <spindrift/core/fourier.h>

namespace spindrift::core {
namespace {

using std::numbers::pi;

TEST(FourierTransform, IsTheSumAndIsUndoneByItsInverse) {
  std::vector<std::complex<double>> x(32);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (auto& value : x) value = {any(random), any(random)};
  auto y = x;
  transform(y, Transform::kForward);
  for (const std::size_t k : {0u, 5u, 31u}) {
    std::complex<double> sum;
    for (std::size_t j = 0; j < x.size(); ++j) sum += x[j] * std::polar(1.0, -2 * pi * static_cast<double>(j * k) / 32);
    EXPECT_NEAR(std::abs(y[k] - sum), 0.0, 1e-12);
  }
  transform(y, Transform::kInverse);
  for (std::size_t j = 0; j < x.size(); ++j) EXPECT_NEAR(std::abs(y[j] / 32.0 - x[j]), 0.0, 1e-14);
}

}  // namespace
}  // namespace spindrift::core
