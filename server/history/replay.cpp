#include <utility>

#include <spindrift/history/repetition.h>
#include <spindrift/history/replay.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/water/water_state.h>

namespace spindrift::history {

core::Result<ReplayOutcome> replayLog(const gpu::DeviceChoice& device, CommandLogReader& log,
                                      const std::function<void(std::uint64_t)>& progress) {
  constexpr std::uint64_t kProgressInterval_ticks = 60;
  v1::Scene start = log.header().scene();
  scene::fillDefaults(start);
  auto built = water::Water::create(device, std::move(start));
  if (!built) return built.error();
  water::RoomWater water(*std::move(built));
  water::WaterBuilder builder(device);
  Repetition repetition(water, builder);

  ReplayOutcome out;
  out.device_difference = deviceDifference(log.header(), water.device());
  std::uint64_t last_equal_tick = 0;
  while (const auto record = log.next()) {
    while (true) {
      const auto done = repetition.advance(*record, Repetition::Wait::kForNewWater);
      if (!done) return done.error();
      if (progress && water.tick() % kProgressInterval_ticks == 0) progress(water.tick());
      if (*done) break;
    }
    out.tick_count = record->tick();
    out.command_count = repetition.commandCount();
    if (record->has_recovered() && !out.recovered_tick) out.recovered_tick = record->tick();
    if (!record->has_state_hash()) continue;
    const auto found = water::recordedHash(water.sim(), log.header().state_hash_version());
    if (!found) return found.error();
    ++out.hash_count;
    if (*found != record->state_hash()) {
      out.difference = {record->tick(), last_equal_tick, record->state_hash(), *found};
      return out;
    }
    last_equal_tick = record->tick();
  }
  out.truncation = log.truncation();
  return out;
}

}  // namespace spindrift::history
