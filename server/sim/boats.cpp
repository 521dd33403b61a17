#include "boats.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include <fmt/format.h>
#include <shared/bindings.h>

namespace spindrift::sim {
namespace {

using core::Error;
using core::ErrorCode;

constexpr float kNobody = -1.0f;
/// The device stores ids as 32-bit floats, which are exact for whole numbers up to this one.
constexpr std::uint32_t kBoatIdMax = 1u << 24;

using State = std::array<float, std::size_t{BOAT_TEXELS} * 4>;

State startingState(const core::Boat& boat, std::uint32_t boat_id) {
  const auto f = [](double v) { return static_cast<float>(v); };
  const double draught_m = boat.density_ratio * boat.height_m;
  State s{};
  s[0] = f(boat.x_m);
  s[1] = f(boat.height_m / 2 - draught_m);
  s[2] = f(boat.z_m);
  s[3] = f(boat.heading_deg * std::numbers::pi / 180.0);
  s[7] = f(boat_id);
  s[14] = f(boat.throttle_ratio);
  s[15] = f(boat.rudder_ratio);
  s[16] = f(boat.length_m);
  s[17] = f(boat.beam_m);
  s[18] = f(boat.height_m);
  s[19] = f(draught_m);
  s[20] = f(boat.max_speed_mps);
  return s;
}

}  // namespace

Boats::Boats(Creation& create, const core::Scene& scene, double cell_m)
    : cell_m_(cell_m),
      places_(std::min<std::size_t>(scene.boats->capacity_count, MAX_BOATS)),
      slot_count_(std::max<std::size_t>(places_.size(), MIN_BOAT_SLOTS)),
      state_(create.texels("boats", slot_count_ * BOAT_TEXELS, gpu::TexelFormat::kRGBA32F)),
      control_uniforms_(create.uniforms<shared::BoatControls>("boat controls")),
      drift_(create.pass("bodies/drift.comp")),
      kick_(create.pass("bodies/kick.comp")) {
  static_assert(core::kMaxBoats == MAX_BOATS);
  if (scene.floaters) push_ = create.buffer("boat push", slot_count_ * 2 * 4);
  if (scene.wave) press_ = create.pass("bodies/press.comp");
  if (scene.boats->boats.size() > scene.boats->capacity_count) {
    create.fail(core::invalid(
        fmt::format("boats.boats: {} boats are more than boats.capacity_count = {}: remove some or raise it",
                    scene.boats->boats.size(), scene.boats->capacity_count)));
  }
}

void Boats::declareState(StateBuffers& out) {
  out.push_back({.buffer = &state_, .carried = true});
  if (push_) out.push_back({.buffer = &push_, .lasts = false});
}

void Boats::reset(const core::Scene& scene) {
  std::vector<State> states(slot_count_);
  for (State& state : states) state[6] = kNobody;
  std::ranges::fill(places_, BoatPlace{});
  std::uint32_t boat_id = first_id_;
  // The constructor has checked that there are enough slots.
  for (std::size_t at = 0; at < scene.boats->boats.size(); ++at) {
    places_[at] = {boat_id++, scene.boats->boats[at]};
    states[at] = startingState(places_[at].boat, places_[at].boat_id);
  }
  next_id_ = std::max(next_id_, boat_id);
  state_.upload(states);
  uploadControls();
}

void Boats::takeOver(const CarriedBoats& carried) {
  places_ = carried.places;
  first_id_ = carried.first_id;
  next_id_ = carried.next_id;
  uploadControls();
}

core::Result<std::size_t> Boats::find(std::uint32_t boat_id) const {
  const auto it = std::ranges::find(places_, boat_id, &BoatPlace::boat_id);
  if (boat_id == 0 || it == places_.end())
    return core::invalid(fmt::format("boat_id: {} is not on the water; see the boat list", boat_id));
  return static_cast<std::size_t>(it - places_.begin());
}

core::Result<std::uint32_t> Boats::spawn(const core::Boat& boat) {
  if (next_id_ > kBoatIdMax) {
    return Error{
        ErrorCode::kUnavailable,
        fmt::format("boats: the limit of {} boats launched in a room is reached; open another room", kBoatIdMax)};
  }
  const auto free = std::ranges::find(places_, 0u, &BoatPlace::boat_id);
  if (free == places_.end()) {
    return Error{ErrorCode::kUnavailable,
                 fmt::format("boats: the limit of {} boats is reached; remove a boat first", places_.size())};
  }
  *free = {next_id_, boat};
  state_.upload(startingState(boat, next_id_), static_cast<std::size_t>(free - places_.begin()) * sizeof(State));
  uploadControls();
  return next_id_++;
}

core::Result<void> Boats::control(std::uint32_t boat_id, double throttle_ratio, double rudder_ratio) {
  const auto at = find(boat_id);
  if (!at) return at.error();
  places_[*at].boat.throttle_ratio = std::clamp(throttle_ratio, -1.0, 1.0);
  places_[*at].boat.rudder_ratio = std::clamp(rudder_ratio, -1.0, 1.0);
  uploadControls();
  return {};
}

core::Result<void> Boats::remove(std::uint32_t boat_id) {
  const auto at = find(boat_id);
  if (!at) return at.error();
  places_[*at] = {};
  state_.uploadValue(kNobody, *at * sizeof(State) + 6 * sizeof(float));
  uploadControls();
  return {};
}

void Boats::uploadControls() {
  controls_ = {};
  for (std::size_t at = 0; at < places_.size(); ++at) {
    if (places_[at].boat_id == 0) continue;
    controls_.control[at].throttle_ratio = static_cast<float>(places_[at].boat.throttle_ratio);
    controls_.control[at].rudder_ratio = static_cast<float>(places_[at].boat.rudder_ratio);
    controls_.place_count = static_cast<std::uint32_t>(at + 1);
  }
  control_uniforms_.uploadValue(controls_);
}

void Boats::mend() {
  const auto states = state_.downloadVector<float>(slot_count_ * BOAT_TEXELS * 4);
  for (std::size_t at = 0; at < places_.size(); ++at) {
    if (places_[at].boat_id == 0) continue;
    const auto own = std::span(states).subspan(at * BOAT_TEXELS * 4, BOAT_TEXELS * 4);
    if (std::ranges::all_of(own, [](float x) { return std::isfinite(x); })) continue;
    state_.upload(startingState(places_[at].boat, places_[at].boat_id), at * sizeof(State));
  }
}

void Boats::bind() const {
  state_.bindTexel(BOATS);
  control_uniforms_.bindUniform(BOAT_CONTROLS);
}

void Boats::move(const Wave* wave) {
  if (controls_.place_count == 0) return;
  if (wave) {
    wave->bindSurface();
    wave->bindTerrain();
  }
  bind();
  state_.bindStorage(BOATS);
  if (push_) bindPush();
  drift_.runGroups(1);
  if (push_) push_.clear();
  kick_.runGroups(controls_.place_count);
}

void Boats::press(const gpu::TexelBuffer& pressure_head) {
  if (controls_.place_count == 0) return;
  double reach_m = 0.0;
  for (const BoatPlace& place : places_) {
    if (place.boat_id == 0) continue;
    reach_m = std::max(
        reach_m, HULL_REACH * 0.5 *
                     std::hypot(std::max(place.boat.length_m, 3 * cell_m_), std::max(place.boat.beam_m, 3 * cell_m_)));
  }
  const auto across = static_cast<std::uint32_t>(2 * std::ceil(reach_m / cell_m_)) + 3;
  bind();
  pressure_head.bindStorage(PRESSURE_HEAD);
  press_.run(across, across, controls_.place_count);
}

std::vector<BoatRecord> Boats::records() const {
  std::vector<BoatRecord> out;
  for (const BoatPlace& place : places_) {
    if (place.boat_id == 0) continue;
    const core::Boat& b = place.boat;
    out.push_back({place.boat_id, b.length_m, b.beam_m, b.height_m, b.density_ratio * b.height_m});
  }
  return out;
}

std::uint32_t Boats::count() const {
  return static_cast<std::uint32_t>(std::ranges::count_if(places_, [](const BoatPlace& p) { return p.boat_id != 0; }));
}

}  // namespace spindrift::sim
