#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include <spindrift/classroom/referee.h>

namespace spindrift::rooms {
namespace {

using Position = Referee::Position;

/// Those who come in after the winner are counted for this long.
constexpr double kFinishing_s = 120.0;
/// Racers in the list. A course has fewer boats; people who have finished and left stay in it.
constexpr std::size_t kRacerMaxCount = 128;

Position between(const Position& a, const Position& b, double share) {
  return {a.x_m + share * (b.x_m - a.x_m), a.z_m + share * (b.z_m - a.z_m)};
}

double distance_m(const Position& a, const Position& b) {
  return std::hypot(b.x_m - a.x_m, b.z_m - a.z_m);
}

/// Returns the share of the way from a to b at which it enters a disc: 0 if it begins there, nullopt if it misses it.
std::optional<double> entryOf(const Position& a, const Position& b, const Position& middle, double radius_m) {
  const double ax = a.x_m - middle.x_m, az = a.z_m - middle.z_m;
  const double dx = b.x_m - a.x_m, dz = b.z_m - a.z_m;
  const double outside = ax * ax + az * az - radius_m * radius_m;
  if (outside <= 0.0) return 0.0;
  const double along = ax * dx + az * dz;  // negative: comes closer
  const double length2 = dx * dx + dz * dz;
  const double discriminant = along * along - length2 * outside;
  if (along >= 0.0 || discriminant < 0.0) return std::nullopt;
  const double share = outside / (-along + std::sqrt(discriminant));
  return share <= 1.0 ? std::optional(share) : std::nullopt;
}

/// Returns whether the way from a to b meets a rectangle along the axes around the origin.
bool meets(const Position& a, const Position& b, double half_x_m, double half_z_m) {
  double from = 0.0, to = 1.0;
  const auto clip = [&](double begin, double end, double half) {
    const double d = end - begin;
    if (d == 0.0) return std::abs(begin) <= half;
    const double one = (-half - begin) / d, other = (half - begin) / d;
    from = std::max(from, std::min(one, other));
    to = std::min(to, std::max(one, other));
    return from <= to;
  };
  return clip(a.x_m, b.x_m, half_x_m) && clip(a.z_m, b.z_m, half_z_m);
}

bool isFinite(const Position& at) {
  return std::isfinite(at.x_m) && std::isfinite(at.z_m);
}

}  // namespace

Referee::Goal Referee::goalOf(const v1::CourseGoal& goal) {
  return {{goal.x_m(), goal.z_m()}, 0.5 * goal.length_m(), 0.5 * goal.width_m()};
}

Referee::Position Referee::ballSpot(const v1::Course& course) {
  return between(goalOf(course.red_goal()).at, goalOf(course.blue_goal()).at, 0.5);
}

void Referee::start(const v1::StartGame& wanted, const v1::Course& course, std::uint64_t tick, double now_s) {
  end();
  kind_ = wanted.kind();
  phase_ = v1::GAME_PHASE_COUNTDOWN;
  first_tick_ = tick;
  begins_s_ = now_s + wanted.countdown_s();
  if (kind_ == v1::GAME_KIND_RACE) {
    laps_count_ = wanted.laps_count();
    for (const v1::CourseMark& mark : course.marks()) marks_.push_back({{mark.x_m(), mark.z_m()}, mark.radius_m()});
  } else {
    goals_count_ = wanted.goals_count();
    red_goal_ = goalOf(course.red_goal());
    blue_goal_ = goalOf(course.blue_goal());
  }
  advance(now_s);
}

void Referee::advance(double now_s) {
  now_s_ = now_s;
  if (phase_ != v1::GAME_PHASE_COUNTDOWN || now_s < begins_s_) return;
  phase_ = v1::GAME_PHASE_RUNNING;
  wants_ball_ = kind_ == v1::GAME_KIND_BALL;
}

bool Referee::isWatching() const {
  if (phase_ != v1::GAME_PHASE_OVER) return phase_ != v1::GAME_PHASE_UNSPECIFIED;
  const auto is_on_the_way = [](const Track& track) { return track.is_here && !track.finished_s; };
  return kind_ == v1::GAME_KIND_RACE && now_s_ < ends_s_ + kFinishing_s && std::ranges::any_of(tracks_, is_on_the_way);
}

void Referee::see(const Sample& sample) {
  if (!isWatching() || sample.tick < first_tick_) return;
  if (kind_ == v1::GAME_KIND_RACE) return seeRace(sample);
  if (phase_ == v1::GAME_PHASE_RUNNING && ball_id_ != 0 && sample.tick > ball_tick_) seeBall(sample);
}

// Races

void Referee::seeRace(const Sample& sample) {
  for (Track& track : tracks_) track.is_here = false;
  const auto trackOf = [&](std::uint32_t person_id) {
    return std::ranges::find(tracks_, person_id, &Track::person_id);
  };
  // Somebody with several boats races with the one with which he began.
  const auto sees = [&](const Boat& boat, bool is_same_boat) {
    if (boat.person_id == 0 || !isFinite(boat.position)) return;
    auto track = trackOf(boat.person_id);
    if (track == tracks_.end()) {
      if (is_same_boat || phase_ == v1::GAME_PHASE_OVER || tracks_.size() >= kRacerMaxCount) return;
      tracks_.push_back({.person_id = boat.person_id, .boat_id = boat.boat_id});
      track = std::prev(tracks_.end());
      track->lap_begin_s = begins_s_;
      track->last = {boat.position, sample.time_s};
    } else if (track->is_here || (track->boat_id == boat.boat_id) != is_same_boat) {
      return;
    } else if (!is_same_boat) {  // another boat comes from nowhere
      track->boat_id = boat.boat_id;
      track->last = {boat.position, sample.time_s};
    }
    track->is_here = true;
    track->team = boat.team;
    follow(*track, {boat.position, sample.time_s});
  };
  for (const Boat& boat : sample.boats) sees(boat, true);
  for (const Boat& boat : sample.boats) sees(boat, false);
  std::erase_if(tracks_, [](const Track& track) { return !track.is_here && !track.finished_s; });
  const auto is_winner = [](const Track& track) { return track.finished_s.has_value(); };
  if (ends_s_ != 0.0 || !std::ranges::any_of(tracks_, is_winner)) return;
  const auto winner =
      std::ranges::min_element(tracks_, [this](const Track& a, const Track& b) { return isBetter(a, b); });
  winner_person_id_ = winner->person_id;
  winner_team_ = winner->team;
  decide(begins_s_ + *winner->finished_s);
}

void Referee::follow(Track& track, const Seen& now) {
  const Seen before = std::exchange(track.last, now);
  if (now.time_s < begins_s_ || track.finished_s) return;
  Position from = before.at;
  double from_s = before.time_s;
  // A mark counts once per lap, so that this ends.
  for (std::size_t passed = 0; passed < marks_.size() && !track.finished_s; ++passed) {
    const Mark& mark = marks_[track.next_mark];
    const auto entry = entryOf(from, now.at, mark.at, mark.radius_m);
    if (!entry) return;
    from = between(from, now.at, *entry);
    from_s = from_s + *entry * (now.time_s - from_s);
    if (from_s < begins_s_) from_s = begins_s_;
    passMark(track, from_s);
  }
}

void Referee::passMark(Track& track, double time_s) {
  if (++track.next_mark < marks_.size()) return;
  track.next_mark = 0;
  ++track.laps_count;
  const double lap_s = time_s - std::exchange(track.lap_begin_s, time_s);
  track.lap_best_s = track.lap_best_s == 0.0 ? lap_s : std::min(track.lap_best_s, lap_s);
  if (track.laps_count >= laps_count_) track.finished_s = time_s - begins_s_;
}

void Referee::decide(double time_s) {
  ends_s_ = time_s;
  phase_ = v1::GAME_PHASE_OVER;
}

bool Referee::isBetter(const Track& a, const Track& b) const {
  if (a.finished_s && b.finished_s && *a.finished_s != *b.finished_s) return *a.finished_s < *b.finished_s;
  if (a.finished_s.has_value() != b.finished_s.has_value()) return a.finished_s.has_value();
  if (a.laps_count != b.laps_count) return a.laps_count > b.laps_count;
  if (a.next_mark != b.next_mark) return a.next_mark > b.next_mark;
  const Position& mark = marks_[a.next_mark].at;
  const double a_m = distance_m(a.last.at, mark), b_m = distance_m(b.last.at, mark);
  return a_m != b_m ? a_m < b_m : a.person_id < b.person_id;
}

// Ball

std::optional<Referee::Position> Referee::wantedBall() const {
  if (!wants_ball_ || phase_ != v1::GAME_PHASE_RUNNING) return std::nullopt;
  return between(red_goal_.at, blue_goal_.at, 0.5);
}

void Referee::ballIsPut(std::uint32_t floater_id, std::uint64_t tick) {
  ball_id_ = floater_id;
  ball_tick_ = tick;
  wants_ball_ = false;
  ball_.reset();
}

void Referee::seeBall(const Sample& sample) {
  if (wants_ball_) return;
  if (!sample.ball || !isFinite(*sample.ball)) {
    wants_ball_ = true;  // somebody has taken it out, or newer objects have replaced it
    return;
  }
  const Position now = *sample.ball;
  const Position before = std::exchange(ball_, now).value_or(now);
  const auto isIn = [&](const Goal& goal) {
    return meets({before.x_m - goal.at.x_m, before.z_m - goal.at.z_m}, {now.x_m - goal.at.x_m, now.z_m - goal.at.z_m},
                 goal.half_length_m, goal.half_width_m);
  };
  const bool red_scores = isIn(blue_goal_), blue_scores = !red_scores && isIn(red_goal_);
  if (!red_scores && !blue_scores) return;
  wants_ball_ = true;
  const std::uint32_t count = ++(red_scores ? red_goals_count_ : blue_goals_count_);
  if (count < goals_count_) return;
  winner_team_ = red_scores ? v1::TEAM_RED : v1::TEAM_BLUE;
  decide(sample.time_s);
}

v1::Game Referee::game() const {
  v1::Game out;
  out.set_kind(kind_);
  out.set_phase(phase_);
  if (phase_ == v1::GAME_PHASE_UNSPECIFIED) return out;
  out.set_begins_s(begins_s_);
  out.set_ends_s(ends_s_);
  out.set_laps_count(laps_count_);
  out.set_goals_count(goals_count_);
  std::vector<Track> ranked = tracks_;
  std::ranges::sort(ranked, [this](const Track& a, const Track& b) { return isBetter(a, b); });
  for (const Track& track : ranked) {
    v1::Racer& racer = *out.add_racers();
    racer.set_person_id(track.person_id);
    racer.set_laps_count(track.laps_count);
    racer.set_next_mark(track.next_mark);
    racer.set_lap_best_s(track.lap_best_s);
    racer.set_finished_s(track.finished_s.value_or(0.0));
  }
  out.set_red_goals_count(red_goals_count_);
  out.set_blue_goals_count(blue_goals_count_);
  out.set_winner_person_id(winner_person_id_);
  out.set_winner_team(winner_team_);
  out.set_ball_floater_id(ball_id_);
  return out;
}

}  // namespace spindrift::rooms
