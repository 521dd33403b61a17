#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include <spindrift/core/random.h>
#include <spindrift/effects/strokes.h>

namespace spindrift::sim {
namespace {

/// Delay between a point's arrival and its drawing that the play clock aims at.
constexpr double kDelay_s = 0.05;
/// A dent takes this long from nothing to its full depth, and back.
constexpr double kPress_s = 0.12;

/// This many fingers press with their whole depth. The waves of n fingers are sqrt(n) times as high as those of one:
/// where there are more, each presses less, so that a class makes no higher waves than these few.
constexpr double kFullFingers = 3.0;

/// A stroke moves less water where the surface is farther than this many times its depth from its rest, and none from
/// twice that on.
constexpr double kHighestDepths = 2.0;
/// The same for drops, in their radii: rain falls on waves, too.
constexpr double kRainHighestRadii = 2.0;

/// Drops per second under a cloud at full pressure, and their largest depth as a share of their radius.
constexpr double kRainPerS = 90.0;
constexpr double kDropDepthRadii = 0.5;
/// A stroke adds at most this many splashes per step.
constexpr std::uint32_t kStepSplashMaxCount = 2;

/// A calmed disc takes this share of the flow per second at full pressure. Critical for waves of 1.3 s; shorter and
/// longer ones decay more slowly.
constexpr double kCalmPerS = 10.0;

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

/// Number of fingers with the same tool at the position of one, counting those near it in part.
double crowdAt(const Stroke& stroke, const std::vector<Stroke>& all) {
  double count = 0.0;
  for (const Stroke& other : all) {
    if (other.tool != stroke.tool) continue;
    const double away_m = std::hypot(other.x_m - stroke.x_m, other.z_m - stroke.z_m);
    count += std::max(0.0, 1.0 - away_m / (other.radius_m + stroke.radius_m));
  }
  return count;  // at least 1: itself
}

struct Dent {
  double x_m = 0.0;
  double z_m = 0.0;
  double radius_m = 0.0;
  double depth_m = 0.0;
  double highest_m = 0.0;
};

void press(const Dent& dent, double gain, shared::EventUniforms& out) {
  shared::EventUniform& splash = out.splashes[out.splash_count++];
  splash = {};
  splash.gain_m = static_cast<float>(-dent.depth_m * gain);
  splash.x_m = static_cast<float>(dent.x_m);
  splash.z_m = static_cast<float>(dent.z_m);
  splash.radius_m = static_cast<float>(dent.radius_m);
  splash.depth_m = static_cast<float>(dent.depth_m);
  splash.highest_m = static_cast<float>(dent.highest_m);
}

/// Fills the dent where the finger was, and presses it where the finger is.
void moveDent(Stroke& stroke, const StrokePoint& at, double level, shared::EventUniforms& out) {
  const auto dent = [&] {
    return Dent{stroke.x_m, stroke.z_m, stroke.radius_m, stroke.depth_m, kHighestDepths * stroke.depth_m};
  };
  if (at.x_m == stroke.x_m && at.z_m == stroke.z_m) {
    if (level != stroke.level_ratio) press(dent(), level - stroke.level_ratio, out);
    return;
  }
  if (stroke.level_ratio > 0.0) press(dent(), -stroke.level_ratio, out);
  stroke.x_m = at.x_m;
  stroke.z_m = at.z_m;
  if (level > 0.0) press(dent(), level, out);
}

/// Lets the drops of a step fall, evenly over the cloud's disc. `level`: share of the full rain.
void rain(const Stroke& stroke, double level, const StrokeWater& water, shared::EventUniforms& out) {
  // The play clock stands while points are missing; still_s grows in each step.
  core::SplitMix64 random(std::bit_cast<std::uint64_t>(stroke.play_s) ^
                          std::rotl(std::bit_cast<std::uint64_t>(stroke.still_s), 32) ^
                          (std::uint64_t{stroke.person_id} << 32 | stroke.stroke_id) * 0x2545f4914f6cdd1dull);
  const double expected = std::min(level * kRainPerS * water.dt_s, double{kStepSplashMaxCount});
  auto count = static_cast<std::uint32_t>(expected);
  if (random.unit() < expected - count) ++count;
  const double radius_m = kDropRadius_cells * water.cell_m;
  for (; count > 0; --count) {
    const double away_m = stroke.radius_m * std::sqrt(random.unit());
    const double angle = std::numbers::pi * random.symmetric();
    press({.x_m = stroke.x_m + away_m * std::cos(angle),
           .z_m = stroke.z_m + away_m * std::sin(angle),
           .radius_m = radius_m,
           .depth_m = std::min(stroke.depth_m, kDropDepthRadii * radius_m),
           .highest_m = kRainHighestRadii * radius_m},
          0.5 + 0.5 * random.unit(), out);
  }
}

void calm(const Stroke& stroke, double level, const StrokeWater& water, shared::EventUniforms& out) {
  out.calms[out.calm_count++] = {static_cast<float>(stroke.x_m), static_cast<float>(stroke.z_m),
                                 static_cast<float>(stroke.radius_m),
                                 static_cast<float>(level * (1.0 - std::exp(-kCalmPerS * water.dt_s)))};
}

}  // namespace

core::Result<void> Strokes::add(const StrokePart& part) {
  const auto isOfPerson = [&](const Stroke& stroke) { return stroke.person_id == part.person_id; };
  auto stroke = std::ranges::find_if(active_, [&](const Stroke& each) {
    return isOfPerson(each) && !each.is_lifted && each.stroke_id == part.stroke_id;
  });
  if (stroke == active_.end()) {
    if (part.points.empty()) return {};  // the end of a stroke that has ended by itself
    const auto own_count = static_cast<std::size_t>(std::ranges::count_if(active_, isOfPerson));
    if (active_.size() >= kMaxCount || own_count >= kPersonMaxCount) {
      const bool is_own = own_count >= kPersonMaxCount;
      return core::Error{
          core::ErrorCode::kUnavailable,
          fmt::format("the limit of {} strokes {} is reached: try again when one has ended",
                      is_own ? kPersonMaxCount : kMaxCount, is_own ? "of one person" : "at the same time")};
    }
    const StrokePoint& first = part.points.front();
    active_.push_back({.person_id = part.person_id,
                       .stroke_id = part.stroke_id,
                       .tool = part.tool,
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

void Strokes::advance(const StrokeWater& water, shared::EventUniforms& out) {
  const auto fingers = std::ranges::count(active_, StrokeTool::kFinger, &Stroke::tool);
  const double least_crowd = std::sqrt(std::max(static_cast<double>(fingers) / kFullFingers, 1.0));
  auto next = active_.begin();
  const auto hasRoom = [&] {
    return out.splash_count + kStepSplashMaxCount <= MAX_PRESSES && out.calm_count < MAX_CALMS;
  };
  for (; next != active_.end() && hasRoom(); ++next) {
    Stroke& stroke = *next;
    const StrokePoint at = play(stroke, water.dt_s);
    stroke.still_s += water.dt_s;
    stroke.is_lifted = stroke.is_lifted || stroke.still_s > kMaxSilence_s;
    const bool is_over = stroke.is_lifted && stroke.play_s >= stroke.path.back().time_s;
    const double way_m = std::hypot(at.x_m - stroke.x_m, at.z_m - stroke.z_m);
    // A finger that is faster than a radius per step would press a row of separate dents: it presses less. So do
    // fingers at one place: together they press as one.
    const double crowd = std::max(crowdAt(stroke, active_), stroke.tool == StrokeTool::kFinger ? least_crowd : 1.0);
    const double most_ratio = std::min(1.0, stroke.radius_m / std::max(way_m, 1e-9)) / crowd;
    const double wanted = is_over ? 0.0 : at.pressure_ratio * most_ratio;
    const double most = water.dt_s / kPress_s;
    const double level = stroke.level_ratio + std::clamp(wanted - stroke.level_ratio, -most, most);
    if (stroke.tool == StrokeTool::kFinger) moveDent(stroke, at, level, out);
    stroke.x_m = at.x_m;
    stroke.z_m = at.z_m;
    stroke.level_ratio = level;
    if (stroke.tool == StrokeTool::kRain) rain(stroke, level, water, out);
    if (stroke.tool == StrokeTool::kCalm && level > 0.0) calm(stroke, level, water, out);
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
