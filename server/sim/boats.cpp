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
/// The number of a boat's state that tells whether another program moves it.
constexpr std::size_t kMovedFloat = 22;
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
  countMoved();
}

void Boats::takeOver(const CarriedBoats& carried) {
  places_ = carried.places;
  first_id_ = carried.first_id;
  next_id_ = carried.next_id;
  uploadControls();
  countMoved();
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
  countMoved();
  return {};
}

// Boats that another program moves

core::Result<void> Boats::prepareMoved(Creation& create) {
  if (moved_) return {};
  auto made = std::make_unique<MovedHulls>(create, slot_count_);
  if (!create.error()) moved_ = std::move(made);
  return create.result();
}

core::Result<void> Boats::place(const HullMotion& motion, Wave& wave) {
  const auto at = find(motion.boat_id);
  if (!at) return at.error();
  pressOne(*at, -1, wave);
  const auto f = [](double v) { return static_cast<float>(v); };
  const double forward_x = std::cos(motion.heading_rad), forward_z = std::sin(motion.heading_rad);
  const std::size_t begin = *at * sizeof(State);
  state_.upload(std::array<float, 6>{f(motion.x_m), f(motion.y_m), f(motion.z_m),
                                     f(std::remainder(motion.heading_rad, 2 * std::numbers::pi)), f(motion.pitch_rad),
                                     f(motion.roll_rad)},
                begin);
  state_.upload(std::array<float, 6>{f(motion.velocity_x_mps * forward_x + motion.velocity_z_mps * forward_z),
                                     f(motion.velocity_z_mps * forward_x - motion.velocity_x_mps * forward_z),
                                     f(motion.velocity_y_mps), f(motion.yaw_rate_radps), f(motion.pitch_rate_radps),
                                     f(motion.roll_rate_radps)},
                begin + 8 * sizeof(float));
  core::Boat& boat = places_[*at].boat;
  if (boat.throttle_ratio != 0.0 || boat.rudder_ratio != 0.0) {
    boat.throttle_ratio = boat.rudder_ratio = 0.0;
    uploadControls();
  }
  setMoved(*at, kMovedFor_s);
  pressOne(*at, 1, wave);
  return {};
}

core::Result<void> Boats::release(std::uint32_t boat_id, Wave& wave) {
  const auto at = find(boat_id);
  if (!at) return at.error();
  if (places_[*at].moved_left_s == 0.0) return {};
  pressOne(*at, -1, wave);
  setMoved(*at, 0.0);
  pressOne(*at, 1, wave);
  return {};
}

void Boats::setMoved(std::size_t at, double left_s) {
  const bool was_moved = places_[at].moved_left_s > 0.0;
  places_[at].moved_left_s = left_s;
  if (was_moved != (left_s > 0.0))
    state_.uploadValue(left_s > 0.0 ? 1.0f : 0.0f, at * sizeof(State) + kMovedFloat * sizeof(float));
  countMoved();
}

void Boats::countMoved() {
  moved_count_ =
      static_cast<std::size_t>(std::ranges::count_if(places_, [](const BoatPlace& p) { return p.moved_left_s > 0.0; }));
}

void Boats::pressOne(std::size_t at, int sign, Wave& wave) {
  bind();
  wave.bindTerrain();
  wave.pressureHead().bindStorage(PRESSURE_HEAD);
  moved_->press.setUniform("first_place", static_cast<std::int32_t>(at));
  moved_->press.setUniform("head_sign", std::int32_t{sign});
  moved_->press.run(pressedCells(), pressedCells(), 1);
}

void Boats::feel(Wave& wave, bool begins) {
  if (!anyMoved()) return;
  if (begins) moved_->begin();
  bind();
  moved_->feel(wave, controls_.place_count);
}

void Boats::endMovedTick(Wave& wave, std::uint64_t tick, double tick_s, double water_kgpm3) {
  if (!anyMoved()) return;
  bind();
  moved_->drag(wave);
  std::vector<std::uint32_t> boat_ids(controls_.place_count);
  for (std::size_t at = 0; at < boat_ids.size(); ++at)
    if (places_[at].moved_left_s > 0.0) boat_ids[at] = places_[at].boat_id;
  moved_->submit(tick, std::move(boat_ids), water_kgpm3);
  for (std::size_t at = 0; at < places_.size(); ++at) {
    if (places_[at].moved_left_s == 0.0) continue;
    const double left_s = places_[at].moved_left_s - tick_s;
    setMoved(at, left_s > 0.5 * tick_s ? left_s : 0.0);
  }
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
    places_[at].moved_left_s = 0.0;
  }
  countMoved();
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
  if (anyMoved()) moved_->bindForces();
  (anyMoved() ? moved_->drift : drift_).runGroups(1);
  if (push_) push_.clear();
  (anyMoved() ? moved_->kick : kick_).runGroups(controls_.place_count);
}

std::uint32_t Boats::pressedCells() const {
  double reach_m = 0.0;
  for (const BoatPlace& place : places_) {
    if (place.boat_id == 0) continue;
    reach_m = std::max(
        reach_m, HULL_REACH * 0.5 *
                     std::hypot(std::max(place.boat.length_m, 3 * cell_m_), std::max(place.boat.beam_m, 3 * cell_m_)));
  }
  return static_cast<std::uint32_t>(2 * std::ceil(reach_m / cell_m_)) + 3;
}

void Boats::press(Wave& wave) {
  if (controls_.place_count == 0) return;
  bind();
  wave.pressureHead().bindStorage(PRESSURE_HEAD);
  Pass& pass = anyMoved() ? moved_->press : press_;
  if (anyMoved()) {
    wave.bindTerrain();
    pass.setUniform("first_place", std::int32_t{0});
    pass.setUniform("head_sign", std::int32_t{1});
  }
  pass.run(pressedCells(), pressedCells(), controls_.place_count);
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
