#include <variant>

#include <fmt/format.h>

#include <spindrift/rooms/replay.h>
#include <spindrift/rooms/room_water.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::rooms {
namespace {

using core::Error;
using core::ErrorCode;

core::Result<void> carryOut(RoomWater& water, const v1::Record& record) {
  const auto failed = [&](const std::string& why) {
    return Error{ErrorCode::kCheckFailed,
                 fmt::format("tick {}: a command of the log is not carried out now: {}", record.tick(), why)};
  };
  const auto checked = wire::checkCommand(record.command());
  if (const auto* rejected = std::get_if<wire::CommandRejection>(&checked)) {
    return failed(rejected->field + " " + rejected->message);
  }
  const auto& command = std::get<v1::Command>(checked);
  if (!RoomWater::takes(command)) return failed("it is of a kind that no log holds");
  if (auto rejected = water.apply(command)) return failed(rejected->field + " " + rejected->message);
  return {};
}

}  // namespace

core::Result<ReplayOutcome> replayLog(const gpu::DeviceChoice& device, CommandLogReader& log,
                                      const std::function<void(std::uint64_t)>& progress) {
  constexpr std::uint64_t kProgressInterval_ticks = 60;
  v1::Scene start = log.header().scene();
  scene::fillDefaults(start);
  auto water = Water::create(device, std::move(start));
  if (!water) return water.error();
  RoomWater room_water(*std::move(water));

  ReplayOutcome out;
  out.device_difference = deviceDifference(log.header(), room_water.device());
  std::uint64_t last_equal_tick = 0;
  while (const auto record = log.next()) {
    const bool changes_water = record->has_scene() || record->has_continued_scene();
    while (room_water.tick() < record->tick() && !changes_water) {
      room_water.step();
      if (const auto& error = room_water.sim().deviceError()) return *error;
      if (progress && room_water.tick() % kProgressInterval_ticks == 0) progress(room_water.tick());
    }
    out.tick_count = record->tick();
    switch (record->what_case()) {
      case v1::Record::kCommand:
        if (auto done = carryOut(room_water, *record); !done) return done.error();
        ++out.command_count;
        break;
      case v1::Record::kScene:
      case v1::Record::kContinuedScene: {
        // The record was written after the change, which takes one tick.
        while (room_water.tick() + 1 < record->tick()) {
          room_water.step();
          if (const auto& error = room_water.sim().deviceError()) return *error;
        }
        v1::Scene scene = record->has_scene() ? record->scene() : record->continued_scene();
        scene::fillDefaults(scene);
        auto next = Water::create(device, std::move(scene));
        if (!next) return next.error();
        if (record->has_scene()) {
          room_water.replaceWater(*std::move(next)).reset();
        } else {
          room_water.bind();
          if (auto done = room_water.continueIn(*next); !done) return done.error();
          next->reset();
        }
        room_water.bind();  // the old water's destructor left no context current
        break;
      }
      case v1::Record::kStateHash: {
        const std::uint64_t found = room_water.sim().stateHash();
        ++out.hash_count;
        if (found != record->state_hash()) {
          out.difference = {record->tick(), last_equal_tick, record->state_hash(), found};
          return out;
        }
        last_equal_tick = record->tick();
        break;
      }
      case v1::Record::kRecovered:
        if (!out.recovered_tick) out.recovered_tick = record->tick();
        break;
      case v1::Record::kHeader:
      case v1::Record::WHAT_NOT_SET:
        break;
    }
  }
  out.truncation = log.truncation();
  return out;
}

}  // namespace spindrift::rooms
