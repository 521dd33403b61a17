#include "floaters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <shared/bindings.h>

namespace spindrift::sim {
namespace {

using core::ErrorCode;

/// The device stores ids as 32-bit floats, which are exact for whole numbers up to this one.
constexpr std::uint32_t kIdMax = 1u << 24;
/// A step of contacts lasts at most this long, unless a tick would have too many.
constexpr double kContactStep_s = 0.0084;
constexpr int kMaxContactSteps = 8;
constexpr double kDensityMin = 0.02;  ///< scene rules ask for as much; states of other servers may not

using FloaterState = std::array<float, std::size_t{FLOATER_TEXELS} * 4>;

FloaterState freeSlot() {
  FloaterState out{};
  out[3] = -1.0f;
  return out;
}

/// Shape and mass of a kind of size 1.
struct Kind {
  int shape;
  std::array<double, 3> half;  ///< along x, y, z
  double density_ratio;
  double ballast_ratio;  ///< as core::Floater::ballast_ratio
};

Kind kindOf(core::FloaterKind kind) {
  switch (kind) {
    case core::FloaterKind::kBall:
      return {FLOATER_SPHERE, {0.5, 0.5, 0.5}, 0.1, 0.0};
    case core::FloaterKind::kBarrel:
      return {FLOATER_CYLINDER_X, {0.5, 0.33, 0.33}, 0.5, 0.0};
    case core::FloaterKind::kPlank:
      return {FLOATER_BOX, {0.5, 0.04, 0.12}, 0.55, 0.0};
    case core::FloaterKind::kDuck:
      return {FLOATER_SPHERE, {0.4, 0.4, 0.4}, 0.25, -0.5};
    case core::FloaterKind::kBuoy:
      return {FLOATER_CYLINDER_Y, {0.3, 0.5, 0.3}, 0.45, -0.5};
    case core::FloaterKind::kRaft:
      return {FLOATER_BOX, {0.5, 0.06, 0.35}, 0.45, 0.0};
    case core::FloaterKind::kStone:
      return {FLOATER_SPHERE, {0.5, 0.5, 0.5}, 2.6, 0.0};
    case core::FloaterKind::kCrate:
      break;
  }
  return {FLOATER_BOX, {0.5, 0.5, 0.5}, 0.4, -0.35};
}

FloaterState startingFloater(const core::Floater& floater, std::uint32_t floater_id) {
  const auto f = [](double v) { return static_cast<float>(v); };
  const Kind kind = kindOf(floater.kind);
  const double ballast_m =
      std::clamp(kind.ballast_ratio + floater.ballast_ratio, -1.0, 1.0) * kind.half[1] * floater.size_m;
  const double half_turn_rad = -0.5 * floater.heading_deg * std::numbers::pi / 180.0;
  FloaterState s{};
  s[0] = f(floater.x_m);
  s[1] = f(floater.y_m + ballast_m);
  s[2] = f(floater.z_m);
  s[5] = f(std::sin(half_turn_rad));
  s[7] = f(std::cos(half_turn_rad));
  s[8] = f(floater.velocity_x_mps);
  s[9] = f(floater.velocity_y_mps);
  s[10] = f(floater.velocity_z_mps);
  s[11] = f(floater_id);
  for (std::size_t axis = 0; axis < 3; ++axis) s[16 + axis] = f(kind.half[axis] * floater.size_m);
  s[19] = f(kind.shape + 8 * (static_cast<int>(floater.kind) + 1));
  s[20] = f(floater.density_ratio > 0 ? std::max(floater.density_ratio, kDensityMin) : kind.density_ratio);
  s[21] = f(ballast_m);
  s[22] = f(floater.size_m);
  return s;
}

int contactSteps(double tick_s) {
  return std::min(static_cast<int>(std::ceil(tick_s / kContactStep_s)), kMaxContactSteps);
}

}  // namespace

Floaters::Floaters(Creation& create, const core::Scene& scene)
    : places_(std::min<std::size_t>(scene.floaters->capacity_count, core::kMaxFloaters)),
      own_count_(static_cast<std::uint32_t>(scene.floaters->floaters.size())),
      state_(create.texels("floaters", places_.size() * FLOATER_TEXELS, gpu::TexelFormat::kRGBA32F)),
      reach_(create.scratch("floater places", places_.size(), gpu::TexelFormat::kRGBA32F)),
      tiles_(
          create.buffer("floater tiles",
                        std::size_t{FLOATER_TILES_PER_AXIS} * FLOATER_TILES_PER_AXIS * ((places_.size() + 31) / 32) * 4,
                        gpu::BufferContent::kScratch)),
      near_(create.buffer("floater neighbours", places_.size() * FLOATER_NEAR_WORDS * 4, gpu::BufferContent::kScratch)),
      push_(create.buffer("floater push", places_.size() * 8 * 4)),
      mark_tiles_(create.pass("bodies/floater_tiles.comp")),
      find_near_(create.pass("bodies/floater_near.comp")),
      contacts_(create.pass("bodies/floater_contacts.comp")),
      move_(create.pass("bodies/floater_move.comp")),
      water_(create.pass("bodies/floater_water.comp")),
      press_(create.pass("bodies/floater_press.comp")) {
  if (scene.particles) {
    count_hits_ = create.pass("bodies/floater_hits.comp", {{"HITS", "0"}});
    hits_ = create.pass("bodies/floater_hits.comp", {{"HITS", "1"}});
    recoil_ = create.pass("bodies/floater_recoil.comp");
  }
  if (scene.floaters->floaters.size() > places_.size()) {
    create.fail(core::invalid(
        fmt::format("floaters.floaters: {} objects are more than floaters.capacity_count = {}: remove some or raise it",
                    scene.floaters->floaters.size(), places_.size())));
  }
}

void Floaters::declareState(StateBuffers& out) {
  out.push_back({.buffer = &state_, .carried = true});
  out.push_back({.buffer = &push_, .lasts = false});
}

void Floaters::reset(const core::Scene& scene) {
  std::vector<FloaterState> states(places_.size(), freeSlot());
  std::ranges::fill(places_, FloaterPlace{});
  std::uint32_t floater_id = 1;
  // The constructor has checked that there are enough slots.
  for (std::size_t at = 0; at < scene.floaters->floaters.size(); ++at, ++floater_id) {
    places_[at] = {floater_id, scene.floaters->floaters[at]};
    states[at] = startingFloater(places_[at].floater, floater_id);
  }
  next_id_ = next_id_ > kIdMax ? floater_id : std::max(next_id_, floater_id);
  state_.upload(states);
  countSlots();
}

void Floaters::takeOver(const CarriedFloaters& carried) {
  places_ = carried.places;
  next_id_ = carried.next_id;
  countSlots();
}

core::Result<std::size_t> Floaters::find(std::uint32_t floater_id) const {
  const auto it = std::ranges::find(places_, floater_id, &FloaterPlace::floater_id);
  if (floater_id == 0 || it == places_.end())
    return core::invalid(fmt::format(
        "{} is not in the water: it was taken out, or the scene began again; see the layer of floaters", floater_id));
  return static_cast<std::size_t>(it - places_.begin());
}

core::Result<std::uint32_t> Floaters::spawn(const core::Floater& floater) {
  if (next_id_ > kIdMax) {
    return core::Error{ErrorCode::kUnavailable,
                       fmt::format("floaters: the limit of {} objects dropped in a room is reached; reset it", kIdMax)};
  }
  auto place = std::ranges::find(places_, 0u, &FloaterPlace::floater_id);
  if (place == places_.end()) {
    // Stones first, then what was dropped, the oldest first; the scene's own last.
    const auto order = [&](const FloaterPlace& p) {
      const bool is_own = p.floater_id <= own_count_;
      return std::pair(is_own ? 2 : (p.floater.kind == core::FloaterKind::kStone ? 0 : 1), p.floater_id);
    };
    place = std::ranges::min_element(places_, {}, order);
    if (place->floater_id <= own_count_) {
      return core::Error{
          ErrorCode::kUnavailable,
          fmt::format("floaters: the limit of {} objects is reached, and all of them are the scene's own; "
                      "remove one first",
                      places_.size())};
    }
  }
  put(static_cast<std::size_t>(place - places_.begin()), next_id_, floater);
  countSlots();
  return next_id_++;
}

void Floaters::put(std::size_t slot, std::uint32_t floater_id, const core::Floater& floater) {
  places_[slot] = {floater_id, floater};
  state_.upload(startingFloater(floater, floater_id), slot * sizeof(FloaterState));
}

core::Result<void> Floaters::hold(const FloaterHold& hold) {
  const auto at = find(hold.floater_id);
  if (!at) return at.error();
  const auto f = [](double v) { return static_cast<float>(v); };
  const std::array<float, 4> pull{f(hold.x_m), f(hold.lift_m), f(hold.z_m), hold.ends ? 0.0f : FLOATER_HOLD_S};
  constexpr std::size_t kTexelBytes = 4 * sizeof(float);
  state_.upload(pull, *at * sizeof(FloaterState) + 6 * kTexelBytes);
  state_.uploadValue(f(hold.turn_radps), *at * sizeof(FloaterState) + 7 * kTexelBytes + 3 * sizeof(float));
  return {};
}

core::Result<void> Floaters::remove(std::uint32_t floater_id) {
  const auto at = find(floater_id);
  if (!at) return at.error();
  places_[*at] = {};
  state_.upload(freeSlot(), *at * sizeof(FloaterState));
  countSlots();
  return {};
}

void Floaters::removeAll() {
  std::ranges::fill(places_, FloaterPlace{});
  state_.upload(std::vector<FloaterState>(places_.size(), freeSlot()));
  countSlots();
}

void Floaters::countSlots() {
  slot_count_ = 0;
  for (std::size_t at = 0; at < places_.size(); ++at)
    if (places_[at].floater_id != 0) slot_count_ = static_cast<std::uint32_t>(at + 1);
}

void Floaters::mend() {
  const auto states = state_.downloadVector<float>(places_.size() * FLOATER_TEXELS * 4);
  for (std::size_t at = 0; at < places_.size(); ++at) {
    if (places_[at].floater_id == 0) continue;
    const auto own = std::span(states).subspan(at * FLOATER_TEXELS * 4, FLOATER_TEXELS * 4);
    if (std::ranges::all_of(own, [](float x) { return std::isfinite(x); })) continue;
    put(at, places_[at].floater_id, places_[at].floater);
  }
}

void Floaters::move(double tick_s, const Wave& wave, Boats* boats) {
  if (slot_count_ == 0) return;
  wave.bindTerrain();
  if (boats) {
    boats->bind();
    boats->bindPush();
  }
  bind();
  tiles_.clear();
  reach_.bindStorage(FLOATER_PLACES);
  tiles_.bindStorage(FLOATER_TILES);
  near_.bindStorage(FLOATER_NEAR);
  mark_tiles_.run(slot_count_);
  reach_.bindTexel(FLOATER_PLACES);
  find_near_.run(slot_count_);
  const int steps = contactSteps(tick_s);
  for (Pass* pass : {&contacts_, &move_}) pass->setUniform("step_s", static_cast<float>(tick_s / steps));
  push_.bindStorage(FLOATER_PUSH);
  for (int step = 0; step < steps; ++step) {
    for (Pass* pass : {&contacts_, &move_}) {
      if (pass == &move_) state_.bindStorage(FLOATERS);
      pass->run(slot_count_);
    }
  }
}

void Floaters::meetParticles(double moved_s, const ParticleBuffers& particles, const Population& population) {
  if (slot_count_ == 0) return;
  bind();
  reach_.bindTexel(FLOATER_PLACES);
  tiles_.bindStorage(FLOATER_TILES);
  push_.bindStorage(FLOATER_PUSH);
  particles.position.bindStorage(POSITION);
  particles.velocity.bindStorage(VELOCITY);
  for (Pass* pass : {&count_hits_, &hits_}) {
    pass->setUniform("moved_s", static_cast<float>(moved_s));
    population.forParticles(*pass);
  }
  state_.bindStorage(FLOATERS);
  recoil_.run(slot_count_);
}

void Floaters::feel(double tick_s, Wave& wave) {
  if (slot_count_ == 0) return;
  wave.bindSurface();
  wave.bindTerrain();
  wave.pressureHead().bindTexel(PRESSURE_HEAD);
  near_.bindStorage(FLOATER_NEAR);
  state_.bindStorage(FLOATERS);
  const int steps = contactSteps(tick_s);
  water_.setUniform("lead_s", static_cast<float>(tick_s * (steps - 1) / (2.0 * steps)));
  water_.run(slot_count_);
}

void Floaters::press(const gpu::TexelBuffer& pressure_head) {
  if (slot_count_ == 0) return;
  bind();
  pressure_head.bindStorage(PRESSURE_HEAD);
  press_.runGroups(slot_count_);
}

void Floaters::bind() const {
  state_.bindTexel(FLOATERS);
}

std::uint32_t Floaters::count() const {
  return static_cast<std::uint32_t>(
      std::ranges::count_if(places_, [](const FloaterPlace& p) { return p.floater_id != 0; }));
}

}  // namespace spindrift::sim
