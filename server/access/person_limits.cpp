#include <algorithm>

#include <spindrift/access/person_limits.h>

namespace spindrift::access {

bool PersonLimits::take(const std::string& subject, TimePoint now) {
  const std::lock_guard lock(mutex_);
  auto found = accounts_.find(subject);
  if (found == accounts_.end()) {
    if (accounts_.size() >= kMaxPersonCount)
      accounts_.erase(std::ranges::min_element(accounts_, {}, [](const auto& entry) { return entry.second.used; }));
    found = accounts_.emplace(subject, Account{{commands_per_s_, burst_count_, now}, now}).first;
  }
  found->second.used = now;
  const bool taken = found->second.commands.take(now);
  if (!taken) ++refused_count_;
  return taken;
}

std::size_t PersonLimits::personCount() const {
  const std::lock_guard lock(mutex_);
  return accounts_.size();
}

}  // namespace spindrift::access
