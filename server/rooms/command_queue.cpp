#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <spindrift/rooms/command_queue.h>

namespace spindrift::rooms {
namespace {

bool isHeavy(const Command& command) {
  return traitsOf(command.message).is_heavy;
}

/// Returns whether both can be carried out as one, regardless of the senders.
bool isEqual(const v1::Command& a, const v1::Command& b) {
  if (a.action_case() != b.action_case() || !traitsOf(a).is_shared) return false;
  v1::Command same = b;
  same.set_command_id(a.command_id());
  return a.SerializeAsString() == same.SerializeAsString();
}

bool setsTheSame(const v1::Command& a, const v1::Command& b) {
  return a.has_set_parameter() && b.has_set_parameter() && a.set_parameter().path() == b.set_parameter().path();
}

}  // namespace

std::optional<std::string> CommandQueue::tryPush(Command command, TimePoint now) {
  const std::lock_guard lock(mutex_);
  if (count_ >= bounds_.max_count)
    return fmt::format("the queue of this room is full ({} commands): try again", bounds_.max_count);
  const LaneKey key = keyOf(command.sender);
  Lane& lane = lanes_[key];
  const bool is_heavy = isHeavy(command);
  if (lane.entries.size() >= bounds_.lane_max_count)
    return fmt::format("your limit of {} waiting commands is reached: try again when they are answered",
                       bounds_.lane_max_count);
  if (is_heavy && lane.heavy_count >= bounds_.lane_heavy_max_count)
    return fmt::format(
        "your limit of {} waiting resets, scenes, parameters and boats is reached: try again when they are answered",
        bounds_.lane_heavy_max_count);
  if (lane.entries.empty()) turns_.push_back(key);
  lane.entries.push_back({std::move(command), now});
  lane.heavy_count += is_heavy ? 1 : 0;
  ++count_;
  return std::nullopt;
}

std::optional<CommandQueue::Batch> CommandQueue::next(const Allowed& allowed) {
  const std::lock_guard lock(mutex_);
  const auto may_go = [&](LaneKey key) {
    const Lane& lane = lanes_.at(key);
    const Command& command = lane.entries.front().command;
    if (lane.is_held) return false;
    if (command.message.has_change_scene()) return allowed.heavy && allowed.scene_change;
    return allowed.heavy || !isHeavy(command);
  };
  const auto turn = std::ranges::find_if(turns_, may_go);
  if (turn == turns_.end()) return std::nullopt;
  const LaneKey key = *turn;
  turns_.erase(turn);
  turns_.push_back(key);
  Lane& lane = lanes_.at(key);
  Batch out;
  out.push_back(pop(lane));
  const v1::Command first = out.front().message;
  while (allowed.joined_values && !lane.entries.empty() && setsTheSame(first, lane.entries.front().command.message))
    out.push_back(pop(lane));
  tidy(key);
  takeEqual(first, out);
  return out;
}

void CommandQueue::hold(const Batch& batch) {
  const std::lock_guard lock(mutex_);
  for (const Command& command : batch) lanes_[keyOf(command.sender)].is_held = true;
}

void CommandQueue::release(const Batch& batch) {
  const std::lock_guard lock(mutex_);
  for (const Command& command : batch) {
    const LaneKey key = keyOf(command.sender);
    lanes_[key].is_held = false;
    tidy(key);
  }
}

bool CommandQueue::isBusyWith(const core::Sender& sender) const {
  const std::lock_guard lock(mutex_);
  return lanes_.contains(keyOf(sender));
}

CommandQueue::Batch CommandQueue::takeEqual(const v1::Command& command) {
  const std::lock_guard lock(mutex_);
  Batch out;
  takeEqual(command, out);
  return out;
}

CommandQueue::Batch CommandQueue::takeExpired(TimePoint now) {
  const std::lock_guard lock(mutex_);
  Batch out;
  const auto is_expired = [&](const Lane& lane) {
    if (lane.entries.empty() || lane.is_held) return false;
    const Entry& first = lane.entries.front();
    return isHeavy(first.command) && now - first.arrived > bounds_.heavy_wait_max;
  };
  for (const LaneKey key : std::deque(turns_)) {
    Lane& lane = lanes_.at(key);
    while (is_expired(lane)) out.push_back(pop(lane));
    tidy(key);
  }
  return out;
}

CommandQueue::Batch CommandQueue::drain() {
  const std::lock_guard lock(mutex_);
  Batch out;
  for (auto& [key, lane] : lanes_) {
    while (!lane.entries.empty()) out.push_back(pop(lane));
  }
  lanes_.clear();
  turns_.clear();
  return out;
}

std::size_t CommandQueue::size() const {
  const std::lock_guard lock(mutex_);
  return count_;
}

CommandQueue::LaneKey CommandQueue::keyOf(const core::Sender& sender) {
  constexpr LaneKey kRequests = LaneKey{1} << 63;
  return sender.session_id != 0 ? sender.session_id : kRequests | sender.request_id;
}

Command CommandQueue::pop(Lane& lane) {
  Command out = std::move(lane.entries.front().command);
  lane.entries.pop_front();
  lane.heavy_count -= isHeavy(out) ? 1 : 0;
  --count_;
  return out;
}

void CommandQueue::takeEqual(const v1::Command& command, Batch& out) {
  if (!traitsOf(command).is_shared) return;
  for (const LaneKey key : std::deque(turns_)) {
    Lane& lane = lanes_.at(key);
    while (!lane.entries.empty() && isEqual(command, lane.entries.front().command.message)) out.push_back(pop(lane));
    tidy(key);
  }
}

void CommandQueue::tidy(LaneKey key) {
  const auto lane = lanes_.find(key);
  if (lane == lanes_.end() || !lane->second.entries.empty()) return;
  std::erase(turns_, key);
  if (!lane->second.is_held) lanes_.erase(lane);
}

}  // namespace spindrift::rooms
