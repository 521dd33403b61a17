#include <utility>

#include <fmt/format.h>

#include <spindrift/rooms/room_reports.h>
#include <spindrift/water/water_state.h>

namespace spindrift::rooms {
namespace {

/// When many clients join at once, they are announced in a few lists instead of one list each.
constexpr std::chrono::milliseconds kPeopleNewsInterval{200};
constexpr std::chrono::milliseconds kGameNewsInterval{200};
constexpr std::chrono::milliseconds kStrokeNewsInterval{33};

}  // namespace

void RoomReports::begin() {
  recovery_news_.restart(room_.water->sim().recoveredCount());
  boats_ = room_.water->boats();
  publishSnapshot();
  lesson_.publish({room_.roster.lesson(), game_});
}

void RoomReports::sceneChanged() {
  room_.news = {};
  begin();
  room_.outlets.sceneChanged(room_.self);
}

void RoomReports::publishSnapshot() {
  const v1::RoomState now = state(0);
  snapshot_.publish({room_.water->scene(),
                     room_.water->sceneVersion(),
                     now.paused(),
                     now.speed(),
                     {now.clock_person_ids().begin(), now.clock_person_ids().end()},
                     boats_,
                     room_.water->sim().reducedCounts(),
                     room_.water->sim().gauges(),
                     room_.gauges});
}

v1::RoomState RoomReports::state(std::uint32_t person_id) const {
  v1::RoomState out;
  out.set_paused(room_.time.isPaused());
  out.set_speed(room_.time.speed());
  out.set_person_id(person_id);
  for (const HeldClock::Holder& holder : room_.clock.holders()) out.add_clock_person_ids(holder.who.person_id);
  return out;
}

void RoomReports::tell() {
  const News news = std::exchange(room_.news, {});
  RoomOutlets& outlets = room_.outlets;
  if (news.state || news.gauges || news.reset || !news.parameters.empty()) publishSnapshot();
  if (news.state) outlets.timeChanged(room_.self, state(news.state_person_id));
  if (!news.clock.empty()) outlets.clockChanged(room_.self, news.clock, news.clock_person_id);
  for (const auto& [path, value] : news.parameters) outlets.parameterChanged(room_.self, path, value);
  if (news.reset) outlets.wasReset(room_.self, news.reset_person_id);
  if (!news.recovered.empty()) outlets.hasRecovered(room_.self, news.recovered);
  if (!news.fidelity.empty()) outlets.fidelityChanged(room_.self, news.fidelity);
  if (news.boats) tellBoats();
  if (news.lesson) {
    lesson_.publish({room_.roster.lesson(), game_});
    outlets.lessonChanged(room_.self, lesson()->lesson);
  }
}

void RoomReports::tellBoats() {
  const std::string before = boats_.SerializeAsString();
  boats_ = room_.water->boats();
  if (boats_.SerializeAsString() == before) return;
  publishSnapshot();
  room_.outlets.boatsChanged(room_.self, boats_);
}

void RoomReports::tellPeople(bool is_news, TimePoint now) {
  has_people_news_ = has_people_news_ || is_news;
  if (!has_people_news_ || now < next_people_news_) return;
  has_people_news_ = false;
  next_people_news_ = now + kPeopleNewsInterval;
  room_.outlets.peopleChanged(room_.self, room_.roster.people());
}

void RoomReports::tellGame(TimePoint now) {
  const bool has_none = room_.referee.kind() == v1::GAME_KIND_UNSPECIFIED && game_.kind() == v1::GAME_KIND_UNSPECIFIED;
  if (has_none || now < next_game_news_) return;
  next_game_news_ = now + kGameNewsInterval;
  v1::Game game = room_.referee.game();
  if (game.SerializeAsString() == game_.SerializeAsString()) return;
  game_ = std::move(game);
  lesson_.publish({room_.roster.lesson(), game_});
  room_.outlets.gameChanged(room_.self, game_);
}

void RoomReports::tellStrokes(TimePoint now) {
  const std::vector<sim::Stroke>& active = room_.water->sim().strokes();
  if (active.empty() && !has_told_strokes_) return;
  if (!active.empty() && now < next_stroke_news_) return;
  has_told_strokes_ = !active.empty();
  next_stroke_news_ = now + kStrokeNewsInterval;
  v1::Strokes out;
  out.set_time_s(room_.water->sim().time_s());
  for (const sim::Stroke& stroke : active) {
    v1::Finger& finger = *out.add_fingers();
    finger.set_person_id(stroke.person_id);
    finger.set_stroke_id(stroke.stroke_id);
    finger.set_x_m(stroke.x_m);
    finger.set_z_m(stroke.z_m);
    finger.set_radius_m(stroke.radius_m);
    finger.set_tool(water::toMessage(stroke.tool));
  }
  room_.outlets.strokesChanged(room_.self, out);
}

bool RoomReports::tellRecovery(TimePoint now) {
  const std::uint64_t count = room_.water->sim().recoveredCount();
  if (!recovery_news_.tell(count, now)) return false;
  room_.outlets.hasRecovered(
      room_.self, fmt::format("the watchdog put the water back to its last good state ({} times so far)", count));
  return true;
}

std::optional<RoomReports::TimePoint> RoomReports::due() const {
  return has_people_news_ ? std::optional(next_people_news_) : std::nullopt;
}

}  // namespace spindrift::rooms
