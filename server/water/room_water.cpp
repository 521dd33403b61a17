#include <cassert>
#include <utility>

#include <fmt/format.h>

#include <spindrift/scene/parameters.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/scene/scene_rules.h>
#include <spindrift/sim_setup/ground.h>
#include <spindrift/water/room_water.h>
#include <spindrift/water/water_state.h>

namespace spindrift::water {
namespace {

/// Makes the rejection for a change that a running room cannot take. `wanted`: its scene after `change`.
wire::CommandRejection whyNot(const v1::SetParameter& change, core::Scene wanted, const core::Error& error) {
  // The message begins with the field that breaks a rule; leave it out if Reject.field has it already.
  const std::string own = change.path() + ": ";
  const std::string message = error.message.starts_with(own) ? error.message.substr(own.size()) : error.message;
  const auto reason = [&] {
    if (error.code == core::ErrorCode::kUnavailable) return v1::REJECT_REASON_BUSY;
    // If the changed scene can be started afresh, the room only lacks its buffers or programs.
    if (sim::derive(wanted)) return v1::REJECT_REASON_NEEDS_RESTART;
    wanted.allow_unstable = true;
    wanted.fixed_substeps_count = 1;
    return sim::derive(wanted) ? v1::REJECT_REASON_BREAKS_STEP_RULE : v1::REJECT_REASON_OUT_OF_RANGE;
  };
  return wire::rejection(reason(), change.path(), message);
}

/// Returns the rejection with `reason`, or BUSY, if the water did not take a command.
template <typename T>
RoomWater::Outcome outcomeOf(const core::Result<T>& done, std::string field = "",
                             v1::RejectReason reason = v1::REJECT_REASON_ABSENT_PART) {
  if (done) return {};
  const bool is_busy = done.error().code == core::ErrorCode::kUnavailable;
  return wire::rejection(is_busy ? v1::REJECT_REASON_BUSY : reason, std::move(field), done.error().message);
}

}  // namespace

RoomWater::RoomWater(std::unique_ptr<Water> water) : water_(std::move(water)), tick_shift_(0 - water_->sim().tick()) {}

bool RoomWater::takes(const v1::Command& command) {
  return handlerOf(command.action_case()) != nullptr;
}

void RoomWater::fillIn(v1::Command& command) const {
  if (!command.has_breaking_wave() || command.breaking_wave().side() != v1::SIDE_UNSPECIFIED) return;
  command.mutable_breaking_wave()->set_side(toMessage(sim::openSide(sim().scene())));
}

RoomWater::Handler RoomWater::handlerOf(v1::Command::ActionCase action) {
  using Command = v1::Command;
  switch (action) {
    case Command::kSplash:
      return [](RoomWater& room, const Command& command) {
        return outcomeOf(room.sim().start(scene::toCore(command.splash())));
      };
    case Command::kBreakingWave:
      return [](RoomWater& room, const Command& command) {
        return outcomeOf(room.sim().start(scene::toCore(command.breaking_wave())));
      };
    case Command::kStroke:
      return [](RoomWater& room, const Command& command) {
        return outcomeOf(room.sim().draw(toStrokePart(command.stroke())));
      };
    case Command::kSetParameter:
      return [](RoomWater& room, const Command& command) { return room.setParameter(command.set_parameter()); };
    case Command::kReset:
      return [](RoomWater& room, const Command& command) { return room.reset(command.reset()); };
    case Command::kSpawnBoat:
      return [](RoomWater& room, const Command& command) {
        return room.spawned(room.sim().spawnBoat(scene::toCore(command.spawn_boat().boat())), "spawn_boat");
      };
    case Command::kControlBoat:
      return [](RoomWater& room, const Command& command) {
        const v1::ControlBoat& control = command.control_boat();
        return outcomeOf(room.sim().controlBoat(control.boat_id(), control.throttle_ratio(), control.rudder_ratio()),
                         "control_boat.boat_id", v1::REJECT_REASON_UNKNOWN_BOAT);
      };
    case Command::kRemoveBoat:
      return [](RoomWater& room, const Command& command) {
        return outcomeOf(room.sim().removeBoat(command.remove_boat().boat_id()), "remove_boat.boat_id",
                         v1::REJECT_REASON_UNKNOWN_BOAT);
      };
    case Command::kSpawnFloater:
      return [](RoomWater& room, const Command& command) {
        return room.spawned(room.sim().spawnFloater(scene::toCore(command.spawn_floater().floater())), "spawn_floater");
      };
    case Command::kHoldFloater:
      return [](RoomWater& room, const Command& command) {
        const v1::HoldFloater& hold = command.hold_floater();
        return outcomeOf(room.sim().holdFloater({.floater_id = hold.floater_id(),
                                                 .x_m = hold.x_m(),
                                                 .z_m = hold.z_m(),
                                                 .lift_m = hold.lift_m(),
                                                 .turn_radps = hold.turn_radps(),
                                                 .ends = hold.ends()}),
                         "hold_floater.floater_id", v1::REJECT_REASON_UNKNOWN_FLOATER);
      };
    case Command::kRemoveFloater:
      return [](RoomWater& room, const Command& command) {
        const v1::RemoveFloater& remove = command.remove_floater();
        return outcomeOf(remove.all() ? room.sim().removeFloaters() : room.sim().removeFloater(remove.floater_id()),
                         "remove_floater.floater_id", v1::REJECT_REASON_UNKNOWN_FLOATER);
      };
    default:
      return nullptr;
  }
}

RoomWater::Outcome RoomWater::apply(const v1::Command& command) {
  assert(takes(command));
  Outcome outcome = handlerOf(command.action_case())(*this, command);
  if (!outcome) ++state_id_;
  return outcome;
}

RoomWater::Outcome RoomWater::reset(const v1::Reset& reset) {
  if (!reset.has_seed()) {
    sim().reset();
    return {};
  }
  sim().resetWith(reset.seed());
  if (reset.seed() == 0) return {};
  v1::Scene seeded = scene();
  seeded.set_seed(reset.seed());
  setScene(std::move(seeded));
  return {};
}

RoomWater::Outcome RoomWater::setParameter(const v1::SetParameter& change) {
  v1::Scene changed = scene();
  if (auto error = scene::setParameter(changed, change.path(), change.value())) {
    return wire::rejection(error->reason, error->path, error->message);
  }
  const core::Scene wanted = scene::toCore(changed);
  if (auto applied = sim().setScene(wanted); !applied) return whyNot(change, wanted, applied.error());
  setScene(std::move(changed));
  return {};
}

std::optional<RoomWater::Relayout> RoomWater::relayout(const v1::SetParameter& change) {
  v1::Scene changed = scene();
  if (scene::setParameter(changed, change.path(), change.value())) return std::nullopt;
  core::Scene wanted = scene::toCore(changed);
  if (!sim().relaysParticles(wanted)) return std::nullopt;
  sim::SceneBasis basis = sim().sceneBasis(wanted);
  return Relayout{change, std::move(changed), std::move(wanted), std::move(basis)};
}

RoomWater::Outcome RoomWater::adopt(Relayout relayout, core::Result<sim::PreparedScene> prepared) {
  if (!prepared) return whyNot(relayout.change, relayout.wanted, prepared.error());
  if (auto adopted = sim().adopt(*std::move(prepared)); !adopted) {
    return whyNot(relayout.change, relayout.wanted, adopted.error());
  }
  setScene(std::move(relayout.changed));
  ++state_id_;
  return {};
}

void RoomWater::takeHealth() {
  const std::uint64_t before = sim().recoveredCount();
  sim().takeHealth();
  if (sim().recoveredCount() != before) ++state_id_;
}

TickWork RoomWater::work() const {
  return workOf(sim().scene(), sim().derived());
}

std::optional<TickWork> RoomWater::workWith(const v1::SetParameter& change) const {
  v1::Scene changed = scene();
  if (scene::setParameter(changed, change.path(), change.value())) return std::nullopt;
  const core::Scene wanted = scene::toCore(changed);
  const auto derived = sim::derive(wanted);
  return derived ? std::optional(workOf(wanted, *derived)) : std::nullopt;
}

RoomWater::Outcome RoomWater::spawned(const core::Result<std::uint32_t>& id, const char* action) {
  if (id) spawned_id_ = *id;
  return outcomeOf(id, action);
}

std::unique_ptr<Water> RoomWater::replaceWater(std::unique_ptr<Water> water) {
  const std::uint32_t first_boat_id = water_->sim().nextBoatId();
  exchange(water);
  water_->sim().numberBoatsFrom(first_boat_id);
  return water;
}

core::Result<void> RoomWater::continueIn(std::unique_ptr<Water>& next) {
  const sim::CarriedState carried = sim().carriedState();
  if (auto why = failure()) return core::unavailable(*why);
  // Values may have changed since the building began.
  v1::Scene wanted = next->scene();
  scene::keepParameters(scene(), wanted);
  wanted.set_seed(scene().seed());
  next->bind();
  auto done = next->sim().setScene(scene::toCore(wanted));
  if (done) done = next->sim().takeOver(carried);
  if (!done) {
    bind();
    return done;
  }
  next->scene() = std::move(wanted);
  exchange(next);
  return {};
}

void RoomWater::save(v1::KeptState& state) {
  state.set_tick(tick());
  *state.mutable_start_scene() = water_->startScene();
  *state.mutable_scene() = scene();
  const sim::SavedState saved = sim().savedState();
  *state.mutable_water() = toMessage(saved);
  state.set_state_hash(sim::hashOf(saved));
  state.set_state_hash_version(kStateHashVersion);
}

core::Result<void> RoomWater::restore(const v1::KeptState& state) {
  const auto saved = toSavedState(state.water());
  if (!saved) return saved.error();
  v1::Scene now = state.scene();
  if (auto set = sim().setScene(scene::toCore(now)); !set) return set;
  if (auto done = sim().restore(*saved); !done) return done;
  const auto hash = recordedHash(sim(), state.state_hash_version());
  if (!hash) return hash.error();
  if (*hash != state.state_hash()) {
    return core::invalid(fmt::format("the saved water is damaged: its hash is {:016x}, {:016x} was expected", *hash,
                                     state.state_hash()));
  }
  setScene(std::move(now));
  tick_shift_ = state.tick() - sim().tick();
  ++state_id_;
  return {};
}

void RoomWater::exchange(std::unique_ptr<Water>& water) {
  const std::uint64_t first_tick = tick() + 1;
  std::swap(water_, water);
  water_->bind();
  ++state_id_;
  ++scene_version_;
  tick_shift_ = first_tick - water_->sim().tick();
}

v1::BoatList RoomWater::boats() const {
  v1::BoatList out;
  for (const sim::BoatRecord& boat : sim().boats()) {
    v1::BoatInfo& info = *out.add_boats();
    info.set_boat_id(boat.boat_id);
    info.set_length_m(boat.length_m);
    info.set_beam_m(boat.beam_m);
    info.set_height_m(boat.height_m);
    info.set_draught_m(boat.draught_m);
  }
  return out;
}

std::set<std::uint32_t> RoomWater::boatIds() const {
  std::set<std::uint32_t> out;
  for (const sim::BoatRecord& boat : sim().boats()) out.insert(boat.boat_id);
  return out;
}

}  // namespace spindrift::water
