// Scene changes of a room. The new water is built and warmed up while the old one runs, then replaces it between two
// ticks; the senders are answered afterwards.
#include <spdlog/spdlog.h>

#include <spindrift/core/monotonic.h>
#include <spindrift/rooms/room.h>
#include <spindrift/scene/scene_loader.h>

namespace spindrift::rooms {
namespace {

using namespace std::chrono_literals;

/// Limited because every client in the room has to load the new scene.
constexpr auto kSceneChangeInterval = 1s;
constexpr const char* kField = "change_scene.name";

}  // namespace

void Room::beginScene(Batch batch) {
  const v1::ChangeScene& wanted = batch.front().message.change_scene();
  const std::string name = wanted.name();
  const bool names_level = wanted.fidelity() != v1::FIDELITY_UNSPECIFIED;
  const bool goes_on = names_level && name == water_->scene().name();
  if (goes_on && wanted.fidelity() == water_->scene().fidelity()) {
    if (auto refused = keep(batch.front())) return answer(std::move(batch), refused);
    chosen_fidelity_ = wanted.fidelity();
    return answer(std::move(batch), {});
  }
  if (!rules_.scenes.has(name)) {
    return answer(std::move(batch), rejection(v1::REJECT_REASON_UNKNOWN_SCENE, kField,
                                              "there is no scene '" + name + "'; the greeting lists what there is"));
  }
  if (std::chrono::steady_clock::now() < next_scene_change_) {
    return answer(std::move(batch), rejection(v1::REJECT_REASON_BUSY, kField,
                                              "the scene was changed a moment ago; try again in a second"));
  }
  auto scene = goes_on ? sceneAt(wanted.fidelity())
                       : rules_.scenes.load(name, names_level ? std::optional(wanted.fidelity()) : std::nullopt);
  if (!scene) {
    return answer(std::move(batch),
                  rejection(v1::REJECT_REASON_UNKNOWN_SCENE, kField, firstLine(scene.error().message)));
  }
  commands_.hold(batch);
  build_.emplace(
      WaterBuild{.commands = std::move(batch), .water = builder_.build(*std::move(scene)), .goes_on = goes_on});
}

void Room::adoptWater(TimePoint now) {
  if (!build_ || change_ || build_->water.wait_for(0s) != std::future_status::ready) return;
  WaterBuild build = *std::move(build_);
  build_.reset();
  commands_.release(build.commands);
  WaterBuilder::Built water = build.water.get();
  if (build.cause == WaterBuild::Cause::kDeviceFailure) return finishRebuild(now, std::move(water));
  if (build.cause == WaterBuild::Cause::kAdapting) return adoptAdapted(now, build, std::move(water));
  const Command first = build.commands.front();
  const std::string name = first.message.change_scene().name();
  if (!water) {
    spdlog::warn("room {}: stays with scene {}, because scene {} cannot be built: {}", name_, water_->scene().name(),
                 name, firstLine(water.error().message));
    return answer(std::move(build.commands), rejection(v1::REJECT_REASON_OUT_OF_RANGE, kField,
                                                       "scene '" + name + "': " + firstLine(water.error().message)));
  }
  if (auto slow = refuseSlow(first.sender, kField, (*water)->warmTick_ms(), kSceneTickMax_ms)) {
    builder_.dispose(*std::move(water));
    return answer(std::move(build.commands), slow);
  }
  if (!build.goes_on || is_lost_) {
    replaceWater(*std::move(water));
  } else if (auto failed = goOnIn(*water, "")) {
    builder_.dispose(*std::move(water));
    return answer(std::move(build.commands), failed);
  }
  chosen_fidelity_ = water_->scene().fidelity();
  governor_.changed(core::monotonic_s(now), FidelityGovernor::Step::kNone);
  answer(std::move(build.commands), {});
  answer(commands_.takeEqual(first.message), {});
}

void Room::replaceWater(std::unique_ptr<Water> water) {
  builder_.dispose(water_->replaceWater(std::move(water)));
  is_lost_ = false;
  restartScene(false);
}

Room::Outcome Room::refuseSlow(const core::Sender& sender, const std::string& field, double tick_ms,
                               double max_ms) const {
  const double now_ms = tick_cost_.tick_ms();
  const std::size_t own_count = sender.session_id != 0 ? 1 : 0;
  if (session_count_ <= own_count || tick_ms <= std::max(max_ms, now_ms)) return {};
  return rejection(
      v1::REJECT_REASON_BUSY, field,
      fmt::format("a tick would take about {:.0f} ms on this device, {:.0f} ms are the most while others are "
                  "connected: choose less, or try again when nobody else is here",
                  tick_ms, max_ms));
}

// A device that fails

bool Room::isLost(TimePoint now) {
  if (!is_lost_) {
    const auto failure = water_->failure();
    if (!failure) return false;
    spdlog::error("room {}: {}; scene {} is rebuilt", name_, *failure, water_->scene().name());
    is_lost_ = true;
    rebuild_pause_ = 1s;
    next_rebuild_ = now;
    publishLoss();
  }
  if (!build_ && now >= next_rebuild_) {
    build_.emplace(WaterBuild{
        .commands = {}, .water = builder_.build(sceneAfterLoss()), .cause = WaterBuild::Cause::kDeviceFailure});
  }
  const auto failed =
      rejection(v1::REJECT_REASON_BUSY, "", "the device failed and the room's water is being built anew: try again");
  abandonChanges(failed);
  answer(commands_.drain(), failed);
  return true;
}

void Room::finishRebuild(TimePoint now, WaterBuilder::Built water) {
  constexpr std::chrono::seconds kLongestPause{30};
  if (!water) {
    spdlog::error("room {}: its water cannot be rebuilt ({}); the next try is in {} s", name_, water.error().message,
                  rebuild_pause_.count());
    next_rebuild_ = now + rebuild_pause_;
    rebuild_pause_ = std::min(2 * rebuild_pause_, kLongestPause);
    return;
  }
  const bool is_restored = restoreAfterLoss(*water);
  if (!is_restored) replaceWater(*std::move(water));
  news_.rebuilt = is_restored ? "the device failed; the room continues where it was, on a new one"
                              : "the device failed; the scene began again on a new one";
  publishVitals(now);
  spdlog::warn("room {}: runs again, scene {} {}", name_, water_->scene().name(),
               is_restored ? "where it was" : "from its start");
}

v1::Scene Room::sceneAfterLoss() const {
  const auto kept = diary_.keeper() ? diary_.keeper()->newest() : std::nullopt;
  if (!kept) return water_->scene();
  v1::Scene out = kept->state->start_scene();
  scene::fillDefaults(out);
  return out;
}

void Room::restartScene(bool goes_on) {
  if (!goes_on) diary_.beganScene(tick(), water_->scene());
  diary_.waterReplaced(water_->sim().recoveredCount());
  const auto ready = std::chrono::steady_clock::now();
  time_.restart(water_->sim().derived().tick_s, goes_on, ready);
  next_scene_change_ = ready + kSceneChangeInterval;
  frames_.restart();
  frames_.setIdleDue({});
  wants_diagnostics_ = false;
  tick_meter_.restart();
  tick_cost_.restart(water_->warmTick_ms(), water_->work());
  recovery_news_.restart(water_->sim().recoveredCount());
  boats_ = water_->boats();
  news_ = {};                          // the greeting contains all of it
  if (!goes_on) roster_.keepOnly({});  // the boats of the new scene have no owner yet, whatever their ids
  publishSnapshot();
  if (!goes_on) spdlog::info("room {}: scene {}", name_, water_->scene().name());
  outlets_.sceneChanged(*this);
}

}  // namespace spindrift::rooms
