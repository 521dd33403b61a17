#include <algorithm>
#include <iterator>
#include <utility>

#include <spindrift/rooms/held_clock.h>

namespace spindrift::rooms {

const HeldClock::Holder* HeldClock::find(const core::Sender& sender) const {
  const auto found = std::ranges::find_if(holders_, [&](const Holder& holder) {
    return holder.who.person_id == sender.person_id && holder.who.session_id == sender.session_id;
  });
  return found == holders_.end() ? nullptr : &*found;
}

double HeldClock::speed() const {
  double out = 0.0;
  for (const Holder& holder : holders_) {
    if (holder.terms.speed > 0.0 && (out == 0.0 || holder.terms.speed < out)) out = holder.terms.speed;
  }
  return out;
}

std::uint32_t HeldClock::ticksToCome() const {
  return holders_.empty() ? 0 : std::ranges::min_element(holders_, {}, &Holder::ticks_to_come)->ticks_to_come;
}

HeldClock::TimePoint HeldClock::expiryOf(const Holder& holder) {
  return holder.waiting_since +
         std::chrono::duration_cast<TimePoint::duration>(std::chrono::duration<double>(holder.terms.timeout_s));
}

bool HeldClock::isSilent(const Holder& holder, TimePoint now) {
  return holder.ticks_to_come == 0 && now >= expiryOf(holder);
}

std::optional<HeldClock::TimePoint> HeldClock::expiry() const {
  std::optional<TimePoint> out;
  for (const Holder& holder : holders_) {
    if (holder.ticks_to_come == 0 && (!out || expiryOf(holder) < *out)) out = expiryOf(holder);
  }
  return out;
}

bool HeldClock::take(const core::Sender& who, std::string name, const Terms& terms, TimePoint now) {
  if (const Holder* known = find(who)) {
    holders_[static_cast<std::size_t>(known - holders_.data())].terms = terms;
    excuse(who, now);
    return true;
  }
  if (holders_.size() >= kClockHolderMaxCount) return false;
  const auto after =
      std::ranges::find_if(holders_, [&](const Holder& holder) { return holder.who.person_id > who.person_id; });
  holders_.insert(after, {.who = who, .name = std::move(name), .terms = terms, .waiting_since = now});
  return true;
}

void HeldClock::ask(const core::Sender& who, std::uint32_t tick_count) {
  for (Holder& holder : holders_) {
    if (holder.who.session_id == who.session_id) holder.ticks_to_come += tick_count;
  }
}

void HeldClock::ticked(TimePoint now) {
  for (Holder& holder : holders_) {
    if (--holder.ticks_to_come == 0) holder.waiting_since = now;
  }
}

void HeldClock::dropTicks(TimePoint now) {
  for (Holder& holder : holders_) {
    holder.ticks_to_come = 0;
    holder.waiting_since = now;
  }
}

void HeldClock::excuse(const core::Sender& who, TimePoint now) {
  for (Holder& holder : holders_) {
    if (holder.who.session_id == who.session_id) holder.waiting_since = now;
  }
}

std::vector<HeldClock::Holder> HeldClock::removeIf(const std::function<bool(const Holder&)>& holds) {
  const auto removed =
      std::stable_partition(holders_.begin(), holders_.end(), [&](const Holder& holder) { return !holds(holder); });
  std::vector<Holder> out(std::make_move_iterator(removed), std::make_move_iterator(holders_.end()));
  holders_.erase(removed, holders_.end());
  return out;
}

}  // namespace spindrift::rooms
