#include <utility>

#include <spdlog/spdlog.h>

#include <spindrift/rooms/room_opener.h>
#include <spindrift/scene/scene_loader.h>

namespace spindrift::rooms {

using core::Error;
using core::ErrorCode;

core::Result<RoomOpener::Opening> RoomOpener::begin(RoomSetup setup) {
  Opening opening{.setup = std::move(setup)};
  if (auto chosen = choose(opening, state::RoomFiles::kNewest); !chosen) {
    giveUp(opening);
    return chosen.error();
  }
  return opening;
}

/// Chooses the newest snapshot before a generation, or else the start of the scene, and starts to build the water.
core::Result<void> RoomOpener::choose(Opening& opening, std::uint64_t before) {
  RoomSetup& setup = opening.setup;
  const auto named = [&](const Error& error) { return Error{error.code, "room " + setup.name + ": " + error.message}; };
  if (rules_.states) {
    auto place = rules_.states->place(setup.name, before);
    if (!place) return named(place.error());
    if (place->kept && !setup.goes_on) {
      *place = {};
      const auto aside = rules_.states->setAside(setup.name);
      if (!aside) return named(aside.error());
      spdlog::warn("room {}: there are files of an earlier room of this name; they are now in {}", setup.name,
                   aside->string());
      place = rules_.states->place(setup.name);
      if (!place) return named(place.error());
    }
    opening.place = *std::move(place);
  }
  opening.generation = opening.place.generation;
  v1::Scene start = setup.scene;
  if (const auto& kept = opening.place.kept) {
    start = kept->state->start_scene();
    scene::fillDefaults(start);
    if (before == state::RoomFiles::kNewest) {
      setup.scene = kept->state->scene();
      setup.access = kept->state->access();
      scene::fillDefaults(setup.scene);
    }
  } else if (setup.scene.name().empty()) {
    return core::invalid("room " + setup.name + ": nothing of it on disk can be used");
  }
  opening.water = builder_.build(std::move(start), water::WaterBuilder::FirstTick::kMayBeCold);
  return {};
}

core::Result<bool> RoomOpener::restore(Opening& opening, TimePoint deadline) {
  while (true) {
    auto done = tryRestore(opening, deadline);
    // A full disk or a device that fails is not a reason to give up what is there.
    if (done || done.error().code != ErrorCode::kInvalidInput || opening.generation == 0) return done;
    if (opening.room) opening.room->releaseDevice();
    opening.room.reset();
    opening.place = {};
    const std::string& name = opening.setup.name;
    const std::uint64_t refused = opening.generation;
    if (auto chosen = choose(opening, refused); !chosen) return chosen.error();
    if (opening.generation > 0) {
      spdlog::error("room {}: it cannot continue from its snapshot {}: {}; it continues from snapshot {}", name,
                    refused, done.error().message, opening.generation);
    } else {
      spdlog::error("room {}: it cannot continue from its snapshot {}: {}; it begins anew with scene {}", name, refused,
                    done.error().message, opening.setup.scene.name());
    }
  }
}

core::Result<bool> RoomOpener::tryRestore(Opening& opening, TimePoint deadline) {
  const std::string& name = opening.setup.name;
  if (!opening.room) {
    const bool waits = deadline == TimePoint::max();
    if (!waits && opening.water.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    auto water = opening.water.get();
    if (!water) return Error{water.error().code, "room " + name + ": " + water.error().message};
    (*water)->bind();
    const gpu::Context& context = (*water)->context();
    if (device_line_.empty() && !context.device().advice.empty())
      spdlog::warn("simulation runs on {}; {}", context.why(), context.device().advice);
    device_line_ = context.device().name;
    auto room = Room::begin(name, *std::move(water), rules_, builder_, outlets_, std::exchange(opening.place, {}),
                            opening.setup.access);
    if (!room) return room.error();
    opening.room = *std::move(room);
  }
  return opening.room->restoreUntil(deadline);
}

void RoomOpener::giveUp(Opening& opening) {
  const std::string& name = opening.setup.name;
  const bool is_new = opening.room && !opening.setup.goes_on;
  if (opening.room) opening.room->releaseDevice();
  opening.room.reset();
  opening.place = {};
  if (!rules_.states) return;
  if (auto removed = is_new ? rules_.states->remove(name) : rules_.states->removeUnused(name); !removed) {
    spdlog::warn("room {}: it was not opened, but its files could not be removed: {}", name, removed.error().message);
  }
}

}  // namespace spindrift::rooms
