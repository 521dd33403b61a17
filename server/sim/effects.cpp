#include "effects.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace spindrift::sim {
namespace {

/// Half width at half height to the e-folding length of a Gaussian: 1 / (2 sqrt(ln 2)).
constexpr double kEFoldPerFullWidth = 0.6005612;
/// A crest starts this many e-folding lengths inside its side, so that its tail does not reach across a periodic one.
constexpr double kCrestInset = 2.0;

double duration(const core::Effect& effect) {
  return std::visit([](const auto& e) { return e.duration_s; }, effect);
}

shared::EventUniform uniformOf(const core::Splash& splash, double gain) {
  shared::EventUniform u{};
  u.kind = EVENT_SPLASH;
  u.gain_m = static_cast<float>(-splash.depth_m * gain);
  u.x_m = static_cast<float>(splash.x_m);
  u.z_m = static_cast<float>(splash.z_m);
  u.radius_m = static_cast<float>(splash.radius_m);
  return u;
}

shared::EventUniform uniformOf(const core::BreakingWave& wave, double gain, double age_s, const WaveLayout& layout) {
  shared::EventUniform u{};
  const double radius_m = wave.length_m * kEFoldPerFullWidth;
  const bool along_x = wave.side == core::Side::kPlusX || wave.side == core::Side::kMinusX;
  const float direction = wave.side == core::Side::kPlusX || wave.side == core::Side::kPlusZ ? -1.0f : 1.0f;
  u.kind = EVENT_CREST;
  u.gain_m = static_cast<float>(wave.amplitude_m * gain);
  u.x_m = along_x ? direction : 0.0f;
  u.z_m = along_x ? 0.0f : direction;
  u.radius_m = static_cast<float>(radius_m);
  u.offset_m = static_cast<float>(-layout.side_m / 2 + kCrestInset * radius_m + layout.speed_mps * age_s);
  u.step_m = static_cast<float>(layout.speed_mps * layout.dt_s);
  u.mean_ratio = static_cast<float>(radius_m * std::sqrt(std::numbers::pi) / layout.side_m);
  return u;
}

}  // namespace

double pulse(double phase) {
  const double t = std::clamp(phase, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

core::Result<void> Effects::start(const core::Effect& effect, double time_s) {
  if (active_.size() >= MAX_EVENTS) {
    return core::Error{
        core::ErrorCode::kUnavailable,
        fmt::format("effects: {} are active, the most there can be: try again when one has ended", MAX_EVENTS)};
  }
  active_.push_back({effect, time_s});
  return {};
}

shared::EventUniforms Effects::advance(double time_s, const WaveLayout& wave) {
  shared::EventUniforms out{};
  for (const Active& a : active_) {
    const double age_s = time_s - a.start_s;
    const double gain = pulse((age_s + wave.dt_s) / duration(a.effect)) - pulse(age_s / duration(a.effect));
    if (gain <= 0.0) continue;
    out.events[out.event_count++] = std::holds_alternative<core::Splash>(a.effect)
                                        ? uniformOf(std::get<core::Splash>(a.effect), gain)
                                        : uniformOf(std::get<core::BreakingWave>(a.effect), gain, age_s, wave);
  }
  std::erase_if(active_, [&](const Active& a) { return time_s + wave.dt_s >= a.start_s + duration(a.effect); });
  return out;
}

}  // namespace spindrift::sim
