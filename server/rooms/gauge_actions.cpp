// Actions of gauges that people put into the water. They change nothing in it, so neither logs nor snapshots have them.
#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <spindrift/rooms/room_actions.h>

namespace spindrift::rooms {

RoomActions::Outcome RoomActions::placeGauge(const Command& command) {
  const char* const kField = "place_gauge";
  const std::uint32_t person_id = command.sender.person_id;
  const auto& of_scene = room_.water->scene().gauges();
  if (!room_.roster.isHere(person_id)) {
    return wire::rejection(v1::REJECT_REASON_FORBIDDEN, kField,
                           "only somebody in the room can place a gauge: connect first");
  }
  const auto own_count = std::ranges::count(room_.gauges, person_id, &PlacedGauge::person_id);
  if (own_count >= static_cast<std::ptrdiff_t>(kPersonMaxGauges)) {
    return wire::rejection(
        v1::REJECT_REASON_BUSY, kField,
        fmt::format("you have {} gauges in the water, {} are the most: remove one first", own_count, kPersonMaxGauges));
  }
  const std::size_t count = room_.gauges.size() + static_cast<std::size_t>(of_scene.size());
  if (count >= core::kMaxGauges) {
    return wire::rejection(v1::REJECT_REASON_BUSY, kField,
                           fmt::format("the room has {} gauges, {} are the most: somebody has to remove one first",
                                       count, core::kMaxGauges));
  }
  const v1::PlaceGauge& place = command.message.place_gauge();
  PlacedGauge gauge{.person_id = person_id, .x_m = place.x_m(), .z_m = place.z_m()};
  do {
    gauge.gauge_id = ++last_gauge_id_;
    gauge.name = fmt::format("G{}", gauge.gauge_id);
  } while (std::ranges::find(of_scene, gauge.name, &v1::Gauge::name) != of_scene.end());
  std::vector<PlacedGauge> gauges = room_.gauges;
  gauges.push_back(std::move(gauge));
  if (auto refused = putGauges(std::move(gauges))) return refused;
  new_ids_.set_gauge_id(last_gauge_id_);
  return {};
}

RoomActions::Outcome RoomActions::removeGauge(const Command& command) {
  const char* const kField = "remove_gauge.gauge_id";
  const std::uint32_t gauge_id = command.message.remove_gauge().gauge_id();
  const auto found = std::ranges::find(room_.gauges, gauge_id, &PlacedGauge::gauge_id);
  if (found == room_.gauges.end()) {
    return wire::rejection(v1::REJECT_REASON_UNKNOWN_GAUGE, kField,
                           fmt::format("there is no gauge {} that somebody has placed", gauge_id));
  }
  if (found->person_id != command.sender.person_id && command.sender.role < core::Role::kOperator) {
    return wire::rejection(v1::REJECT_REASON_NOT_YOURS, kField,
                           fmt::format("gauge {} is person {}'s", gauge_id, found->person_id));
  }
  std::vector<PlacedGauge> others = room_.gauges;
  std::erase_if(others, [&](const PlacedGauge& gauge) { return gauge.gauge_id == gauge_id; });
  return putGauges(std::move(others));
}

void RoomActions::removeGaugesOfGone() {
  std::vector<PlacedGauge> kept = room_.gauges;
  const auto isGone = [this](const PlacedGauge& gauge) { return !room_.roster.isHere(gauge.person_id); };
  if (std::erase_if(kept, isGone) > 0) (void)putGauges(std::move(kept));  // a failing device loses them all
}

void RoomActions::waterChanged(bool continues) {
  boatsChanged();
  std::vector<PlacedGauge> gauges = std::exchange(room_.gauges, {});
  if (gauges.empty()) return;
  if (continues) {
    const auto refused = putGauges(std::move(gauges));
    if (!refused) return;
    spdlog::warn("room {}: lost the gauges that people have placed: {}", room_.name, refused->message());
  }
  room_.roster.setGaugeOwners({});
}

RoomActions::Outcome RoomActions::putGauges(std::vector<PlacedGauge> gauges) {
  std::vector<sim::GaugePlace> places;
  std::set<std::uint32_t> owners;
  for (const PlacedGauge& gauge : gauges) {
    places.push_back({gauge.gauge_id, gauge.x_m, gauge.z_m});
    owners.insert(gauge.person_id);
  }
  sim::WaterSim& water = room_.water->sim();
  if (auto placed = water.placeGauges(places); !placed)
    return wire::rejection(v1::REJECT_REASON_BUSY, "", placed.error().message);
  for (PlacedGauge& gauge : gauges) gauge.history = water.placedGauge(gauge.gauge_id);
  room_.gauges = std::move(gauges);
  room_.roster.setGaugeOwners(owners);
  room_.news.gauges = true;
  return {};
}

}  // namespace spindrift::rooms
