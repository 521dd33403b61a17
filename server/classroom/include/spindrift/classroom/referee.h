// Counts a race round the marks of a course, or goals of two teams, from positions of boats and of the ball. Knows no
// room and no device; all times are simulation times.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <spindrift/v1/scene.pb.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::rooms {

class Referee {
 public:
  struct Position {
    double x_m = 0.0;
    double z_m = 0.0;
  };
  /// A boat with an owner: one without does not take part.
  struct Boat {
    std::uint32_t boat_id = 0;
    std::uint32_t person_id = 0;
    v1::Team team = v1::TEAM_UNSPECIFIED;
    Position position{};
  };
  /// Positions in one frame.
  struct Sample {
    std::uint64_t tick = 0;  ///< of the room
    double time_s = 0.0;
    std::span<const Boat> boats{};
    std::optional<Position> ball{};  ///< nullopt: no floater has the id of the ball
  };

  /// Returns where the ball of a course is put: in the middle between its goals.
  [[nodiscard]] static Position ballSpot(const v1::Course& course);
  /// Begins a game for which the course has what it takes; a running one ends. `wanted` has its defaults.
  void start(const v1::StartGame& wanted, const v1::Course& course, std::uint64_t tick, double now_s);
  /// Ends the game, with its result.
  void end() { *this = {}; }
  /// Moves the time on.
  void advance(double now_s);
  /// Counts what has happened since the sample before: a boat moves on a straight line between two. Samples of earlier
  /// ticks than the beginning, and of times before, count for nothing.
  void see(const Sample& sample);

  [[nodiscard]] v1::GameKind kind() const { return kind_; }
  [[nodiscard]] v1::GamePhase phase() const { return phase_; }
  /// Returns whether see() needs samples.
  [[nodiscard]] bool isWatching() const;
  /// Returns whether boats have to wait for the start.
  [[nodiscard]] bool holdsBoats() const { return kind_ == v1::GAME_KIND_RACE && phase_ == v1::GAME_PHASE_COUNTDOWN; }
  /// Returns where a ball has to be put now; nullopt: it is there, or there is no game of ball.
  [[nodiscard]] std::optional<Position> wantedBall() const;
  /// A ball was put there, after this tick.
  void ballIsPut(std::uint32_t floater_id, std::uint64_t tick);
  [[nodiscard]] std::uint32_t ballId() const { return ball_id_; }

  /// Returns the game as it stands, the best racer first.
  [[nodiscard]] v1::Game game() const;

 private:
  struct Mark {
    Position at{};
    double radius_m = 0.0;
  };
  struct Goal {
    Position at{};
    double half_length_m = 0.0;
    double half_width_m = 0.0;
  };
  struct Seen {
    Position at{};
    double time_s = 0.0;
  };
  struct Track {
    std::uint32_t person_id = 0;
    std::uint32_t boat_id = 0;
    v1::Team team = v1::TEAM_UNSPECIFIED;
    Seen last{};
    std::uint32_t laps_count = 0;
    std::uint32_t next_mark = 0;
    double lap_begin_s = 0.0;
    double lap_best_s = 0.0;
    std::optional<double> finished_s{};  ///< after the beginning
    bool is_here = true;                 ///< in the newest sample
  };

  static Goal goalOf(const v1::CourseGoal& goal);
  void seeRace(const Sample& sample);
  void seeBall(const Sample& sample);
  /// The boat's way since its last sample.
  void follow(Track& track, const Seen& now);
  void passMark(Track& track, double time_s);
  /// The decision: what happens later changes the list of those who finish, not the winner.
  void decide(double time_s);
  [[nodiscard]] bool isBetter(const Track& a, const Track& b) const;

  v1::GameKind kind_ = v1::GAME_KIND_UNSPECIFIED;
  v1::GamePhase phase_ = v1::GAME_PHASE_UNSPECIFIED;
  std::uint64_t first_tick_ = 0;
  double begins_s_ = 0.0;
  double ends_s_ = 0.0;  ///< 0: undecided
  double now_s_ = 0.0;
  std::uint32_t laps_count_ = 0;
  std::uint32_t goals_count_ = 0;
  std::vector<Mark> marks_;
  std::vector<Track> tracks_;
  std::uint32_t winner_person_id_ = 0;
  v1::Team winner_team_ = v1::TEAM_UNSPECIFIED;

  Goal red_goal_{}, blue_goal_{};
  std::uint32_t red_goals_count_ = 0, blue_goals_count_ = 0;
  std::uint32_t ball_id_ = 0;
  bool wants_ball_ = false;
  std::uint64_t ball_tick_ = 0;
  std::optional<Position> ball_;  ///< in the sample before
};

}  // namespace spindrift::rooms
