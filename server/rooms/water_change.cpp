#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <spindrift/core/monotonic.h>
#include <spindrift/core/text.h>
#include <spindrift/history/repetition.h>
#include <spindrift/rooms/water_change.h>
#include <spindrift/scene/fidelity.h>
#include <spindrift/scene/scene_loader.h>

namespace spindrift::rooms {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using Step = FidelityGovernor::Step;

/// Limited because every client in the room has to load the new scene.
constexpr auto kSceneChangeInterval = 1s;
constexpr auto kRebuildPauseMax = 30s;
constexpr const char* kSceneField = "change_scene.name";
constexpr const char* kFidelityField = "change_scene.fidelity";

template <typename T>
bool isReady(const std::future<T>& work) {
  return work.wait_for(0s) == std::future_status::ready;
}

}  // namespace

std::optional<WaterChange::TimePoint> WaterChange::due(TimePoint ran) const {
  if (relayout_ ? isReady(relayout_->prepared) : build_ && isReady(build_->water)) return ran;
  if (is_lost_ && !build_) return next_rebuild_;
  return std::nullopt;
}

WaterChange::Build& WaterChange::begin(Build::Cause cause, v1::Scene scene) {
  build_ = Build{.cause = cause, .water = room_.builder.build(std::move(scene))};
  return *build_;
}

std::optional<WaterChange::Built> WaterChange::takeBuilt(TimePoint now) {
  if (!build_ || relayout_ || !isReady(build_->water)) return std::nullopt;
  Build build = *std::exchange(build_, std::nullopt);
  water::WaterBuilder::Built water = build.water.get();
  if (build.cause == Build::Cause::kCommand) return takeScene(now, build, std::move(water));
  if (build.cause == Build::Cause::kAdapting) return takeAdapted(now, build, std::move(water));
  return takeRebuilt(now, std::move(water));
}

// Another scene

std::optional<WaterChange::Outcome> WaterChange::beginScene(const Command& command) {
  const v1::ChangeScene& wanted = command.message.change_scene();
  const v1::Scene& present = room_.water->scene();
  const bool names_level = wanted.fidelity() != v1::FIDELITY_UNSPECIFIED;
  const bool goes_on = names_level && wanted.name() == present.name();
  if (goes_on && wanted.fidelity() == present.fidelity()) {
    if (auto refused = room_.diary.writeAhead(command.message)) return refused;
    room_.chosen_fidelity = wanted.fidelity();
    return Outcome{};
  }
  if (!room_.rules.scenes.has(wanted.name())) {
    return wire::rejection(v1::REJECT_REASON_UNKNOWN_SCENE, kSceneField,
                           "there is no scene '" + wanted.name() + "'; the greeting lists what there is");
  }
  // With a held clock the outcome does not depend on how fast the ticks before were.
  if (Clock::now() < next_scene_change_ && !room_.clock.isHeld()) {
    return wire::rejection(v1::REJECT_REASON_BUSY, kSceneField,
                           "the scene was changed a moment ago; try again in a second");
  }
  auto scene =
      goes_on ? water::sceneAt(room_.rules.scenes, present, wanted.fidelity())
              : room_.rules.scenes.load(wanted.name(), names_level ? std::optional(wanted.fidelity()) : std::nullopt);
  if (!scene)
    return wire::rejection(v1::REJECT_REASON_UNKNOWN_SCENE, kSceneField, core::firstLine(scene.error().message));
  Build& build = begin(Build::Cause::kCommand, *std::move(scene));
  build.goes_on = goes_on;
  build.command = command;
  return std::nullopt;
}

WaterChange::Built WaterChange::takeScene(TimePoint now, const Build& build, water::WaterBuilder::Built water) {
  const std::string& name = build.command->message.change_scene().name();
  const auto refuse = [](Outcome why) { return Built{.answers_command = true, .outcome = std::move(why)}; };
  if (!water) {
    spdlog::warn("room {}: stays with scene {}, because scene {} cannot be built: {}", room_.name,
                 room_.water->scene().name(), name, core::firstLine(water.error().message));
    return refuse(wire::rejection(v1::REJECT_REASON_OUT_OF_RANGE, kSceneField,
                                  "scene '" + name + "': " + core::firstLine(water.error().message)));
  }
  if (auto slow = refuseSlow(build.command->sender, kSceneField, (*water)->warmTick_ms(), water::kSceneTickMax_ms)) {
    room_.builder.dispose(*std::move(water));
    return refuse(std::move(slow));
  }
  Built out = build.goes_on && !is_lost_ ? continueIn(*water, "") : startIn(*std::move(water));
  out.answers_command = true;
  if (out.outcome) {
    room_.builder.dispose(*std::move(water));
    return out;
  }
  room_.chosen_fidelity = room_.water->scene().fidelity();
  governor_.changed(core::monotonic_s(now), Step::kNone);
  return out;
}

WaterChange::Built WaterChange::startIn(std::unique_ptr<water::Water> water) {
  room_.builder.dispose(room_.water->replaceWater(std::move(water)));
  room_.diary.beganScene();
  waterReplaced(false);
  spdlog::info("room {}: scene {}", room_.name, room_.water->scene().name());
  return {.water = Built::Water::kAtItsStart};
}

void WaterChange::waterReplaced(bool keeps_steps) {
  is_lost_ = false;
  room_.diary.waterReplaced();
  const auto ready = Clock::now();
  room_.time.restart(room_.water->sim().derived().tick_s, keeps_steps, ready);
  room_.tick_cost.restart(room_.water->warmTick_ms(), room_.water->work());
  next_scene_change_ = ready + kSceneChangeInterval;
}

WaterChange::Outcome WaterChange::refuseSlow(const core::Sender& sender, const std::string& field, double tick_ms,
                                             double max_ms) const {
  const std::size_t own_count = sender.session_id != 0 ? 1 : 0;
  if (room_.load.people_count <= own_count || tick_ms <= std::max(max_ms, room_.tick_cost.tick_ms())) return {};
  return wire::rejection(
      v1::REJECT_REASON_BUSY, field,
      fmt::format("a tick would take about {:.0f} ms on this device, {:.0f} ms are the most while others are "
                  "connected: choose less, or try again when nobody else is here",
                  tick_ms, max_ms));
}

// The same water at another fidelity

WaterChange::Built WaterChange::continueIn(std::unique_ptr<water::Water>& next, const std::string& why) {
  const std::string before = scene::fidelityName(room_.water->scene().fidelity());
  const v1::Scene built = next->startScene();
  if (auto done = room_.water->continueIn(next); !done) {
    const bool is_device = done.error().code == core::ErrorCode::kUnavailable;
    return {.outcome = wire::rejection(is_device ? v1::REJECT_REASON_BUSY : v1::REJECT_REASON_NEEDS_RESTART,
                                       kFidelityField, core::firstLine(done.error().message))};
  }
  room_.builder.dispose(std::move(next));
  // As it was built: the lattice of its particles follows from the parameters of that moment, and the present ones from
  // the commands before.
  room_.diary.continuedIn(built);
  waterReplaced(true);
  Built out{.water = Built::Water::kContinues};
  out.fidelity = fmt::format("{}fidelity is now {} instead of {}", why.empty() ? why : why + ": ",
                             scene::fidelityName(room_.water->scene().fidelity()), before);
  spdlog::info("room {}: {}", room_.name, out.fidelity);
  return out;
}

void WaterChange::adapt(TimePoint now) {
  if (!room_.rules.adapts || stopsTime() || build_ || !room_.rules.scenes.has(room_.water->scene().name())) return;
  const v1::Fidelity level = room_.water->scene().fidelity();
  const auto lower = scene::coarserThan(level);
  const auto upper = scene::finerThan(level);
  const double pace = room_.time.pace();
  const Step step = governor_.note({.now_s = core::monotonic_s(now),
                                    .pace = pace,
                                    .can_fall = lower.has_value(),
                                    .can_rise = upper && scene::rankOf(*upper) <= scene::rankOf(room_.chosen_fidelity),
                                    .is_building = !room_.builder.isIdle()},
                                   [&] { return loadAt(*upper); });
  if (step == Step::kNone) return;
  auto scene = water::sceneAt(room_.rules.scenes, room_.water->scene(), step == Step::kDown ? *lower : *upper);
  if (!scene) {
    spdlog::warn("room {}: its fidelity cannot change: {}", room_.name, core::firstLine(scene.error().message));
    return governor_.failed(core::monotonic_s(now));
  }
  Build& build = begin(Build::Cause::kAdapting, *std::move(scene));
  build.goes_on = true;
  build.step = step;
  build.why = step == Step::kDown ? fmt::format("the machine could not keep up (time ran at {:.0f} %)", 100 * pace)
                                  : std::string("the machine has room again");
}

WaterChange::Built WaterChange::takeAdapted(TimePoint now, const Build& build, water::WaterBuilder::Built water) {
  const auto fail = [&](const std::string& why) {
    spdlog::warn("room {}: its fidelity stays {}: {}", room_.name, scene::fidelityName(room_.water->scene().fidelity()),
                 why);
    governor_.failed(core::monotonic_s(now));
    if (water) room_.builder.dispose(*std::move(water));
    return Built{};
  };
  if (!water) return fail(core::firstLine(water.error().message));
  // Its time is not that of the holders' ticks.
  if (room_.clock.isHeld() && !is_lost_) return fail("somebody holds the room's clock");
  if (is_lost_) return takeRebuilt(now, std::move(water));
  // It ran for the first time: a device that works beside this thread shows what it costs only now.
  const double budget_ms = 1e3 * (*water)->sim().derived().tick_s / room_.time.speed();
  if (const double tick_ms = (*water)->warmTick_ms(); build.step == Step::kUp && tick_ms > budget_ms) {
    return fail(fmt::format("a tick would take {:.1f} ms, {:.1f} ms are the most in real time", tick_ms, budget_ms));
  }
  Built out = continueIn(*water, build.why);
  if (out.outcome) return fail(out.outcome->message());
  governor_.changed(core::monotonic_s(now), build.step);
  return out;
}

double WaterChange::loadAt(v1::Fidelity level) const {
  const auto then = water::workAt(room_.rules.scenes, room_.water->scene(), level);
  if (!then) return std::numeric_limits<double>::infinity();
  const double per_s_now = room_.time.speed() / room_.water->sim().derived().tick_s;
  const double per_s_then = room_.time.speed() / then->tick_s;
  const double more_ms_per_s = room_.tick_cost.predict_ms(*then) * per_s_then - room_.tick_cost.tick_ms() * per_s_now;
  return room_.load.thread_share + more_ms_per_s / 1e3;
}

// Another layout of the particles

bool WaterChange::beginRelayout(const v1::SetParameter& change) {
  auto inputs = room_.water->relayout(change);
  if (!inputs) return false;
  auto prepared = room_.builder.prepare(inputs->wanted, std::exchange(inputs->basis, {}));
  relayout_.emplace(Relayout{*std::move(inputs), std::move(prepared)});
  return true;
}

std::optional<WaterChange::Outcome> WaterChange::takeLayout() {
  if (!relayout_ || !isReady(relayout_->prepared)) return std::nullopt;
  Relayout ready = *std::exchange(relayout_, std::nullopt);
  return room_.water->adopt(std::move(ready.inputs), ready.prepared.get());
}

// A device that fails

bool WaterChange::watchDevice(TimePoint now) {
  if (!is_lost_) {
    const auto failure = room_.water->failure();
    if (!failure) return false;
    spdlog::error("room {}: {}; scene {} is rebuilt", room_.name, *failure, room_.water->scene().name());
    is_lost_ = true;
    rebuild_pause_ = 1s;
    next_rebuild_ = now;
  }
  if (!build_ && now >= next_rebuild_) begin(Build::Cause::kDeviceFailure, sceneAfterLoss());
  return true;
}

v1::Scene WaterChange::sceneAfterLoss() const {
  const auto kept = room_.diary.keeper() ? room_.diary.keeper()->newest() : std::nullopt;
  if (!kept) return room_.water->scene();
  v1::Scene out = kept->state->start_scene();
  scene::fillDefaults(out);
  return out;
}

WaterChange::Built WaterChange::takeRebuilt(TimePoint now, water::WaterBuilder::Built water) {
  if (!water) {
    spdlog::error("room {}: its water cannot be rebuilt ({}); the next try is in {} s", room_.name,
                  water.error().message, rebuild_pause_.count());
    next_rebuild_ = now + rebuild_pause_;
    rebuild_pause_ = std::min<std::chrono::seconds>(2 * rebuild_pause_, kRebuildPauseMax);
    return {};
  }
  auto restored = restoreIn(*water);
  Built out = restored ? *std::move(restored) : startIn(*std::move(water));
  const bool continues = out.water == Built::Water::kContinues;
  out.recovered = continues ? "the device failed; the room continues where it was, on a new one"
                            : "the device failed; the scene began again on a new one";
  spdlog::warn("room {}: runs again, scene {} {}", room_.name, room_.water->scene().name(),
               continues ? "where it was" : "from its start");
  return out;
}

std::optional<WaterChange::Built> WaterChange::restoreIn(std::unique_ptr<water::Water>& water) {
  history::StateKeeper* const keeper = room_.diary.keeper();
  auto kept = keeper ? keeper->newest() : std::nullopt;
  if (!kept) return std::nullopt;
  water::RoomWater& room_water = *room_.water;
  const std::uint64_t lost_tick = room_water.tick();
  room_.builder.dispose(room_water.replaceWater(std::move(water)));
  auto restored = history::RestoredRoom::begin(*std::move(kept), room_water, room_.builder);
  const auto done = restored ? restored->continueUntil(TimePoint::max()) : core::Result<bool>(restored.error());
  if (!done) {
    spdlog::error("room {}: its state cannot be restored: {}", room_.name, done.error().message);
    room_water.sim().reset();
    room_.diary.beganScene();
    waterReplaced(false);
    return Built{.water = Built::Water::kAtItsStart};
  }
  const history::RepeatedRoom rest = restored->room();
  room_.time.restore(room_water.sim().derived().tick_s, rest.speed, rest.is_paused, rest.pending_tick_count);
  room_.chosen_fidelity = rest.chosen_fidelity;
  room_water.goOnAfter(lost_tick);
  room_.diary.recovered();
  waterReplaced(true);
  // Ticks have passed since the snapshot, and the log does not say so.
  keeper->openGap("the room continued after its device failed, and no snapshot says so yet");
  return Built{.water = Built::Water::kContinues};
}

}  // namespace spindrift::rooms
