// Actions of lessons and games: what players may do, teams, the start of races, the ball, and the grid of boats.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <spindrift/classroom/lesson.h>
#include <spindrift/rooms/room_actions.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/scene/scene_rules.h>

namespace spindrift::rooms {
namespace {

/// Boats beside each other in the grid; distances of their middles in lengths and beams.
constexpr std::uint32_t kGridRowCount = 8;
constexpr double kGridLengths = 1.6, kGridBeams = 2.2;
/// Size of a ball over the shorter side of the water, which many boats can see and push. [m]
constexpr double kBallSides = 0.03, kBallMin_m = 0.3, kBallMax_m = 2.0;

wire::CommandRejection unknownPerson(const char* field, std::uint32_t person_id) {
  return wire::rejection(v1::REJECT_REASON_UNKNOWN_PERSON, field,
                         fmt::format("{} is not in the room; see the list of people", person_id));
}

Command ballAt(const Referee::Position& spot, const v1::Scene& scene) {
  Command out;
  v1::Floater& ball = *out.message.mutable_spawn_floater()->mutable_floater();
  ball.set_kind(v1::FLOATER_KIND_BALL);
  ball.set_x_m(spot.x_m);
  ball.set_z_m(spot.z_m);
  ball.set_size_m(std::clamp(kBallSides * scene::waterExtentsOf(scene).shorterSide_m(), kBallMin_m, kBallMax_m));
  return out;
}

}  // namespace

// What players may do

RoomActions::Outcome RoomActions::setLesson(const Command& command) {
  room_.roster.setLesson(command.message.set_lesson().lesson());
  room_.news.lesson = true;
  stopBoatsOfIdle();
  return {};
}

RoomActions::Outcome RoomActions::mutePerson(const Command& command) {
  const v1::MutePerson& mute = command.message.mute_person();
  if (!room_.roster.mute(mute.person_id(), mute.muted()))
    return unknownPerson("mute_person.person_id", mute.person_id());
  stopBoatsOfIdle();
  return {};
}

RoomActions::Outcome RoomActions::setTeam(const Command& command) {
  const v1::SetTeam& set = command.message.set_team();
  if (room_.roster.setTeam(set.person_id(), set.team())) return {};
  return unknownPerson("set_team.person_id", set.person_id());
}

bool RoomActions::maySteer(const Roster::BoatOwner& owner) const {
  v1::Command control;
  control.mutable_control_boat();
  return !room_.roster.refuse({.person_id = owner.person_id, .role = owner.role}, control);
}

void RoomActions::stopBoatsOfIdle() {
  for (const Roster::BoatOwner& owner : room_.roster.boatOwners()) {
    if (!maySteer(owner)) stopBoat(owner.boat_id);
  }
}

// Games

RoomActions::Outcome RoomActions::startGame(const Command& command) {
  const v1::StartGame& wanted = command.message.start_game();
  const v1::Scene& scene = room_.water->scene();
  if (wanted.kind() == v1::GAME_KIND_BALL) {
    v1::Command ball = ballAt(Referee::ballSpot(scene.course()), scene).message;
    if (auto refused = wire::completeCommand(ball, scene)) {
      refused->set_message("the ball cannot lie in the middle of the goals: " + refused->message());
      refused->set_field("start_game.kind");
      return refused;
    }
  }
  clearGame();
  room_.referee.start(wanted, scene.course(), room_.water->tick(), room_.water->sim().time_s());
  if (room_.referee.holdsBoats()) holdBoats();
  advanceGame();
  return {};
}

RoomActions::Outcome RoomActions::endGame(const Command& /*command*/) {
  clearGame();
  return {};
}

void RoomActions::clearGame() {
  if (room_.referee.ballId() != 0) removeBall();
  const bool held_boats = room_.referee.holdsBoats();
  room_.referee.end();
  if (held_boats) releaseBoats();
}

void RoomActions::advanceGame() {
  Referee& referee = room_.referee;
  if (referee.phase() == v1::GAME_PHASE_UNSPECIFIED) return;
  const bool held_boats = referee.holdsBoats();
  referee.advance(room_.water->sim().time_s());
  if (held_boats && !referee.holdsBoats()) releaseBoats();
  if (const auto spot = referee.wantedBall()) putBall(*spot);
}

void RoomActions::holdBoats() {
  for (const Roster::BoatOwner& owner : room_.roster.boatOwners()) {
    if (owner.role >= core::Role::kOperator) continue;
    Command still;
    still.message.mutable_control_boat()->set_boat_id(owner.boat_id);
    (void)applyToWater(still);  // the boat may be gone already, as in the next
  }
}

void RoomActions::releaseBoats() {
  for (const Roster::BoatOwner& owner : room_.roster.boatOwners()) {
    const auto lever = levers_.find(owner.boat_id);
    if (owner.role >= core::Role::kOperator || lever == levers_.end() || !maySteer(owner)) continue;
    Command start;
    *start.message.mutable_control_boat() = lever->second;
    (void)applyToWater(start);
  }
}

void RoomActions::putBall(const Referee::Position& spot) {
  if (room_.referee.ballId() != 0) removeBall();
  Command ball = ballAt(spot, room_.water->scene());
  if (wire::completeCommand(ball.message, room_.water->scene()) || applyToWater(ball)) return;  // again after the tick
  room_.referee.ballIsPut(room_.water->spawnedId(), room_.water->tick());
}

void RoomActions::removeBall() {
  Command remove;
  remove.message.mutable_remove_floater()->set_floater_id(room_.referee.ballId());
  (void)applyToWater(remove);  // it may be gone already
}

RoomActions::Outcome RoomActions::holdFloater(const Command& command) {
  if (isBall(command, command.message.hold_floater().floater_id())) return notTheBall("hold_floater.floater_id");
  return applyToWater(command);
}

RoomActions::Outcome RoomActions::removeFloater(const Command& command) {
  if (isBall(command, command.message.remove_floater().floater_id())) return notTheBall("remove_floater.floater_id");
  return applyToWater(command);
}

bool RoomActions::isBall(const Command& command, std::uint32_t floater_id) const {
  return command.sender.role < core::Role::kOperator && floater_id != 0 && floater_id == room_.referee.ballId();
}

wire::CommandRejection RoomActions::notTheBall(const char* field) {
  return wire::rejection(v1::REJECT_REASON_NOT_NOW, field,
                         "this is the ball of the game: push it with boats and waves, until an operator ends the game");
}

// The grid

std::optional<std::uint32_t> RoomActions::placeOnGrid(v1::Boat& boat) {
  const v1::Scene& scene = room_.water->scene();
  const v1::Course& course = scene.course();
  const double heading = course.start_heading_deg() * std::numbers::pi / 180;
  const double ahead_x = std::cos(heading), ahead_z = std::sin(heading);
  v1::Boat placed = boat;
  placed.set_heading_deg(course.start_heading_deg());
  for (std::uint32_t place = 0; place < scene.boats().capacity_count(); ++place) {
    const bool is_taken = std::ranges::any_of(grid_, [&](const auto& entry) { return entry.second == place; });
    if (is_taken) continue;
    const double back_m = kGridLengths * boat.length_m() * (place / kGridRowCount);
    const double aside_m = kGridBeams * boat.beam_m() * (place % kGridRowCount - 0.5 * (kGridRowCount - 1));
    placed.set_x_m(course.start_x_m() - back_m * ahead_x - aside_m * ahead_z);
    placed.set_z_m(course.start_z_m() - back_m * ahead_z + aside_m * ahead_x);
    if (!scene::checkBoat(scene::toCore(placed), scene, "").empty()) continue;
    boat = std::move(placed);
    return place;
  }
  return std::nullopt;
}

}  // namespace spindrift::rooms
