#include <utility>

#include <fmt/format.h>

#include <spindrift/rooms/room_reports.h>
#include <spindrift/water/water_state.h>

namespace spindrift::rooms {
namespace {

/// When many clients join at once, they are announced in a few lists instead of one list each.
constexpr std::chrono::milliseconds kPeopleNewsInterval{200};
constexpr std::chrono::milliseconds kStrokeNewsInterval{33};

}  // namespace

void RoomReports::begin() {
  recovery_news_.restart(parts_.water.sim().recoveredCount());
  boats_ = parts_.water.boats();
  publishSnapshot();
}

void RoomReports::sceneChanged() {
  news_ = {};
  begin();
  parts_.outlets.sceneChanged(parts_.room);
}

void RoomReports::publishSnapshot() {
  snapshot_.publish({parts_.water.scene(), parts_.water.sceneVersion(), parts_.time.isPaused(), parts_.time.speed(),
                     boats_, parts_.water.sim().reducedCounts(), parts_.water.sim().gauges()});
}

void RoomReports::tell() {
  const News news = std::exchange(news_, {});
  RoomOutlets& outlets = parts_.outlets;
  if (news.state || !news.parameters.empty()) publishSnapshot();
  if (news.state) outlets.timeChanged(parts_.room, parts_.time.isPaused(), parts_.time.speed());
  for (const auto& [path, value] : news.parameters) outlets.parameterChanged(parts_.room, path, value);
  if (news.reset) outlets.wasReset(parts_.room);
  if (!news.recovered.empty()) outlets.hasRecovered(parts_.room, news.recovered);
  if (!news.fidelity.empty()) outlets.fidelityChanged(parts_.room, news.fidelity);
  if (news.boats) tellBoats();
}

void RoomReports::tellBoats() {
  const std::string before = boats_.SerializeAsString();
  boats_ = parts_.water.boats();
  if (boats_.SerializeAsString() == before) return;
  publishSnapshot();
  parts_.outlets.boatsChanged(parts_.room, boats_);
}

void RoomReports::tellPeople(bool is_news, TimePoint now) {
  has_people_news_ = has_people_news_ || is_news;
  if (!has_people_news_ || now < next_people_news_) return;
  has_people_news_ = false;
  next_people_news_ = now + kPeopleNewsInterval;
  parts_.outlets.peopleChanged(parts_.room, parts_.roster.people());
}

void RoomReports::tellStrokes(TimePoint now) {
  const std::vector<sim::Stroke>& active = parts_.water.sim().strokes();
  if (active.empty() && !has_told_strokes_) return;
  if (!active.empty() && now < next_stroke_news_) return;
  has_told_strokes_ = !active.empty();
  next_stroke_news_ = now + kStrokeNewsInterval;
  v1::Strokes out;
  out.set_time_s(parts_.water.sim().time_s());
  for (const sim::Stroke& stroke : active) {
    v1::Finger& finger = *out.add_fingers();
    finger.set_person_id(stroke.person_id);
    finger.set_stroke_id(stroke.stroke_id);
    finger.set_x_m(stroke.x_m);
    finger.set_z_m(stroke.z_m);
    finger.set_radius_m(stroke.radius_m);
    finger.set_tool(water::toMessage(stroke.tool));
  }
  parts_.outlets.strokesChanged(parts_.room, out);
}

bool RoomReports::tellRecovery(TimePoint now) {
  const std::uint64_t count = parts_.water.sim().recoveredCount();
  if (!recovery_news_.tell(count, now)) return false;
  parts_.outlets.hasRecovered(
      parts_.room, fmt::format("the watchdog put the water back to its last good state ({} times so far)", count));
  return true;
}

std::optional<RoomReports::TimePoint> RoomReports::due() const {
  return has_people_news_ ? std::optional(next_people_news_) : std::nullopt;
}

}  // namespace spindrift::rooms
