#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <spindrift/rooms/room_host.h>

namespace spindrift::rooms {
namespace {

using Clock = std::chrono::steady_clock;
using core::Error;
using core::ErrorCode;

/// Limit of waiting openings and closings.
constexpr std::size_t kChangeMaxCount = 16;
/// A room that opens repeats what happened after its snapshot for at most so long before another opening gets its turn.
constexpr std::chrono::milliseconds kRestoringSlice{20};

}  // namespace

core::Result<std::unique_ptr<RoomHost>> RoomHost::start(const gpu::DeviceChoice& device, std::vector<RoomSetup> setups,
                                                        RoomRules rules, std::size_t max_room_count,
                                                        RoomOutlets& outlets) {
  auto self = std::unique_ptr<RoomHost>(new RoomHost(outlets));
  self->rules_ = std::move(rules);
  self->max_room_count_ = max_room_count;
  self->builder_ =
      std::make_unique<water::WaterBuilder>(device, self->rules_.scenes, [raw = self.get()] { raw->wake(); });
  self->opener_ = std::make_unique<RoomOpener>(self->rules_, *self->builder_, outlets);
  std::promise<core::Result<void>> built;
  auto outcome = built.get_future();
  self->thread_ = std::thread([raw = self.get(), &built, setups = std::move(setups)]() mutable {
    auto result = raw->build(std::move(setups));
    const bool ok = static_cast<bool>(result);
    if (!ok) raw->threads_.clear();
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

RoomHost::~RoomHost() {
  stop();
}

core::Result<void> RoomHost::build(std::vector<RoomSetup> setups) {
  if (!setups.empty()) default_room_ = setups.front().name;
  std::set<std::string> names;
  for (RoomSetup& setup : setups) {
    setup.goes_on = true;
    names.insert(setup.name);
  }
  if (rules_.states && rules_.opens_kept_rooms) {
    const auto kept = rules_.states->rooms();
    if (!kept) return kept.error();
    for (const std::string& name : *kept) {
      if (names.insert(name).second) setups.push_back({.name = name, .goes_on = true});
    }
  }
  std::vector<RoomOpener::Opening> openings;
  const auto open = [&](RoomSetup setup) -> core::Result<void> {
    const bool is_kept = setup.scene.name().empty();
    auto opening = opener_->begin(std::move(setup));
    if (!opening && is_kept && opening.error().code == ErrorCode::kInvalidInput) {
      spdlog::warn("{}, so it is not opened", opening.error().message);
      return {};
    }
    if (!opening) return opening.error();
    openings.push_back(*std::move(opening));
    if (openings.size() > max_room_count_) return tooManyRooms(names);
    const auto restored = opener_->restore(openings.back(), Room::TimePoint::max());
    return restored ? core::Result<void>() : restored.error();
  };
  core::Result<void> outcome;
  for (RoomSetup& setup : setups) {
    if (outcome = open(std::move(setup)); !outcome) break;
  }
  // The disk has the same few seconds for the snapshots of all rooms.
  for (RoomOpener::Opening& opening : openings) {
    if (!outcome) break;
    if (const auto kept = opening.room->isOnDisk(Room::TimePoint::max()); !kept) outcome = kept.error();
  }
  for (RoomOpener::Opening& opening : openings) {
    if (outcome)
      add(std::move(opening.room));
    else
      opener_->giveUp(opening);
  }
  return outcome;
}

Error RoomHost::tooManyRooms(const std::set<std::string>& names) const {
  return {ErrorCode::kInvalidInput,
          fmt::format("{} rooms would be opened ({}), but --max-rooms is {}: start with --max-rooms {}{}", names.size(),
                      fmt::join(names, ", "), max_room_count_, names.size(),
                      rules_.states ? fmt::format(", or move the folders of some out of {}",
                                                  (rules_.states->folder() / "rooms").string())
                                    : ", or name fewer with --room")};
}

void RoomHost::run() {
  {
    const std::lock_guard lock(mutex_);
    running_ = true;
    last_round_ = std::chrono::steady_clock::now();  // the server is ready, even if the thread has not woken up yet
  }
  wake_.notify_one();
}

void RoomHost::wake() {
  {
    const std::lock_guard lock(mutex_);
    is_woken_ = true;
  }
  wake_.notify_one();
  const std::lock_guard lock(rooms_mutex_);
  for (const auto& thread : threads_) thread->wake();
}

void RoomHost::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
  builder_->end();
}

std::vector<std::shared_ptr<Room>> RoomHost::rooms() const {
  const std::lock_guard lock(rooms_mutex_);
  std::vector<std::shared_ptr<Room>> out;
  for (const auto& thread : threads_) out.push_back(thread->room());
  return out;
}

std::shared_ptr<Room> RoomHost::find(const std::string& name) const {
  const std::lock_guard lock(rooms_mutex_);
  const auto it = std::ranges::find_if(
      threads_, [&](const auto& thread) { return name.empty() || thread->room()->name() == name; });
  return it == threads_.end() ? nullptr : (*it)->room();
}

std::string RoomHost::deviceLine() const {
  const std::lock_guard lock(rooms_mutex_);
  return device_line_;
}

double RoomHost::sinceLastRound_s() const {
  double since_s = 0.0;
  {
    const std::lock_guard lock(mutex_);
    since_s = std::chrono::duration<double>(Clock::now() - last_round_).count();
  }
  const std::lock_guard lock(rooms_mutex_);
  for (const auto& thread : threads_) since_s = std::max(since_s, thread->roundTime_s());
  return since_s;
}

double RoomHost::busyShare() const {
  double sum = 0.0;
  const std::lock_guard lock(rooms_mutex_);
  for (const auto& thread : threads_) sum += thread->busyShare();
  return sum / std::max(1u, std::thread::hardware_concurrency());
}

ServerLoad RoomHost::loadOf(const RoomThread& thread) const {
  ServerLoad load{.busy_share = std::max(thread.busyShare(), busyShare())};
  for (const auto& room : rooms()) load.people_count += room->roster().presentCount();
  return load;
}

// Opening and closing

void RoomHost::openRoom(RoomSetup setup, const Done& done) {
  auto shared = std::make_shared<RoomSetup>(std::move(setup));
  carryOut({[this, shared, done] { open(std::move(*shared), done); }, done});
}

void RoomHost::closeRoom(std::string name, std::function<void(const Room&)> before, const Done& done) {
  carryOut({[this, name = std::move(name), before = std::move(before), done] { done(close(name, before)); }, done});
}

void RoomHost::giveUpRoom(std::string name, std::function<void(const Room&)> before, const Done& done) {
  carryOut({[this, name = std::move(name), before = std::move(before), done] {
              if (const auto room = find(name)) end(room, before);
              done({});
            },
            done});
}

void RoomHost::carryOut(Change change) {
  {
    const std::lock_guard lock(mutex_);
    if (!stopping_ && changes_.size() < kChangeMaxCount) {
      changes_.push_back(std::move(change));
      wake_.notify_one();
      return;
    }
  }
  change.done(core::unavailable("too many rooms are being opened or closed: try again"));
}

void RoomHost::open(RoomSetup setup, Done done) {
  if (rooms().size() + openings_.size() >= max_room_count_) {
    return done(
        core::unavailable(fmt::format("the limit of {} rooms is reached: close one, or start the server with more "
                                      "--max-rooms",
                                      max_room_count_)));
  }
  if (find(setup.name) ||
      std::ranges::any_of(openings_, [&](const auto& one) { return one.setup.name == setup.name; })) {
    return done(core::invalid("there is a room '" + setup.name + "' already: choose another name"));
  }
  auto opening = opener_->begin(std::move(setup));
  if (!opening) return done(opening.error());
  openings_.push_back(*std::move(opening));
  openings_.back().done = std::move(done);
}

void RoomHost::advanceOpenings() {
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
      opener_->giveUp(*opening);
      opening->done(is_open.error());
    }
    opening = openings_.erase(opening);
  }
}

core::Result<bool> RoomHost::advance(RoomOpener::Opening& opening) {
  const auto now = Clock::now();
  auto restored = opener_->restore(opening, now + kRestoringSlice);
  return restored && *restored ? opening.room->isOnDisk(now) : restored;
}

void RoomHost::add(std::shared_ptr<Room> room) {
  room->unbind();
  builder_->yieldToRooms();
  auto thread = std::make_unique<RoomThread>(room);
  room->loadFrom([this, own = thread.get()] { return loadOf(*own); });
  const std::lock_guard lock(rooms_mutex_);
  device_line_ = opener_->deviceLine();
  threads_.push_back(std::move(thread));
}

core::Result<void> RoomHost::close(const std::string& name, const std::function<void(const Room&)>& before) {
  const auto room = find(name);
  if (!room) return core::invalid("there is no room '" + name + "'");
  if (name == default_room_) {
    return core::invalid("room '" + name + "' is the default room: it stays as long as the server");
  }
  end(room, before);
  return rules_.states ? rules_.states->remove(name) : core::Result<void>{};
}

void RoomHost::end(const std::shared_ptr<Room>& room, const std::function<void(const Room&)>& before) {
  std::unique_ptr<RoomThread> thread;
  {
    const std::lock_guard lock(rooms_mutex_);
    const auto found = std::ranges::find_if(threads_, [&](const auto& one) { return one->room() == room; });
    thread = std::move(*found);
    threads_.erase(found);
  }
  thread->stop();
  before(*room);
  room->abandonCommands();
  summary_.push_back(room->summary(std::chrono::steady_clock::now()));
  outlets_.closed(*room);
  room->releaseDevice();
}

void RoomHost::loop() {
  std::unique_lock lock(mutex_);
  wake_.wait(lock, [&] { return stopping_ || running_; });
  const auto startThreads = [this] {
    const std::lock_guard rooms_lock(rooms_mutex_);
    for (const auto& thread : threads_) thread->start();
  };
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
    for (const Change& change : changes) change.run();
    advanceOpenings();
    startThreads();
    auto due = Clock::now() + std::chrono::milliseconds(100);
    if (std::ranges::any_of(openings_, [](const auto& opening) { return opening.room != nullptr; }))
      due = Clock::now() + std::chrono::milliseconds(1);
    lock.lock();
    wake_.wait_until(lock, due, [&] { return stopping_ || !changes_.empty() || std::exchange(is_woken_, false); });
  }
  const auto changes = std::exchange(changes_, {});
  lock.unlock();
  const Error shut_down{ErrorCode::kUnavailable, "the server shuts down"};
  for (const Change& change : changes) change.done(shut_down);
  for (RoomOpener::Opening& opening : std::exchange(openings_, {})) {
    opener_->giveUp(opening);
    opening.done(shut_down);
  }
  for (const auto& thread : threads_) thread->end();
  for (const auto& thread : threads_) thread->stop();
  const auto saved_until = Clock::now() + rules_.disk_patience;
  for (const auto& room : rooms()) {
    if (auto kept = room->saveUntil(saved_until); !kept)
      spdlog::error("room {}: it ends without a last snapshot: {}; it continues from the one before and its log",
                    room->name(), kept.error().message);
    summary_.push_back(room->summary(std::chrono::steady_clock::now()));
    room->releaseDevice();
  }
}

}  // namespace spindrift::rooms
