// A density over an interval, for spectra and spreads of directions.
#pragma once

#include <functional>
#include <vector>

namespace spindrift::sim {

/// Its integral and its quantiles.
class Distribution {
 public:
  Distribution(double from, double to, const std::function<double(double)>& density);
  [[nodiscard]] double integral() const { return sums_.back(); }
  /// Returns the value below which a share of the integral lies. Precondition: the integral is positive.
  [[nodiscard]] double quantile(double share) const;

 private:
  double from_;
  double step_ = 0.0;
  std::vector<double> sums_;
};

}  // namespace spindrift::sim
