#include <algorithm>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include <spindrift/rooms/command_queue.h>

namespace spindrift::rooms {
namespace {

/// Returns whether both can be carried out as one, regardless of the senders.
bool isEqual(const core::Action& a, const core::Action& b) {
  if (std::holds_alternative<core::Reset>(a)) return std::holds_alternative<core::Reset>(b);
  const auto* change = std::get_if<core::ChangeScene>(&a);
  const auto* other = std::get_if<core::ChangeScene>(&b);
  return change && other && change->name == other->name;
}

bool setsTheSame(const core::Action& a, const core::Action& b) {
  const auto* change = std::get_if<core::SetParameter>(&a);
  const auto* other = std::get_if<core::SetParameter>(&b);
  return change && other && change->path == other->path;
}

}  // namespace

bool isHeavy(const core::Action& action) {
  return std::holds_alternative<core::Reset>(action) || std::holds_alternative<core::ChangeScene>(action) ||
         std::holds_alternative<core::SetParameter>(action) || std::holds_alternative<core::SpawnBoat>(action) ||
         std::holds_alternative<core::RemoveBoat>(action);
}

std::optional<std::string> CommandQueue::tryPush(core::Command command, TimePoint now) {
  const std::lock_guard lock(mutex_);
  if (count_ >= bounds_.max_count)
    return fmt::format("{} commands wait for this room, as many as may: try again", bounds_.max_count);
  const LaneKey key = keyOf(command.sender);
  Lane& lane = lanes_[key];
  const bool is_heavy = isHeavy(command.action);
  if (lane.entries.size() >= bounds_.lane_max_count)
    return fmt::format("{} of your commands wait, as many as may: try again when they are answered",
                       bounds_.lane_max_count);
  if (is_heavy && lane.heavy_count >= bounds_.lane_heavy_max_count)
    return fmt::format(
        "{} of your resets, scenes, parameters and boats wait, as many as may: try again when they are answered",
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
    const core::Action& action = lane.entries.front().command.action;
    if (lane.is_held) return false;
    if (std::holds_alternative<core::ChangeScene>(action)) return allowed.heavy && allowed.scene_change;
    return allowed.heavy || !isHeavy(action);
  };
  const auto turn = std::ranges::find_if(turns_, may_go);
  if (turn == turns_.end()) return std::nullopt;
  const LaneKey key = *turn;
  turns_.erase(turn);
  turns_.push_back(key);
  Lane& lane = lanes_.at(key);
  Batch out;
  out.push_back(pop(lane));
  const core::Action action = out.front().action;
  while (!lane.entries.empty() && setsTheSame(action, lane.entries.front().command.action)) out.push_back(pop(lane));
  tidy(key);
  takeEqual(action, out);
  return out;
}

void CommandQueue::hold(const Batch& batch) {
  const std::lock_guard lock(mutex_);
  for (const core::Command& command : batch) lanes_[keyOf(command.sender)].is_held = true;
}

void CommandQueue::release(const Batch& batch) {
  const std::lock_guard lock(mutex_);
  for (const core::Command& command : batch) {
    const LaneKey key = keyOf(command.sender);
    lanes_[key].is_held = false;
    tidy(key);
  }
}

CommandQueue::Batch CommandQueue::takeEqual(const core::Action& action) {
  const std::lock_guard lock(mutex_);
  Batch out;
  takeEqual(action, out);
  return out;
}

CommandQueue::Batch CommandQueue::takeExpired(TimePoint now) {
  const std::lock_guard lock(mutex_);
  Batch out;
  const auto is_expired = [&](const Lane& lane) {
    if (lane.entries.empty() || lane.is_held) return false;
    const Entry& first = lane.entries.front();
    return isHeavy(first.command.action) && now - first.arrived > bounds_.heavy_wait_max;
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

core::Command CommandQueue::pop(Lane& lane) {
  core::Command out = std::move(lane.entries.front().command);
  lane.entries.pop_front();
  lane.heavy_count -= isHeavy(out.action) ? 1 : 0;
  --count_;
  return out;
}

void CommandQueue::takeEqual(const core::Action& action, Batch& out) {
  if (!isEqual(action, action)) return;  // Kinds that never equal another command.
  for (const LaneKey key : std::deque(turns_)) {
    Lane& lane = lanes_.at(key);
    while (!lane.entries.empty() && isEqual(action, lane.entries.front().command.action)) out.push_back(pop(lane));
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
