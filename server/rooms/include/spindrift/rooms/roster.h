// The people of one room, the owners of its boats, and the lesson with its teams. Thread-safe: sessions come and leave
// on I/O threads, ownership of boats changes on the room's thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <spindrift/core/sender.h>
#include <spindrift/v1/kept_state.pb.h>
#include <spindrift/v1/wire.pb.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::rooms {

/// A client that has sent Hello.
struct Arrival {
  core::SessionId session = 0;
  core::Role role = core::Role::kViewer;
  std::string name{};           ///< empty: "guest" and the person's number
  std::uint32_t color_rgb = 0;  ///< 0: the roster chooses one
  std::string resume_key{};     ///< from an earlier Admission, or empty
};

struct Admission {
  std::uint32_t person_id = 0;
  std::string resume_key;
  bool resumed = false;
  std::optional<core::SessionId> displaced;  ///< the session that belonged to this person before
};

/// After a lost connection the person and the person's boats and gauges are kept for the grace time; then the boats
/// have no owner. A person without any is removed at once, except one who is muted: a new page does not end that.
class Roster {
 public:
  using Clock = std::chrono::steady_clock;

  /// `on_news` is called, on any thread, when people came or went: settle() has something to tell.
  explicit Roster(std::chrono::milliseconds grace, std::function<void()> on_news = {})
      : grace_(grace), on_news_(std::move(on_news)) {}

  Admission arrive(const Arrival& arrival);
  /// The connection ended. Ignored unless the session is the person's present one.
  void leave(core::SessionId session, Clock::time_point now);

  /// Ownership of boats.
  [[nodiscard]] std::uint32_t ownerOf(std::uint32_t boat_id) const;  ///< 0: no owner
  [[nodiscard]] bool hasBoat(std::uint32_t person_id) const;
  /// Makes the person the owner; a previous owner loses the boat. Ignored for a person who is not in the room.
  void give(std::uint32_t boat_id, std::uint32_t person_id);
  /// Removes the ownership of boats that are no longer on the water.
  void keepOnly(const std::set<std::uint32_t>& boat_ids);

  [[nodiscard]] bool isHere(std::uint32_t person_id) const;
  /// Returns whether anybody else who may act (a player or an operator) is connected.
  [[nodiscard]] bool hasActorsBeside(std::uint32_t person_id) const;
  /// Returns "Ada (person 3)", and "person 3" for somebody who is not here.
  [[nodiscard]] std::string nameOf(std::uint32_t person_id) const;
  /// Returns whether this session is the person's present one.
  [[nodiscard]] bool isConnected(std::uint32_t person_id, core::SessionId session) const;
  /// Says who has gauges in the water; nobody else has any.
  void setGaugeOwners(const std::set<std::uint32_t>& person_ids);

  /// A boat that belongs to somebody.
  struct BoatOwner {
    std::uint32_t boat_id = 0;
    std::uint32_t person_id = 0;
    core::Role role = core::Role::kViewer;
    v1::Team team = v1::TEAM_UNSPECIFIED;
  };
  /// All of them, by person and boat.
  [[nodiscard]] std::vector<BoatOwner> boatOwners() const;

  /// The lesson; a room begins with the default, which allows everything.
  [[nodiscard]] v1::Lesson lesson() const;
  /// Replaces it; deals the players to the teams when teams begin, and ends the teams when they end.
  void setLesson(const v1::Lesson& lesson);
  /// Lesson.force_ratio, with its default.
  [[nodiscard]] double forceRatio() const;
  /// False: there is no such person.
  bool mute(std::uint32_t person_id, bool is_muted);
  bool setTeam(std::uint32_t person_id, v1::Team team);
  /// rooms::refuse() by this lesson.
  [[nodiscard]] std::optional<wire::CommandRejection> refuse(const core::Sender& sender,
                                                             const v1::Command& command) const;

  /// Changes over time since the last settle().
  struct Turn {
    std::vector<std::uint32_t> boats_to_stop;  ///< their owners have just disconnected
    bool is_news = false;                      ///< people() has changed
  };
  Turn settle(Clock::time_point now);

  [[nodiscard]] v1::People people() const;
  /// People who are connected now, with those who are not in the list.
  [[nodiscard]] std::size_t presentCount() const;
  /// People who only watch, through other processes, and are not in the list.
  void setUnlistedCount(std::uint32_t count);

  /// Everybody with their keys, to be kept on disk.
  [[nodiscard]] v1::RoomPeople kept() const;
  /// Grows with every change of kept().
  [[nodiscard]] std::uint64_t version() const;
  /// Puts kept people back, as if their connections had just been lost: they have the grace time to come back. Call it
  /// before anybody arrives.
  void restore(const v1::RoomPeople& people, Clock::time_point now);
  [[nodiscard]] std::chrono::milliseconds grace() const { return grace_; }

 private:
  struct Person {
    std::string name;
    std::uint32_t color_rgb = 0;
    core::Role role = core::Role::kViewer;
    std::string resume_key;
    core::SessionId session = 0;  ///< 0: disconnected
    Clock::time_point away_since{};
    bool boats_stopped = false;  ///< since the connection was lost
    std::set<std::uint32_t> boats;
    bool has_gauges = false;
    v1::Team team = v1::TEAM_UNSPECIFIED;
    bool is_muted = false;
    bool waits = false;  ///< was here before a restart: kept for the grace time also without a boat

    /// Returns whether the person is kept for the grace time after a lost connection.
    [[nodiscard]] bool isKept() const {
      return waits || is_muted || has_gauges || team != v1::TEAM_UNSPECIFIED || !boats.empty();
    }
  };

  /// Calls on_news at its end, after the lock that is taken later.
  struct News {
    const Roster& roster;
    ~News() {
      if (roster.on_news_) roster.on_news_();
    }
  };

  const std::chrono::milliseconds grace_;
  const std::function<void()> on_news_;
  mutable std::mutex mutex_;
  std::map<std::uint32_t, Person> people_;
  std::uint32_t last_person_id_ = 0;
  std::uint32_t unlisted_count_ = 0;
  v1::Lesson lesson_;
  bool is_news_ = false;
  std::uint64_t version_ = 1;

  /// Returns the team with fewer people.
  [[nodiscard]] v1::Team smallerTeam() const;
  void changed() {
    is_news_ = true;
    ++version_;
  }
};

}  // namespace spindrift::rooms
