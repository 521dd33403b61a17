#include <cassert>

#include <spindrift/core/demand_table.h>

namespace spindrift::core {

void DemandTable::set(std::size_t stream, const void* reader, const std::optional<Need>& need) {
  assert(stream < kStreamMaxCount);
  const std::lock_guard lock(mutex_);
  Stream& s = streams_[stream];
  const auto count = [&s](const Need& one, auto add) {
    add(s.watcher_counts[indexOf(one.level)], one.watcher_count);
    if (one.is_newcomer) add(s.newcomer_counts[indexOf(one.level)], std::size_t{1});
    if (one.keyframe_from) add(s.keyframe_need_count, std::size_t{1});
  };
  if (const auto before = s.needs.find(reader); before != s.needs.end()) {
    count(before->second, [](std::size_t& total, std::size_t by) { total -= by; });
    if (!need) s.needs.erase(before);
  }
  if (!need) return;
  count(*need, [](std::size_t& total, std::size_t by) { total += by; });
  s.needs[reader] = *need;
}

void DemandTable::addSessions(std::ptrdiff_t count) {
  const std::lock_guard lock(mutex_);
  session_count_ += static_cast<std::size_t>(count);
}

StreamDemand DemandTable::of(std::size_t stream, TimePoint when) const {
  assert(stream < kStreamMaxCount);
  const std::lock_guard lock(mutex_);
  const Stream& s = streams_[stream];
  StreamDemand out;
  for (std::size_t k = 0; k < kLevelCount; ++k) {
    out[k].watcher_count = s.watcher_counts[k];
    out[k].has_newcomer = s.newcomer_counts[k] > 0;
  }
  if (s.keyframe_need_count == 0) return out;
  for (const auto& [reader, need] : s.needs) {
    if (need.keyframe_from && *need.keyframe_from <= when) out[indexOf(need.level)].wants_keyframe = true;
  }
  return out;
}

std::size_t DemandTable::sessionCount() const {
  const std::lock_guard lock(mutex_);
  return session_count_;
}

}  // namespace spindrift::core
