#include "distribution.h"

#include <algorithm>

namespace spindrift::sim {

Distribution::Distribution(double from, double to, const std::function<double(double)>& density) : from_(from) {
  constexpr int kSteps = 4000;
  step_ = (to - from) / kSteps;
  sums_.push_back(0.0);
  for (int k = 0; k < kSteps; ++k) sums_.push_back(sums_.back() + density(from + (k + 0.5) * step_) * step_);
}

double Distribution::quantile(double share) const {
  const double wanted = std::clamp(share, 0.0, 1.0) * integral();
  const auto above = std::ranges::upper_bound(sums_, wanted);
  if (above == sums_.end()) return from_ + static_cast<double>(sums_.size() - 1) * step_;
  const auto k = above - sums_.begin() - 1;
  const double low = sums_[static_cast<std::size_t>(k)];
  return from_ + (static_cast<double>(k) + (wanted - low) / (*above - low)) * step_;
}

}  // namespace spindrift::sim
