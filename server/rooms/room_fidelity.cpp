// The fidelity of a room: the same water continues at another level, because a person asks for it or because the
// machine cannot keep up (`serve --adapt`). Like a new scene, the new water is built while the old one runs.
#include <limits>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <spindrift/core/monotonic.h>
#include <spindrift/rooms/room.h>
#include <spindrift/scene/fidelity.h>
#include <spindrift/scene/scene_loader.h>

namespace spindrift::rooms {
namespace {

using Step = FidelityGovernor::Step;

constexpr const char* kField = "change_scene.fidelity";

}  // namespace

core::Result<v1::Scene> Room::sceneAt(v1::Fidelity level) const {
  auto scene = rules_.scenes.load(water_->scene().name(), level);
  if (scene) scene::keepParameters(water_->scene(), *scene);
  return scene;
}

Room::Outcome Room::goOnIn(std::unique_ptr<Water>& next, const std::string& why) {
  const std::string before = scene::fidelityName(water_->scene().fidelity());
  const v1::Scene built = next->startScene();
  if (auto done = water_->continueIn(next); !done) {
    return rejection(
        done.error().code == core::ErrorCode::kUnavailable ? v1::REJECT_REASON_BUSY : v1::REJECT_REASON_NEEDS_RESTART,
        kField, firstLine(done.error().message));
  }
  builder_.dispose(std::move(next));
  // As it was built: the lattice of its particles follows from the parameters of that moment, and the present ones from
  // the commands before.
  diary_.continuedIn(tick(), built);
  restartScene(true);
  const std::string news = fmt::format("{}fidelity is now {} instead of {}", why.empty() ? why : why + ": ",
                                       scene::fidelityName(water_->scene().fidelity()), before);
  spdlog::info("room {}: {}", name_, news);
  outlets_.fidelityChanged(*this, news);
  return {};
}

void Room::adaptFidelity(TimePoint now) {
  if (!rules_.adapts || build_ || change_ || is_lost_ || !rules_.scenes.has(water_->scene().name())) return;
  const v1::Fidelity level = water_->scene().fidelity();
  const auto lower = scene::coarserThan(level);
  const auto upper = scene::finerThan(level);
  const double pace = time_.pace();
  const Step step = governor_.note({.now_s = core::monotonic_s(now),
                                    .pace = pace,
                                    .can_fall = lower.has_value(),
                                    .can_rise = upper && scene::rankOf(*upper) <= scene::rankOf(chosen_fidelity_),
                                    .is_building = !builder_.isIdle()},
                                   [&] { return loadAt(*upper); });
  if (step == Step::kNone) return;
  auto scene = sceneAt(step == Step::kDown ? *lower : *upper);
  if (!scene) {
    spdlog::warn("room {}: its fidelity cannot change: {}", name_, firstLine(scene.error().message));
    return governor_.failed(core::monotonic_s(now));
  }
  build_.emplace(WaterBuild{.commands = {},
                            .water = builder_.build(*std::move(scene)),
                            .cause = WaterBuild::Cause::kAdapting,
                            .goes_on = true,
                            .step = step,
                            .why = step == Step::kDown
                                       ? fmt::format("the machine could not keep up (time ran at {:.0f} %)", 100 * pace)
                                       : std::string("the machine has room again")});
}

void Room::adoptAdapted(TimePoint now, const WaterBuild& build, WaterBuilder::Built water) {
  const auto fail = [&](const std::string& why) {
    spdlog::warn("room {}: its fidelity stays {}: {}", name_, scene::fidelityName(water_->scene().fidelity()), why);
    governor_.failed(core::monotonic_s(now));
  };
  if (!water) return fail(firstLine(water.error().message));
  if (is_lost_) return finishRebuild(now, std::move(water));
  // It ran for the first time: a device that works beside this thread shows what it costs only now.
  const double budget_ms = 1e3 * (*water)->sim().derived().tick_s / time_.speed();
  if (build.step == Step::kUp && (*water)->warmTick_ms() > budget_ms) {
    const double tick_ms = (*water)->warmTick_ms();
    builder_.dispose(*std::move(water));
    return fail(fmt::format("a tick would take {:.1f} ms, {:.1f} ms are the most in real time", tick_ms, budget_ms));
  }
  if (auto failed = goOnIn(*water, build.why)) {
    builder_.dispose(*std::move(water));
    return fail(failed->message);
  }
  governor_.changed(core::monotonic_s(now), build.step);
}

double Room::loadAt(v1::Fidelity level) const {
  const auto scene = sceneAt(level);
  if (!scene) return std::numeric_limits<double>::infinity();
  const core::Scene wanted = scene::toCore(*scene);
  const auto derived = sim::derive(wanted);
  if (!derived) return std::numeric_limits<double>::infinity();
  const double per_s_now = time_.speed() / water_->sim().derived().tick_s;
  const double per_s_then = time_.speed() / derived->tick_s;
  const double more_ms_per_s =
      tick_cost_.predict_ms(workOf(wanted, *derived)) * per_s_then - tick_cost_.tick_ms() * per_s_now;
  return thread_load_ + more_ms_per_s / 1e3;
}

}  // namespace spindrift::rooms
