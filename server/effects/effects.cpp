#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <spindrift/effects/effects.h>
#include <spindrift/sim_setup/pulse.h>

namespace spindrift::sim {
namespace {

constexpr double kStandardGravity_mps2 = 9.80665;
/// Full width at half height of sech^2(s/w): 2 arcosh(sqrt 2) w.
constexpr double kWidthOfHalfHeight = 1.7627472;
/// A crest starts this many widths inside its side, so that its tail does not cross a periodic side.
constexpr double kCrestInset = 3.0;
/// A breaking crest leans forward: the front has this share of the width, the back the rest. sech^2 of width w has the
/// slope 0.77 A/w at its steepest; at Kennedy's onset (eta_t = 0.65 sqrt(g d), so slope 0.65) w = 1.18 A.
constexpr double kBreakingFrontShare = 0.5;
/// Half length along the crest of a wave group that travels in a given direction, over the side of the water.
constexpr double kGroupLateralShare = 0.3;

double duration(const core::Effect& effect) {
  return std::visit([](const auto& e) { return e.duration_s; }, effect);
}

bool isSplash(const core::Effect& effect) {
  return std::holds_alternative<core::Splash>(effect);
}

/// The crown starts with the speed of a fall through this many times the splash's depth, when the pulse is at its
/// strongest.
constexpr double kCrownFall = 1.1;
/// A splash smaller than this many wave cells is a drop; it has no crown.
constexpr double kCrownRadius_cells = 4.0;

shared::EventUniform uniformOf(const core::Splash& splash, double gain, double strength, const EffectDomain& domain) {
  shared::EventUniform u{};
  u.gain_m = static_cast<float>(-splash.depth_m * gain);
  u.x_m = static_cast<float>(splash.x_m);
  u.z_m = static_cast<float>(splash.z_m);
  u.radius_m = static_cast<float>(splash.radius_m);
  u.depth_m = static_cast<float>(splash.depth_m);
  if (splash.radius_m > kCrownRadius_cells * domain.cell_m)
    u.speed_mps = static_cast<float>(strength * std::sqrt(2 * kCrownFall * kStandardGravity_mps2 * splash.depth_m));
  return u;
}

/// Direction of travel, as a unit vector (x, z).
std::pair<double, double> directionOf(const core::BreakingWave& wave) {
  switch (wave.side.value()) {
    case core::Side::kPlusX:
      return {-1, 0};
    case core::Side::kMinusX:
      return {1, 0};
    case core::Side::kPlusZ:
      return {0, -1};
    case core::Side::kMinusZ:
      return {0, 1};
    case core::Side::kDirection:
      break;
  }
  const double angle = wave.direction_deg * std::numbers::pi / 180.0;
  return {std::cos(angle), std::sin(angle)};
}

/// Speed of a crest sech^2(s/width). The flow under a crest is its elevation times one speed. Where waves disperse,
/// each length has its own, and what does not fit runs backward as a second wave: least energy does with the speed at
/// the crest's mean square wave number, sqrt(0.8)/width.
double crestSpeed(double width_m, const EffectDomain& domain) {
  if (domain.dispersing_depth_m <= 0.0) return domain.speed_mps;
  const double kd = std::sqrt(0.8) / width_m * domain.dispersing_depth_m;
  return domain.speed_mps * std::sqrt(std::tanh(kd) / kd);
}

shared::EventUniform uniformOf(const core::BreakingWave& wave, double gain, double age_s, const EffectDomain& domain) {
  shared::EventUniform u{};
  const double width_m = wave.length_m / kWidthOfHalfHeight;
  const bool breaking = wave.shape == core::WaveShape::kBreaking;
  const double front_m = std::max((breaking ? kBreakingFrontShare : 1.0) * width_m, 1.5 * domain.cell_m);
  const double back_m = std::max(2 * width_m - front_m, front_m);
  const double speed_mps = crestSpeed(0.5 * (front_m + back_m), domain);
  const auto [dx, dz] = directionOf(wave);
  u.gain_m = static_cast<float>(wave.amplitude_m * gain);
  u.direction_x = static_cast<float>(dx);
  u.direction_z = static_cast<float>(dz);
  u.front_m = static_cast<float>(front_m);
  u.back_m = static_cast<float>(back_m);
  const bool group = wave.side == core::Side::kDirection;
  const bool paddled = group && wave.width_m > 0.0;
  const double group_m = paddled ? std::max(wave.width_m / 2, domain.cell_m)
                                 : kGroupLateralShare * std::min(domain.side_x_m, domain.side_z_m);
  u.lateral_m = group ? static_cast<float>(group_m) : 0.0f;
  // A group also needs room for the trough behind it.
  const double inset_m = kCrestInset * (group ? 1.5 * (front_m + back_m) : back_m);
  // A group may travel in any direction: it starts at a distance from the centre that fits into the shorter side.
  const double side_m = group       ? std::min(domain.side_x_m, domain.side_z_m)
                        : dx != 0.0 ? domain.side_x_m
                                    : domain.side_z_m;
  u.half_side_m = paddled ? 0.0f : static_cast<float>(0.5 * side_m);
  const double start_m = paddled ? 0.0 : -side_m / 2 + std::min(inset_m, 0.4 * side_m);
  if (paddled) {
    u.x_m = static_cast<float>(wave.x_m);
    u.z_m = static_cast<float>(wave.z_m);
  }
  u.offset_m = static_cast<float>(start_m + speed_mps * age_s);
  u.half_step_m = static_cast<float>(0.5 * speed_mps * domain.dt_s);
  u.speed_mps = static_cast<float>(speed_mps);
  return u;
}

}  // namespace

EffectDomain domainOf(const WaveLayout& wave) {
  return {wave.length_m, wave.width_m, wave.cell_m, wave.speed_mps, wave.dt_s, wave.dispersing_depth_m};
}

core::Result<void> Effects::start(const core::Effect& effect, double time_s, std::size_t spare) {
  const bool splash = isSplash(effect);
  assert(splash || std::get<core::BreakingWave>(effect).side);
  const auto most = static_cast<std::size_t>(splash ? MAX_SPLASHES : MAX_CRESTS);
  const auto active = static_cast<std::size_t>(
      std::ranges::count_if(active_, [&](const Active& a) { return isSplash(a.effect) == splash; }));
  if (active + spare >= most) {
    return core::Error{core::ErrorCode::kUnavailable,
                       fmt::format("effects: the limit of {} active {} is reached: try again when one has ended",
                                   most - spare, splash ? "splashes" : "waves")};
  }
  active_.push_back({effect, time_s});
  return {};
}

bool Effects::resume(std::vector<Active> active) {
  const auto splashes = std::ranges::count_if(active, [](const Active& a) { return isSplash(a.effect); });
  if (splashes > MAX_SPLASHES || std::ssize(active) - splashes > MAX_CRESTS) return false;
  active_ = std::move(active);
  return true;
}

shared::EventUniforms Effects::advance(double time_s, const EffectDomain& domain) {
  shared::EventUniforms out{};
  for (const Active& a : active_) {
    const double age_s = time_s - a.start_s;
    // The displacement of this step belongs to an interval of time; an error of half a step would cost the leapfrog its
    // second order. A crest also sets the flow of half a step before, so its interval is centred on this time. A splash
    // sets no flow, and the coming step acts on it for a whole step, so its interval ends at this time.
    const double ahead_s = isSplash(a.effect) ? 0.0 : domain.dt_s / 2;
    const double gain =
        pulse((age_s + ahead_s) / duration(a.effect)) - pulse((age_s + ahead_s - domain.dt_s) / duration(a.effect));
    if (gain <= 0.0) continue;
    if (const auto* splash = std::get_if<core::Splash>(&a.effect))
      out.splashes[out.splash_count++] =
          uniformOf(*splash, gain, gain * duration(a.effect) / (1.5 * domain.dt_s), domain);
    else
      out.crests[out.crest_count++] = uniformOf(std::get<core::BreakingWave>(a.effect), gain, age_s, domain);
  }
  std::erase_if(active_, [&](const Active& a) { return time_s >= a.start_s + duration(a.effect); });
  out.press_begin = out.splash_count;
  strokes_.advance({domain.dt_s, domain.cell_m}, out);
  return out;
}

}  // namespace spindrift::sim
