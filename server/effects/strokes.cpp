#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <spindrift/effects/strokes.h>

namespace spindrift::sim {
namespace {

/// Delay between a point's arrival and its drawing that the play clock aims at.
constexpr double kDelay_s = 0.05;
/// A dent takes this long from nothing to its full depth, and back.
constexpr double kPress_s = 0.12;

/// A stroke moves less water where the surface is farther than this many times its depth from its rest, and none from
/// twice that on.
constexpr double kHighestDepths = 2.0;

/// Pace of the play clock: slower while points run short, faster while they pile up, as in a room that is slower than
/// the clock of its clients.
double paceOf(double waiting_s) {
  if (waiting_s < 0.4 * kDelay_s) return 0.75;
  if (waiting_s < 2.5 * kDelay_s) return 1.0;
  if (waiting_s < 5 * kDelay_s) return 1.25;
  return waiting_s < 10 * kDelay_s ? 2.0 : 4.0;
}

StrokePoint mixed(const StrokePoint& a, const StrokePoint& b, double time_s) {
  const double t = (time_s - a.time_s) / (b.time_s - a.time_s);
  return {time_s, std::lerp(a.x_m, b.x_m, t), std::lerp(a.z_m, b.z_m, t),
          std::lerp(a.pressure_ratio, b.pressure_ratio, t)};
}

/// Moves the play clock and drops what has been drawn. Returns the finger's position and pressure.
StrokePoint play(Stroke& stroke, double dt_s) {
  std::vector<StrokePoint>& path = stroke.path;
  const double newest_s = path.back().time_s;
  double waiting_s = newest_s - stroke.play_s;
  const double most_s = stroke.is_whole ? Strokes::kMaxWholeDelay_s : Strokes::kMaxDelay_s;
  if (waiting_s > most_s) stroke.play_s = newest_s - (waiting_s = most_s);
  const double pace = stroke.is_whole ? 1.0 : stroke.is_lifted ? std::max(paceOf(waiting_s), 1.0) : paceOf(waiting_s);
  stroke.play_s = std::min(stroke.play_s + pace * dt_s, newest_s);
  const auto next = std::ranges::upper_bound(path, stroke.play_s, {}, &StrokePoint::time_s);
  if (next == path.begin()) return path.front();  // the delay before the first point
  path.erase(path.begin(), next - 1);
  return path.size() == 1 ? path.front() : mixed(path[0], path[1], stroke.play_s);
}

/// Number of fingers at the place of one, counting those near it in part.
double crowdAt(const Stroke& stroke, const std::vector<Stroke>& all) {
  double count = 0.0;
  for (const Stroke& other : all) {
    const double away_m = std::hypot(other.x_m - stroke.x_m, other.z_m - stroke.z_m);
    count += std::max(0.0, 1.0 - away_m / (other.radius_m + stroke.radius_m));
  }
  return count;  // at least 1: itself
}

void press(const Stroke& stroke, double gain, shared::EventUniforms& out) {
  shared::EventUniform& splash = out.splashes[out.splash_count++];
  splash = {};
  splash.gain_m = static_cast<float>(-stroke.depth_m * gain);
  splash.x_m = static_cast<float>(stroke.x_m);
  splash.z_m = static_cast<float>(stroke.z_m);
  splash.radius_m = static_cast<float>(stroke.radius_m);
  splash.depth_m = static_cast<float>(stroke.depth_m);
  splash.highest_m = static_cast<float>(kHighestDepths * stroke.depth_m);
}

}  // namespace

core::Result<void> Strokes::add(const StrokePart& part) {
  const auto isOfPerson = [&](const Stroke& stroke) { return stroke.person_id == part.person_id && !stroke.is_lifted; };
  auto stroke = std::ranges::find_if(
      active_, [&](const Stroke& each) { return isOfPerson(each) && each.stroke_id == part.stroke_id; });
  if (stroke == active_.end()) {
    if (part.points.empty()) return {};  // the end of a stroke that has ended by itself
    const auto own_count = static_cast<std::size_t>(std::ranges::count_if(active_, isOfPerson));
    if (active_.size() >= kMaxCount || own_count >= kPersonMaxCount) {
      const bool is_own = own_count >= kPersonMaxCount;
      return core::Error{
          core::ErrorCode::kUnavailable,
          fmt::format("the limit of {} strokes {} is reached: try again when a finger has been lifted",
                      is_own ? kPersonMaxCount : kMaxCount, is_own ? "of one person" : "at the same time")};
    }
    const StrokePoint& first = part.points.front();
    active_.push_back({.person_id = part.person_id,
                       .stroke_id = part.stroke_id,
                       .radius_m = part.radius_m,
                       .depth_m = part.depth_m,
                       .path = {first},
                       .is_whole = part.ends,
                       .play_s = first.time_s - kDelay_s,
                       .x_m = first.x_m,
                       .z_m = first.z_m});
    stroke = active_.end() - 1;
  }
  for (const StrokePoint& point : part.points)
    if (point.time_s > stroke->path.back().time_s) stroke->path.push_back(point);
  if (stroke->path.size() > kPathMaxCount)
    stroke->path.erase(stroke->path.begin(), stroke->path.end() - static_cast<std::ptrdiff_t>(kPathMaxCount));
  stroke->is_lifted = part.ends;
  stroke->still_s = 0.0;
  return {};
}

void Strokes::advance(double dt_s, shared::EventUniforms& out) {
  auto next = active_.begin();
  for (; next != active_.end() && out.splash_count + 2 <= MAX_PRESSES; ++next) {
    Stroke& stroke = *next;
    const StrokePoint at = play(stroke, dt_s);
    stroke.still_s += dt_s;
    stroke.is_lifted = stroke.is_lifted || stroke.still_s > kMaxSilence_s;
    const bool is_over = stroke.is_lifted && stroke.play_s >= stroke.path.back().time_s;
    const double way_m = std::hypot(at.x_m - stroke.x_m, at.z_m - stroke.z_m);
    // A finger that is faster than a radius per step would press a row of separate dents: it presses less. So do
    // fingers at one place: together they press as one.
    const double most_ratio = std::min(1.0, stroke.radius_m / std::max(way_m, 1e-9)) / crowdAt(stroke, active_);
    const double wanted = is_over ? 0.0 : at.pressure_ratio * most_ratio;
    const double most = dt_s / kPress_s;
    const double level = stroke.level_ratio + std::clamp(wanted - stroke.level_ratio, -most, most);
    if (way_m == 0.0) {
      if (level != stroke.level_ratio) press(stroke, level - stroke.level_ratio, out);
    } else {
      if (stroke.level_ratio > 0.0) press(stroke, -stroke.level_ratio, out);
      stroke.x_m = at.x_m;
      stroke.z_m = at.z_m;
      if (level > 0.0) press(stroke, level, out);
    }
    stroke.level_ratio = level;
  }
  std::rotate(active_.begin(), next, active_.end());  // the others come first in the next step
  std::erase_if(active_, [](const Stroke& stroke) {
    return stroke.is_lifted && stroke.level_ratio <= 0.0 && stroke.play_s >= stroke.path.back().time_s;
  });
}

bool Strokes::resume(std::vector<Stroke> active) {
  const bool is_valid = active.size() <= kMaxCount && std::ranges::all_of(active, [](const Stroke& stroke) {
                          return !stroke.path.empty() && stroke.path.size() <= kPathMaxCount;
                        });
  if (is_valid) active_ = std::move(active);
  return is_valid;
}

}  // namespace spindrift::sim
