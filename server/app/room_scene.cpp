// How a room changes its scene: the new water is built and warmed beside the running one, then takes its place between
// two ticks. The senders are answered when it has.
#include <variant>

#include <spdlog/spdlog.h>

#include "room.h"

namespace spindrift::app {
namespace {

using namespace std::chrono_literals;

/// Everybody in the room loads the new scene.
constexpr auto kSceneChangeInterval = 1s;
constexpr const char* kField = "change_scene.name";

}  // namespace

void Room::beginScene(Batch batch) {
  const std::string name = std::get<core::ChangeScene>(batch.front().action).name;
  if (!rules_.scenes.has(name)) {
    return answer(std::move(batch), rejection(v1::REJECT_REASON_UNKNOWN_SCENE, kField,
                                              "there is no scene '" + name + "'; the greeting lists what there is"));
  }
  if (std::chrono::steady_clock::now() < next_scene_change_) {
    return answer(std::move(batch), rejection(v1::REJECT_REASON_BUSY, kField,
                                              "the scene was changed a moment ago; try again in a second"));
  }
  auto scene = rules_.scenes.load(name);
  if (!scene) {
    return answer(std::move(batch),
                  rejection(v1::REJECT_REASON_UNKNOWN_SCENE, kField, firstLine(scene.error().message)));
  }
  commands_.hold(batch);
  scene_build_.emplace(SceneBuild{std::move(batch), builder_.build(*std::move(scene))});
}

void Room::adoptScene(RoomObserver& observer) {
  if (!scene_build_ || scene_build_->water.wait_for(0s) != std::future_status::ready) return;
  SceneBuild build = *std::move(scene_build_);
  scene_build_.reset();
  commands_.release(build.commands);
  const core::Action action = build.commands.front().action;
  WaterBuilder::Built water = build.water.get();
  if (!water) {
    return answer(std::move(build.commands), rejection(v1::REJECT_REASON_OUT_OF_RANGE, kField,
                                                       "scene '" + std::get<core::ChangeScene>(action).name +
                                                           "': " + firstLine(water.error().message)));
  }
  builder_.dispose(stage_->replaceWater(*std::move(water)));
  restartScene(observer);
  answer(std::move(build.commands), {});
  answer(commands_.takeEqual(action), {});
}

void Room::restartScene(RoomObserver& observer) {
  if (log_) {
    v1::Record line;
    *line.mutable_scene() = stage_->scene();
    record(std::move(line));
  }
  const double speed = clock_.speed();
  clock_ = RealTimeClock(stage_->water().derived().tick_s);
  clock_.setSpeed(speed);
  const auto ready = std::chrono::steady_clock::now();
  clock_.restart(ready);
  last_run_ = last_watched_ = ready;
  asleep_ = false;
  next_scene_change_ = ready + kSceneChangeInterval;
  next_frame_s_ = 0.0;
  next_idle_frame_ = {};
  pending_tick_count_ = 0;
  frames_in_flight_ = 0;
  wants_diagnostics_ = false;
  step_ms_sum_ = last_step_ms_ = 0.0;
  step_count_ = 0;
  last_passes_.clear();
  slow_since_ = {};
  recovery_news_.restart(stage_->water().recoveredCount());
  logged_recovery_count_ = stage_->water().recoveredCount();
  boats_ = stage_->boats();
  news_ = {};            // the greeting says it all
  roster_.keepOnly({});  // the new scene's boats are nobody's yet, whatever their numbers
  publishSnapshot();
  spdlog::info("room {}: scene {}", name_, stage_->scene().name());
  observer.sceneChanged(*this);
}

}  // namespace spindrift::app
