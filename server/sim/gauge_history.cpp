#include <algorithm>

#include <spindrift/sim/gauge_history.h>

namespace spindrift::sim {

GaugeHistory::GaugeHistory(std::size_t gauge_count) : gauge_count_(gauge_count), now_(gauge_count) {}

void GaugeHistory::add(double time_s, std::span<const GaugeReading> readings) {
  const std::lock_guard lock(mutex_);
  if (times_s_.size() < kTickMaxCount) {
    times_s_.push_back(time_s);
    readings_.insert(readings_.end(), readings.begin(), readings.end());
  } else {
    times_s_[next_] = time_s;
    std::ranges::copy(readings, readings_.begin() + static_cast<std::ptrdiff_t>(next_ * gauge_count_));
  }
  next_ = (next_ + 1) % kTickMaxCount;
  for (std::size_t k = 0; k < gauge_count_; ++k) {
    Now& now = now_[k];
    now.reading = readings[k];
    now.highest_m = is_empty_ ? readings[k].elevation_m : std::max(now.highest_m, readings[k].elevation_m);
    now.lowest_m = is_empty_ ? readings[k].elevation_m : std::min(now.lowest_m, readings[k].elevation_m);
  }
  newest_time_s_ = time_s;
  is_empty_ = false;
}

void GaugeHistory::clear() {
  const std::lock_guard lock(mutex_);
  times_s_.clear();
  readings_.clear();
  now_.assign(gauge_count_, {});
  next_ = 0;
  newest_time_s_ = 0.0;
  is_empty_ = true;
}

std::vector<GaugeHistory::Now> GaugeHistory::now() const {
  const std::lock_guard lock(mutex_);
  return now_;
}

double GaugeHistory::newestTime_s() const {
  const std::lock_guard lock(mutex_);
  return newest_time_s_;
}

GaugeHistory::Series GaugeHistory::series(std::size_t gauge) const {
  const std::lock_guard lock(mutex_);
  Series out;
  const std::size_t count = times_s_.size();
  const std::size_t oldest = count < kTickMaxCount ? 0 : next_;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t at = (oldest + k) % count;
    out.time_s.push_back(times_s_[at]);
    out.readings.push_back(readings_[at * gauge_count_ + gauge]);
  }
  return out;
}

}  // namespace spindrift::sim
