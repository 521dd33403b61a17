#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <spindrift/rooms/room.h>

namespace spindrift::rooms {
namespace {

using namespace std::chrono_literals;

/// While the device works on a frame, look for it this often.
constexpr auto kReadbackPollInterval = 1ms;
/// A room that stands still and has commands that cannot be carried out yet (heavy ones wait for their budget).
constexpr auto kWaitingCommandInterval = 10ms;
/// A room that stands still looks after its state on disk, its people and its metrics.
constexpr auto kStandingInterval = 1s;
constexpr auto kVitalsInterval = 250ms;

}  // namespace

// Opening

Room::Room(std::string name, const RoomRules& rules, water::WaterBuilder& builder, RoomOutlets& outlets,
           std::unique_ptr<water::RoomWater> room_water, history::Diary diary, v1::RoomAccess access)
    : name_(std::move(name)),
      access_(std::move(access)),
      outlets_(outlets),
      water_(std::move(room_water)),
      diary_(std::move(diary)),
      roster_(rules.grace, [this] { wake(); }),
      time_(water_->sim().derived().tick_s),
      chosen_fidelity_(water_->scene().fidelity()),
      reports_({*this, *water_, time_, roster_, outlets}),
      frames_({*this, *water_, time_, tick_meter_, *demand_, outlets}),
      change_({name_, rules, builder, *water_, diary_, time_, tick_cost_, load_, chosen_fidelity_}),
      actions_({*water_, diary_, time_, roster_, frames_.schedule(), tick_cost_, reports_.news()}),
      desk_({*water_, actions_, change_, tick_cost_, diary_}),
      keeping_({name_, access_, *water_, time_, roster_, chosen_fidelity_, diary_, builder, rules.disk_patience}) {
  tick_cost_.restart(water_->warmTick_ms(), water_->work());
  publishVitals({});
}

core::Result<std::shared_ptr<Room>> Room::begin(std::string name, std::unique_ptr<water::Water> water,
                                                const RoomRules& rules, water::WaterBuilder& builder,
                                                RoomOutlets& outlets, history::RoomPlace place, v1::RoomAccess access) {
  auto room_water = std::make_unique<water::RoomWater>(std::move(water));
  auto diary =
      history::Diary::create(name, *room_water, rules.record_folder, rules.hash_interval_ticks, place.kept.has_value());
  if (!diary) return diary.error();
  auto room = std::shared_ptr<Room>(
      new Room(std::move(name), rules, builder, outlets, std::move(room_water), *std::move(diary), std::move(access)));
  if (auto begun = room->keeping_.begin(std::move(place)); !begun) return begun.error();
  return room;
}

core::Result<bool> Room::restoreUntil(TimePoint deadline) {
  const auto done = keeping_.restoreUntil(deadline);
  if (!done || !*done) return done;
  tick_cost_.restart(water_->warmTick_ms(), water_->work());
  reports_.begin();
  publishVitals({});
  return true;
}

core::Result<void> Room::saveUntil(TimePoint deadline) {
  if (change_.isLost()) return {};
  water_->bind();
  return keeping_.saveUntil(deadline);
}

std::string Room::summary(TimePoint now) const {
  return fmt::format("room {}: {} ticks, real-time factor {:.2f}, {} frames dropped, watchdog stepped in {} times",
                     name_, tick(), time_.meanRealTimeFactor(now), frames_.droppedCount(),
                     water_->sim().recoveredCount());
}

void Room::releaseDevice() {
  water_.reset();
  if (diary_.keeper()) diary_.keeper()->finish();
}

// Any thread

std::optional<wire::CommandRejection> Room::admit(Command command) {
  auto refused = desk_.admit(std::move(command), *reports_.snapshot());
  if (!refused) wake();
  return refused;
}

bool Room::askForSnapshot() {
  if (!diary_.keeper()) return false;
  diary_.keeper()->ask();
  wake();
  return true;
}

std::optional<history::StateKeeper::Status> Room::keptStatus() const {
  if (!diary_.keeper()) return std::nullopt;
  return diary_.keeper()->status();
}

void Room::wake() {
  if (!is_woken_.exchange(true) && on_wake_) on_wake_();
}

// One round

Room::TimePoint Room::due() const {
  const bool stands_still = change_.stopsTime() || !time_.runs();
  TimePoint next = stands_still ? ran_ + kStandingInterval : time_.due();
  const auto no_later_than = [&next](TimePoint when) { next = std::min(next, when); };
  if (const auto change = change_.due(ran_)) no_later_than(*change);
  if (!change_.isLost() && water_->sim().framesInFlight() > 0) no_later_than(ran_ + kReadbackPollInterval);
  if (!stands_still) return next;
  if (is_woken_ || (time_.stepsToCome() > 0 && !change_.stopsTime())) return ran_;
  if (desk_.hasWork()) no_later_than(ran_ + kWaitingCommandInterval);
  if (const auto people = reports_.due()) no_later_than(*people);
  if (!change_.stopsTime() && time_.isPaused() && demand_->sessionCount() > 0)
    no_later_than(frames_.schedule().idleDue());
  return next;
}

void Room::run(TimePoint now, const ServerLoad& load) {
  is_woken_ = false;
  ++round_count_;
  ran_ = now;
  load_ = load;
  water_->bind();
  water_->reloadChangedShaders();
  if (const auto built = change_.takeBuilt(now)) waterChanged(*built, now);
  if (change_.watchDevice(now)) return standStill();
  time_.beginRound(now);
  frames_.handOver();
  const bool may_sleep = water_->scene().unwatched() == v1::UNWATCHED_SLEEP;
  if (time_.watchOver(!may_sleep || demand_->sessionCount() > 0, now)) publishVitals(now);
  settlePeople(now);
  desk_.finishRelayout();
  if (!time_.runs() || now >= time_.due()) desk_.carryOut(now);
  announce();
  if (change_.stopsTime()) {
    // The state stands still until the particles are laid out.
  } else if (time_.isPaused()) {
    advancePaused(now);
  } else if (time_.runs() && now >= time_.due()) {
    step(now);
  }
  if (reports_.tellRecovery(now)) actions_.boatsChanged();
  if (!change_.stopsTime()) keeping_.keep(now);
  frames_.handOver();
  if (now >= next_vitals_) publishVitals(now);
}

void Room::step(TimePoint now) {
  const TimePoint scheduled = time_.due();
  const TimePoint end = timedStep();
  time_.ticked(now, end);
  restartIfOver();
  frames_.afterTick(scheduled, end);
  reports_.tellStrokes(end);
  time_.warnIfSlow(name_, end);
  change_.adapt(end);
}

void Room::advancePaused(TimePoint now) {
  if (time_.stepsToCome() > 0) {
    now = timedStep();
    if (time_.stepped()) frames_.schedule().setIdleDue(now);  // what was asked for is there to see at once
  }
  frames_.whilePaused(now);
}

Room::TimePoint Room::timedStep() {
  const auto begin = std::chrono::steady_clock::now();
  water_->step();
  const auto end = std::chrono::steady_clock::now();
  const double step_ms = std::chrono::duration<double, std::milli>(end - begin).count();
  tick_cost_.note(step_ms);
  tick_meter_.note(step_ms);
  diary_.ticked(tick(), water_->sim());
  return end;
}

void Room::restartIfOver() {
  const double after_s = water_->scene().restart_after_s();
  if (after_s <= 0 || water_->sim().time_s() < after_s) return;
  Command again;
  again.message.mutable_reset();
  (void)actions_.reset(again);  // refused while the disk is full: tried again at the next tick
}

void Room::waterChanged(const WaterChange::Built& built, TimePoint now) {
  using Water = WaterChange::Built::Water;
  if (built.water != Water::kSame) {
    frames_.restart();
    tick_meter_.restart();
    // The boats of a new scene have no owner yet, whatever their ids.
    roster_.keepOnly(built.water == Water::kContinues ? water_->boatIds() : std::set<std::uint32_t>{});
    publishVitals(now);
    reports_.sceneChanged();
  }
  reports_.news().recovered = built.recovered;
  reports_.news().fidelity = built.fidelity;
  if (built.answers_command) desk_.sceneChanged(built.outcome);
}

void Room::standStill() {
  if (auto vitals = *this->vitals(); !vitals.lost) {
    vitals.lost = true;  // the rest as it was: the device does not answer
    vitals_.publish(std::move(vitals));
  }
  desk_.rejectAll(wire::rejection(v1::REJECT_REASON_BUSY, "",
                                  "the device failed and the room's water is being built anew: try again"));
  announce();
}

void Room::settlePeople(TimePoint now) {
  const Roster::Turn turn = roster_.settle(now);
  for (const std::uint32_t boat_id : turn.boats_to_stop) actions_.stopBoat(boat_id);
  reports_.tellPeople(turn.is_news, now);
}

void Room::announce() {
  reports_.tell();
  diary_.people(tick(), roster_.version(), [this] { return roster_.kept(); });
  desk_.sendAnswers(outlets_);
}

void Room::publishVitals(TimePoint now) {
  next_vitals_ = now + kVitalsInterval;
  vitals_.publish({.tick = tick(),
                   .time_s = water_->sim().time_s(),
                   .asleep = time_.isAsleep(),
                   .lost = change_.isLost(),
                   .waiting_command_count = static_cast<std::uint32_t>(desk_.waitingCount()),
                   .dropped_frame_count = frames_.droppedCount(),
                   .tick_times = tick_meter_.times(),
                   .diagnostics = frames_.diagnostics(),
                   .fidelity_levels = water_->levelCosts().predict(tick_cost_)});
}

}  // namespace spindrift::rooms
