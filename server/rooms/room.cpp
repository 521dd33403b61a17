#include <algorithm>
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
/// Time from the last command or request until a room without clients may sleep: who splashes and asks for the surface
/// now and then sees time advance.
constexpr auto kUsePatience = 10s;
/// So long a room runs at first although nobody watches: the sea of open_water has 95 % of its height after 10 s.
constexpr auto kSettling = 20s;
constexpr std::size_t kHashAskedMaxCount = 16;

}  // namespace

// Opening

Room::Room(std::string name, const RoomRules& rules, water::WaterBuilder& builder, RoomOutlets& outlets,
           std::unique_ptr<water::RoomWater> room_water, history::Diary diary, v1::RoomAccess access)
    : data_{.self = *this,
            .name = std::move(name),
            .access = std::move(access),
            .rules = rules,
            .builder = builder,
            .outlets = outlets,
            .water = std::move(room_water),
            .diary = std::move(diary),
            .roster = Roster(rules.grace, [this] { wake(); })} {
  if (data_.water->scene().unwatched() != v1::UNWATCHED_SLEEP)
    used_until_ = std::chrono::steady_clock::now() + kSettling;
  data_.tick_cost.restart(data_.water->warmTick_ms(), data_.water->work());
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
  data_.tick_cost.restart(data_.water->warmTick_ms(), data_.water->work());
  reports_.begin();
  publishVitals({});
  return true;
}

core::Result<void> Room::saveUntil(TimePoint deadline) {
  if (change_.isLost()) return {};
  data_.water->bind();
  return keeping_.saveUntil(deadline);
}

std::string Room::summary(TimePoint now) const {
  return fmt::format("room {}: {} ticks, real-time factor {:.2f}, {} frames dropped, watchdog stepped in {} times",
                     data_.name, tick(), data_.time.meanRealTimeFactor(now), frames_.droppedCount(),
                     data_.water->sim().recoveredCount());
}

void Room::releaseDevice() {
  data_.water.reset();
  if (data_.diary.keeper()) data_.diary.keeper()->finish();
}

// Any thread

std::optional<wire::CommandRejection> Room::admit(Command command) {
  auto refused = desk_.admit(std::move(command), *reports_.snapshot());
  if (!refused) use();
  return refused;
}

void Room::use() {
  used_until_ = std::max(used_until_.load(), std::chrono::steady_clock::now() + kUsePatience);
  wake();
}

void Room::askStateHash(HashDone done) {
  {
    const std::lock_guard lock(hash_mutex_);
    if (hash_asked_.size() < kHashAskedMaxCount) {
      hash_asked_.push_back(std::move(done));
      done = nullptr;
    }
  }
  if (done) return done(core::unavailable(fmt::format("{} requests wait for the hash: try again", kHashAskedMaxCount)));
  wake();
}

bool Room::askForSnapshot() {
  if (!data_.diary.keeper()) return false;
  data_.diary.keeper()->ask();
  wake();
  return true;
}

std::optional<history::StateKeeper::Status> Room::keptStatus() const {
  if (!data_.diary.keeper()) return std::nullopt;
  return data_.diary.keeper()->status();
}

void Room::wake() {
  if (!is_woken_.exchange(true) && on_wake_) on_wake_();
}

// One round

Room::TimePoint Room::due() const {
  const bool stands_still = change_.stopsTime() || !data_.time.runs();
  TimePoint next = stands_still ? ran_ + kStandingInterval : data_.time.due();
  const auto no_later_than = [&next](TimePoint when) { next = std::min(next, when); };
  if (const auto change = change_.due(ran_)) no_later_than(*change);
  const bool awaits_device = data_.water->sim().framesInFlight() > 0 || queries_.isWaiting() || hulls_.isWaiting();
  if (!change_.isLost() && awaits_device) no_later_than(ran_ + kReadbackPollInterval);
  if (!stands_still) return next;
  if (is_woken_ || (data_.time.stepsToCome() > 0 && !change_.stopsTime())) return ran_;
  if (hasHeldTicks()) no_later_than(data_.time.due());
  if (const auto silent = data_.clock.expiry()) no_later_than(*silent);
  if (desk_.hasWork()) no_later_than(ran_ + kWaitingCommandInterval);
  if (const auto people = reports_.due()) no_later_than(*people);
  if (!change_.stopsTime() && (data_.time.isPaused() || data_.clock.isHeld()) && data_.demand->sessionCount() > 0)
    no_later_than(data_.schedule.idleDue());
  return next;
}

void Room::run(TimePoint now) {
  is_woken_ = false;
  ++round_count_;
  ran_ = now;
  data_.water->bind();
  data_.water->reloadChangedShaders();
  if (const auto built = change_.takeBuilt(now)) waterChanged(*built, now);
  if (change_.watchDevice(now)) return standStill();
  data_.time.beginRound(now);
  handOver();
  if (data_.time.watchOver(isNeeded(now), now)) publishVitals(now);
  settlePeople(now);
  actions_.reviewClock(now,
                       [this](const core::Sender& sender) { return change_.stopsTime() || desk_.isBusyWith(sender); });
  desk_.finishRelayout();
  if (!data_.time.runs() || now >= data_.time.due()) desk_.carryOut(now);
  reports_.tellGame(now);
  announce();
  queries_.sample(QueryBook::Which::kNew);  // the tick of their Ack
  if (change_.stopsTime()) {
    // The state stands still until the particles are laid out.
  } else if (data_.clock.isHeld()) {
    advanceHeld(now);
  } else if (data_.time.isPaused()) {
    advancePaused(now);
  } else if (data_.time.runs() && now >= data_.time.due()) {
    step(now);
  }
  desk_.finishSteps();
  answerHashes();
  if (reports_.tellRecovery(now)) actions_.boatsChanged();
  if (!change_.stopsTime()) keeping_.keep(now);
  handOver();
  if (now >= next_vitals_) publishVitals(now);
}

bool Room::isNeeded(TimePoint now) const {
  return data_.water->scene().unwatched() == v1::UNWATCHED_GO_ON || data_.clock.isHeld() ||
         data_.demand->sessionCount() > 0 || now < used_until_.load();
}

void Room::handOver() {
  frames_.handOver();
  queries_.handOver();
  hulls_.handOver();
}

void Room::step(TimePoint now) {
  const TimePoint scheduled = data_.time.due();
  const TimePoint end = timedStep();
  data_.time.ticked(now, end);
  restartIfOver();
  actions_.advanceGame();
  frames_.afterTick(scheduled, end, data_.time.speed());
  reports_.tellStrokes(end);
  data_.time.warnIfSlow(data_.name, end);
  change_.adapt(end);
}

void Room::advancePaused(TimePoint now) {
  if (data_.time.stepsToCome() > 0) {
    now = timedStep();
    actions_.advanceGame();
    if (data_.time.stepped()) data_.schedule.setIdleDue(now);  // what was asked for is there to see at once
  }
  frames_.whilePaused(now);
}

bool Room::hasHeldTicks() const {
  // What a command builds takes its place at the tick at which the command came.
  return data_.clock.ticksToCome() > 0 && !change_.stopsTime() && !change_.isBuildingForCommand();
}

void Room::advanceHeld(TimePoint now) {
  if (hasHeldTicks() && now >= data_.time.due()) {
    const double speed = data_.clock.speed();
    const TimePoint scheduled = std::max(now, data_.time.due());
    now = timedStep();
    data_.time.heldTicked(speed, now);
    data_.clock.ticked(now);
    actions_.advanceGame();
    reports_.tellStrokes(now);
    if (data_.clock.ticksToCome() == 0)
      data_.schedule.setIdleDue(now);  // what was asked for is there to see at once
    else
      frames_.afterTick(scheduled, now, speed > 0 ? speed : std::max(1.0, data_.time.realTimeFactor()));
  }
  frames_.whilePaused(now);
}

void Room::answerHashes(const std::string& error) {
  std::vector<HashDone> asked;
  {
    const std::lock_guard lock(hash_mutex_);
    asked = std::exchange(hash_asked_, {});
  }
  if (asked.empty()) return;
  const auto state = error.empty() ? core::Result<HashedState>(HashedState{tick(), stateHash()})
                                   : core::Result<HashedState>(core::unavailable(error));
  for (const HashDone& done : asked) done(state);
}

Room::TimePoint Room::timedStep() {
  const auto begin = std::chrono::steady_clock::now();
  data_.water->step();
  const auto end = std::chrono::steady_clock::now();
  const double step_ms = std::chrono::duration<double, std::milli>(end - begin).count();
  data_.tick_cost.note(step_ms);
  data_.tick_meter.note(step_ms);
  data_.steps.ticked();
  data_.diary.ticked();
  queries_.sample(QueryBook::Which::kDue);
  hulls_.ticked();
  return end;
}

void Room::restartIfOver() {
  const double after_s = data_.water->scene().restart_after_s();
  if (after_s <= 0 || data_.water->sim().time_s() < after_s) return;
  Command again;
  again.message.mutable_reset();
  (void)actions_.reset(again);  // refused while the disk is full: tried again at the next tick
}

void Room::waterChanged(const WaterChange::Built& built, TimePoint now) {
  using Water = WaterChange::Built::Water;
  if (built.water != Water::kSame) {
    frames_.restart();
    data_.tick_meter.restart();
    if (built.water != Water::kContinues) {
      data_.referee.end();
      data_.roster.keepOnly({});  // the boats of a new scene have no owner yet, whatever their ids
    }
    actions_.waterChanged(built.water == Water::kContinues);
    queries_.waterChanged(built.water == Water::kContinues);
    if (built.water != Water::kContinues) actions_.dropSteps("the scene has changed: the steps have ended");
    hulls_.waterChanged();
    publishVitals(now);
    reports_.sceneChanged();
  }
  data_.news.recovered = built.recovered;
  data_.news.fidelity = built.fidelity;
  if (built.answers_command) desk_.sceneChanged(built.outcome);
}

void Room::standStill() {
  if (auto vitals = *this->vitals(); !vitals.lost) {
    vitals.lost = true;  // the rest as it was: the device does not answer
    vitals_.publish(std::move(vitals));
  }
  actions_.dropSteps("the device failed: the steps have ended");
  answerHashes("the device failed and the room's water is being built anew");
  desk_.rejectAll(wire::rejection(v1::REJECT_REASON_BUSY, "",
                                  "the device failed and the room's water is being built anew: try again"));
  announce();
}

void Room::settlePeople(TimePoint now) {
  const Roster::Turn turn = data_.roster.settle(now);
  for (const std::uint32_t boat_id : turn.boats_to_stop) actions_.stopBoat(boat_id);
  if (turn.is_news) {
    actions_.removeGaugesOfGone();
    queries_.removeOfGone();
  }
  reports_.tellPeople(turn.is_news, now);
}

void Room::announce() {
  reports_.tell();
  data_.diary.people(data_.roster.version(), [this] { return data_.roster.kept(); });
  desk_.sendAnswers();
}

void Room::publishVitals(TimePoint now) {
  next_vitals_ = now + kVitalsInterval;
  vitals_.publish({.tick = tick(),
                   .time_s = data_.water->sim().time_s(),
                   .asleep = data_.time.isAsleep(),
                   .lost = change_.isLost(),
                   .waiting_command_count = static_cast<std::uint32_t>(desk_.waitingCount()),
                   .device_bytes = data_.water->deviceBytes(),
                   .dropped_frame_count = frames_.droppedCount(),
                   .tick_times = data_.tick_meter.times(),
                   .diagnostics = frames_.diagnostics(),
                   .fidelity_levels = data_.water->levelCosts().predict(data_.tick_cost)});
}

}  // namespace spindrift::rooms
