#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <spindrift/rooms/simulation_thread.h>
#include <spindrift/scene/scene_loader.h>

namespace spindrift::rooms {
namespace {

using core::Error;
using core::ErrorCode;

/// Limit of waiting openings and closings.
constexpr std::size_t kChangeMaxCount = 16;
/// A room that opens repeats what happened after its snapshot for at most so long at a time.
constexpr std::chrono::milliseconds kRestoringSlice{20};

/// Share of its time that a thread works, over the last window that is complete.
class BusyShare {
 public:
  using Clock = std::chrono::steady_clock;
  explicit BusyShare(Clock::time_point now) : begin_(now) {}
  void waited(Clock::time_point from, Clock::time_point to) {
    waited_ += to - from;
    if (to - begin_ < kWindow) return;
    share_ = 1.0 - std::chrono::duration<double>(waited_) / std::chrono::duration<double>(to - begin_);
    begin_ = to;
    waited_ = {};
  }
  [[nodiscard]] double value() const { return share_; }

 private:
  static constexpr std::chrono::seconds kWindow{2};
  Clock::time_point begin_;
  Clock::duration waited_{};
  double share_ = 0.0;
};

}  // namespace

core::Result<std::unique_ptr<SimulationThread>> SimulationThread::start(const gpu::DeviceChoice& device,
                                                                        std::vector<RoomSetup> setups, RoomRules rules,
                                                                        std::size_t max_room_count,
                                                                        RoomOutlets& outlets) {
  auto self = std::unique_ptr<SimulationThread>(new SimulationThread(outlets));
  self->rules_ = std::move(rules);
  self->max_room_count_ = std::max(max_room_count, setups.size());
  self->builder_ = std::make_unique<WaterBuilder>(device, [raw = self.get()] { raw->wake(); });
  std::promise<core::Result<void>> built;
  auto outcome = built.get_future();
  self->thread_ = std::thread([raw = self.get(), &built, setups = std::move(setups)]() mutable {
    auto result = raw->build(std::move(setups));
    const bool ok = static_cast<bool>(result);
    if (!ok) raw->rooms_.clear();
    built.set_value(std::move(result));
    if (ok) raw->loop();
  });
  auto result = outcome.get();
  if (!result) {
    self->thread_.join();
    return result.error();
  }
  return self;
}

SimulationThread::~SimulationThread() {
  stop();
}

core::Result<void> SimulationThread::build(std::vector<RoomSetup> setups) {
  for (RoomSetup& setup : setups) {
    const std::string name = setup.name;
    if (auto built = buildRoom(name, std::move(setup)); !built) return built;
  }
  if (!rules_.states || !rules_.opens_kept_rooms) return {};
  const auto kept = rules_.states->rooms();
  if (!kept) return kept.error();
  for (const std::string& name : *kept) {
    if (find(name)) continue;
    if (auto built = buildRoom(name, std::nullopt); !built) return built;
  }
  max_room_count_ = std::max(max_room_count_, rooms().size());
  return {};
}

core::Result<RoomPlace> SimulationThread::placeOf(const std::string& name) const {
  if (!rules_.states) return RoomPlace{};
  auto place = rules_.states->place(name);
  if (!place) return Error{place.error().code, "room " + name + ": " + place.error().message};
  return place;
}

core::Result<void> SimulationThread::buildRoom(const std::string& name, std::optional<RoomSetup> setup) {
  auto place = placeOf(name);
  if (!place) return place.error();
  if (place->kept) {
    v1::Scene start = place->kept->state->start_scene();
    scene::fillDefaults(start);
    v1::Scene scene = place->kept->state->scene();
    v1::RoomAccess access = place->kept->state->access();
    scene::fillDefaults(scene);
    auto added = buildRoom(name, std::move(start), *std::move(place), {});
    // A full disk or a device that fails is no reason to give up what is there.
    if (added || added.error().code != ErrorCode::kInvalidInput) return added;
    const auto aside = rules_.states->setAside(name);
    if (!aside) return Error{aside.error().code, "room " + name + ": " + aside.error().message};
    spdlog::error(
        "room {}: it cannot go on from its state on disk, which is now in {}: {}; it begins anew with scene {}", name,
        aside->string(), added.error().message, scene.name());
    place = placeOf(name);
    if (!place) return place.error();
    setup = RoomSetup{.name = name, .scene = std::move(scene), .access = std::move(access)};
  }
  if (!setup) {
    spdlog::warn("room {}: nothing of it on disk can be used, so it is not opened; {} stays as it is", name,
                 rules_.states->folder().string());
    return {};
  }
  return buildRoom(name, std::move(setup->scene), *std::move(place), std::move(setup->access));
}

core::Result<void> SimulationThread::buildRoom(const std::string& name, v1::Scene scene, RoomPlace place,
                                               v1::RoomAccess access) {
  auto room = begin(name, builder_->build(std::move(scene)).get(), std::move(place), std::move(access));
  if (!room) return room.error();
  if (auto restored = (*room)->restoreUntil(std::chrono::steady_clock::time_point::max()); !restored)
    return restored.error();
  add(*std::move(room));
  return {};
}

void SimulationThread::run() {
  {
    const std::lock_guard lock(mutex_);
    running_ = true;
    last_round_ = std::chrono::steady_clock::now();  // the server is ready, even if the thread has not woken up yet
  }
  wake_.notify_one();
}

void SimulationThread::wake() {
  {
    const std::lock_guard lock(mutex_);
    is_woken_ = true;
  }
  wake_.notify_one();
}

void SimulationThread::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
  builder_->end();
}

std::vector<std::shared_ptr<Room>> SimulationThread::rooms() const {
  const std::lock_guard lock(rooms_mutex_);
  return rooms_;
}

std::shared_ptr<Room> SimulationThread::find(const std::string& name) const {
  const std::lock_guard lock(rooms_mutex_);
  if (name.empty()) return rooms_.empty() ? nullptr : rooms_.front();
  const auto it = std::ranges::find_if(rooms_, [&](const auto& room) { return room->name() == name; });
  return it == rooms_.end() ? nullptr : *it;
}

std::string SimulationThread::deviceLine() const {
  const std::lock_guard lock(rooms_mutex_);
  return device_line_;
}

double SimulationThread::sinceLastRound_s() const {
  const std::lock_guard lock(mutex_);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - last_round_).count();
}

// Opening and closing

void SimulationThread::openRoom(RoomSetup setup, const Done& done) {
  auto shared = std::make_shared<RoomSetup>(std::move(setup));
  carryOut(
      [this, shared, done](bool runs) {
        if (runs) return open(std::move(*shared), done);
        done(Error{ErrorCode::kUnavailable, "the server shuts down"});
      },
      done);
}

void SimulationThread::closeRoom(std::string name, std::function<void(const Room&)> before, const Done& done) {
  carryOut(
      [this, name = std::move(name), before = std::move(before), done](bool runs) {
        done(runs ? close(name, before) : Error{ErrorCode::kUnavailable, "the server shuts down"});
      },
      done);
}

void SimulationThread::giveUpRoom(std::string name, std::function<void(const Room&)> before, const Done& done) {
  carryOut(
      [this, name = std::move(name), before = std::move(before), done](bool runs) {
        if (!runs) return done(Error{ErrorCode::kUnavailable, "the server shuts down"});
        if (const auto room = find(name)) end(room, before);
        done({});
      },
      done);
}

void SimulationThread::carryOut(Change change, const Done& done) {
  {
    const std::lock_guard lock(mutex_);
    if (!stopping_ && changes_.size() < kChangeMaxCount) {
      changes_.push_back(std::move(change));
      wake_.notify_one();
      return;
    }
  }
  done(Error{ErrorCode::kUnavailable, "too many rooms are being opened or closed: try again"});
}

void SimulationThread::open(RoomSetup setup, Done done) {
  if (rooms().size() + openings_.size() >= max_room_count_) {
    return done(Error{ErrorCode::kUnavailable,
                      fmt::format("there are {} rooms, as many as may be: close one, or start the server with more "
                                  "--max-rooms",
                                  max_room_count_)});
  }
  if (find(setup.name) || std::ranges::any_of(openings_, [&](const auto& one) { return one.name == setup.name; })) {
    return done(Error{ErrorCode::kInvalidInput, "there is a room '" + setup.name + "' already: choose another name"});
  }
  auto place = placeOf(setup.name);
  if (!place) return done(place.error());
  if (!setup.goes_on) place->kept.reset();  // of a room of this name that could not be opened: the new one is another
  if (place->kept) {
    setup.scene = place->kept->state->start_scene();
    scene::fillDefaults(setup.scene);
  } else if (setup.scene.name().empty()) {
    return done(Error{ErrorCode::kInvalidInput, "room " + setup.name + ": nothing of it on disk can be used"});
  }
  openings_.push_back({.name = std::move(setup.name),
                       .place = *std::move(place),
                       .access = std::move(setup.access),
                       .water = builder_->build(std::move(setup.scene)),
                       .room = nullptr,
                       .done = std::move(done)});
}

void SimulationThread::advanceOpenings() {
  for (auto opening = openings_.begin(); opening != openings_.end();) {
    const auto is_open = advance(*opening);
    if (is_open && !*is_open) {
      ++opening;
      continue;
    }
    if (is_open) {
      add(std::move(opening->room));
      opening->done({});
    } else {
      spdlog::warn("a room was not opened: {}", is_open.error().message);
      if (opening->room) opening->room->releaseDevice();
      opening->done(is_open.error());
    }
    opening = openings_.erase(opening);
  }
}

core::Result<bool> SimulationThread::advance(Opening& opening) {
  if (!opening.room) {
    if (opening.water.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    auto room = begin(opening.name, opening.water.get(), std::move(opening.place), std::move(opening.access));
    if (!room) return room.error();
    opening.room = *std::move(room);
  }
  // The rooms that run come first; the one that opens makes a tick between theirs at least.
  const auto now = std::chrono::steady_clock::now();
  auto deadline = now + kRestoringSlice;
  for (const auto& room : rooms_) deadline = std::min(deadline, room->due());
  return opening.room->restoreUntil(deadline);
}

core::Result<std::shared_ptr<Room>> SimulationThread::begin(std::string name, WaterBuilder::Built water,
                                                            RoomPlace place, v1::RoomAccess access) {
  if (!water) return Error{water.error().code, "room " + name + ": " + water.error().message};
  (*water)->bind();
  {
    const std::lock_guard lock(rooms_mutex_);
    const gpu::Context& context = (*water)->context();
    if (device_line_.empty() && !context.device().advice.empty())
      spdlog::warn("simulation runs on {}; {}", context.why(), context.device().advice);
    device_line_ = context.device().name;
  }
  return Room::begin(std::move(name), *std::move(water), rules_, *builder_, outlets_, std::move(place),
                     std::move(access));
}

void SimulationThread::add(std::shared_ptr<Room> room) {
  room->start(std::chrono::steady_clock::now());
  room->onWake([this] { wake(); });
  const std::lock_guard lock(rooms_mutex_);
  rooms_.push_back(std::move(room));
}

core::Result<void> SimulationThread::close(const std::string& name, const std::function<void(const Room&)>& before) {
  const auto room = find(name);
  if (!room) return Error{ErrorCode::kInvalidInput, "there is no room '" + name + "'"};
  if (room == find("")) {
    return Error{ErrorCode::kInvalidInput, "room '" + name + "' is the default room: it stays as long as the server"};
  }
  end(room, before);
  return rules_.states ? rules_.states->remove(name) : core::Result<void>{};
}

void SimulationThread::end(const std::shared_ptr<Room>& room, const std::function<void(const Room&)>& before) {
  {
    const std::lock_guard lock(rooms_mutex_);
    std::erase(rooms_, room);
  }
  before(*room);
  room->abandonCommands();
  summarise(*room);
  outlets_.closed(*room);
  room->releaseDevice();
}

void SimulationThread::summarise(const Room& room) {
  summary_.push_back(
      fmt::format("room {}: {} ticks, real-time factor {:.2f}, {} frames dropped, watchdog stepped in {} times",
                  room.name(), room.tick(), room.meanRealTimeFactor(std::chrono::steady_clock::now()),
                  room.droppedFrameCount(), room.water().recoveredCount()));
}

void SimulationThread::loop() {
  using Clock = std::chrono::steady_clock;
  std::unique_lock lock(mutex_);
  wake_.wait(lock, [&] { return stopping_ || running_; });
  for (const auto& room : rooms_) room->start(Clock::now());
  BusyShare busy(Clock::now());
  while (!stopping_) {
    last_round_ = Clock::now();
    if (const auto step = clock_watch_.step(std::chrono::system_clock::now(), last_round_)) {
      ++clock_step_count_;
      spdlog::warn(
          "the system's clock was set {} by {:.0f} s{}: water, grace times and limits do not follow it; tokens end by "
          "it",
          step->count() > 0 ? "forward" : "back", std::abs(step->count()),
          step->count() > 0 ? ", or the machine slept" : "");
    }
    const auto changes = std::exchange(changes_, {});
    lock.unlock();
    for (const Change& change : changes) change(true);
    advanceOpenings();
    auto due = Clock::now() + std::chrono::milliseconds(100);
    if (std::ranges::any_of(openings_, [](const Opening& opening) { return opening.room != nullptr; }))
      due = Clock::now() + std::chrono::milliseconds(1);
    for (const auto& room : rooms_) {
      if (const auto now = Clock::now(); room->due() <= now) room->run(now, busy.value());
    }
    for (const auto& room : rooms_) due = std::min(due, room->due());
    lock.lock();
    const auto idle_since = Clock::now();
    wake_.wait_until(lock, due, [&] { return stopping_ || !changes_.empty() || std::exchange(is_woken_, false); });
    busy.waited(idle_since, Clock::now());
    busy_share_ = busy.value();
  }
  const auto changes = std::exchange(changes_, {});
  lock.unlock();
  for (const Change& change : changes) change(false);
  for (Opening& opening : std::exchange(openings_, {})) {
    if (opening.room) opening.room->releaseDevice();  // what is on disk stays as it is
    opening.done(Error{ErrorCode::kUnavailable, "the server shuts down"});
  }
  for (const auto& room : rooms_) {
    if (auto kept = room->saveAndWait(); !kept)
      spdlog::error("room {}: its last snapshot could not be written: {}", room->name(), kept.error().message);
    summarise(*room);
    room->releaseDevice();
  }
}

}  // namespace spindrift::rooms
