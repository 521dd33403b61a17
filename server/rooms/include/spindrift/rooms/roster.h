// The people of one room: who they are, and whose boat is whose. Thread-safe: sessions come and go on I/O threads,
// boats change hands on the simulation thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <spindrift/core/command.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::rooms {

/// Somebody who said hello.
struct Arrival {
  core::SessionId session = 0;
  core::Role role = core::Role::kViewer;
  std::string name{};           ///< empty: "guest" and the person's number
  std::uint32_t color_rgb = 0;  ///< 0: one of the roster's own
  std::string resume_key{};     ///< of an earlier Admission, or empty
};

struct Admission {
  std::uint32_t person_id = 0;
  std::string resume_key;
  bool resumed = false;
  std::optional<core::SessionId> displaced;  ///< the session that was this person until now
};

/// A lost connection keeps its person, and the person's boats, for the grace time; then the boats are nobody's.
/// Somebody without a boat has nothing to keep and is forgotten at once.
class Roster {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Roster(std::chrono::milliseconds grace) : grace_(grace) {}

  Admission arrive(const Arrival& arrival);
  /// The connection is gone. Only the session that is the person's now counts.
  void leave(core::SessionId session, Clock::time_point now);

  /// Boats.
  [[nodiscard]] std::uint32_t ownerOf(std::uint32_t boat_id) const;  ///< 0: nobody
  [[nodiscard]] bool hasBoat(std::uint32_t person_id) const;
  /// Whoever had it has it no more. Nothing for a person who is not here.
  void give(std::uint32_t boat_id, std::uint32_t person_id);
  /// Forgets the boats that are not on the water any more.
  void keepOnly(const std::set<std::uint32_t>& boat_ids);

  /// What time has done since the last call.
  struct Turn {
    std::vector<std::uint32_t> boats_to_stop;  ///< their people have just gone away: nobody steers now
    bool is_news = false;                      ///< people() says something new
  };
  Turn settle(Clock::time_point now);

  [[nodiscard]] v1::People people() const;
  [[nodiscard]] std::chrono::milliseconds grace() const { return grace_; }

 private:
  struct Person {
    std::string name;
    std::uint32_t color_rgb = 0;
    core::Role role = core::Role::kViewer;
    std::string resume_key;
    core::SessionId session = 0;  ///< 0: away
    Clock::time_point away_since{};
    bool boats_stopped = false;  ///< since they went away
    std::set<std::uint32_t> boats;
  };

  const std::chrono::milliseconds grace_;
  mutable std::mutex mutex_;
  std::map<std::uint32_t, Person> people_;
  std::uint32_t last_person_id_ = 0;
  bool is_news_ = false;
};

}  // namespace spindrift::rooms
