#include "simulation_thread.h"

#include <algorithm>

#include <fmt/format.h>

namespace spindrift::app {

core::Result<std::unique_ptr<SimulationThread>> SimulationThread::start(const gpu::DeviceChoice& device,
                                                                        std::vector<RoomSetup> setups,
                                                                        SceneCatalog scenes) {
  auto self = std::unique_ptr<SimulationThread>(new SimulationThread);
  self->scenes_ = std::move(scenes);
  std::promise<core::Result<void>> built;
  auto outcome = built.get_future();
  self->thread_ = std::thread([raw = self.get(), device, &built, setups = std::move(setups)]() mutable {
    auto result = raw->build(device, std::move(setups));
    const bool ok = static_cast<bool>(result);
    if (!ok) {
      raw->rooms_.clear();
      raw->context_.reset();
    }
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

core::Result<void> SimulationThread::build(const gpu::DeviceChoice& device, std::vector<RoomSetup> setups) {
  auto context = gpu::Context::create(device);
  if (!context) return context.error();
  context_ = *std::move(context);
  device_line_ = context_->device().name;
  for (RoomSetup& setup : setups) {
    auto room = Room::create(*context_, std::move(setup), scenes_);
    if (!room) return room.error();
    rooms_.push_back(*std::move(room));
  }
  return {};
}

void SimulationThread::run(net::Hub& hub, EncoderThread& encoder, RoomObserver& observer) {
  {
    const std::lock_guard lock(mutex_);
    hub_ = &hub;
    encoder_ = &encoder;
    observer_ = &observer;
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
}

Room* SimulationThread::find(const std::string& name) const {
  if (name.empty()) return rooms_.empty() ? nullptr : rooms_.front().get();
  const auto it = std::ranges::find_if(rooms_, [&](const auto& room) { return room->name() == name; });
  return it == rooms_.end() ? nullptr : it->get();
}

void SimulationThread::loop() {
  using Clock = std::chrono::steady_clock;
  std::unique_lock lock(mutex_);
  wake_.wait(lock, [&] { return stopping_ || hub_; });
  for (const auto& room : rooms_) room->start(Clock::now());
  while (!stopping_) {
    lock.unlock();
    for (const auto& room : rooms_) room->run(Clock::now(), *hub_, *encoder_, *observer_);
    const auto now = Clock::now();
    auto due = now + std::chrono::milliseconds(100);
    for (const auto& room : rooms_) due = std::min(due, room->due(now));
    lock.lock();
    wake_.wait_until(lock, due, [&] { return stopping_; });
  }
  lock.unlock();
  for (const auto& room : rooms_) {
    const sim::WaterSim& water = room->water();
    summary_.push_back(fmt::format(
        "room {}: {} ticks, real-time factor {:.2f}, {} frames dropped, guard stepped in {} times", room->name(),
        room->tick(), room->meanRealTimeFactor(Clock::now()), room->droppedFrameCount(), water.recoveredCount()));
    room->releaseDevice();
  }
  context_.reset();
}

}  // namespace spindrift::app
