// The load of state_kill_test and cluster_kill_test: clients that send random commands as fast as they are answered,
// somebody who opens and closes rooms, and a ledger of all that the server answered.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "scripted_client.h"

namespace spindrift::test {

/// Scenes that the server of the test has.
inline constexpr const char* kKillScenes[] = {"kill_pool", "kill_tank", "kill_sea"};

/// A command that a client sent, and what became of it.
struct SentCommand {
  std::string room;
  std::uint64_t opening = 0;  ///< RoomFact::opening of the room
  std::uint32_t person_id = 0;
  v1::Command command;  ///< as the server keeps it: with its defaults
  enum class State { kUnanswered, kAcknowledged, kRejected } state = State::kUnanswered;
  std::uint64_t tick = 0;     ///< of the Ack
  std::uint32_t boat_id = 0;  ///< of the Ack
};

struct RoomFact {
  enum class State { kOpen, kClosed, kUnknown } state = State::kOpen;  ///< unknown: a request was not answered
  std::uint64_t opening = 0;                                           ///< distinguishes rooms of the same name
  std::string scene;                                                   ///< name of the scene with which it was opened
};

/// A boat that the server acknowledged to be a person's, in a room at a tick.
struct BoatClaim {
  std::string room;
  std::uint64_t opening = 0;
  std::uint32_t person_id = 0;
  std::uint32_t boat_id = 0;
  std::uint64_t tick = 0;
};

/// Thread-safe.
class Ledger {
 public:
  /// Forgets all commands and claims: a new round begins.
  void beginRound();
  std::size_t send(SentCommand command);
  void answer(std::size_t number, const v1::ServerMessage& answer);
  void setRoom(const std::string& room, RoomFact::State state, const std::string& scene = "");
  /// What the server kept of earlier rounds.
  void claim(BoatClaim claim);

  [[nodiscard]] std::map<std::string, RoomFact> rooms() const;
  [[nodiscard]] std::vector<SentCommand> commands() const;
  /// Boats of the person that nothing acknowledged or unanswered can have taken away.
  [[nodiscard]] std::set<std::uint32_t> sureBoats(const std::string& room, std::uint64_t opening,
                                                  std::uint32_t person_id) const;

 private:
  mutable std::mutex mutex_;
  std::vector<SentCommand> commands_;
  std::vector<BoatClaim> claims_;
  std::map<std::string, RoomFact> rooms_;
  std::uint64_t opening_count_ = 0;
};

/// Who a player is and which boats it has, as promised or as the server says.
struct Belongings {
  std::uint32_t person_id = 0;  ///< 0: nobody
  std::set<std::uint32_t> boats;
};

/// One client of the load. It remains the same person across restarts.
class Player {
 public:
  /// `room`: empty wanders between the rooms that are opened and closed.
  Player(std::uint32_t number, std::string room);

  /// Connects to its room and resumes its person there; false if that did not work.
  bool connect(std::uint16_t port, const Ledger& ledger);
  /// Sends commands until the connection ends; a wanderer continues in another room until `is_over`.
  void play(std::uint16_t port, Ledger& ledger, std::mt19937 random, const std::atomic<bool>& is_over);

  [[nodiscard]] ScriptedClient& client() const { return *client_; }
  [[nodiscard]] const std::string& room() const { return room_; }
  [[nodiscard]] std::uint64_t opening() const { return opening_; }
  /// Of an earlier connection to the same room; 0: a command was never answered there, so that nothing was promised.
  [[nodiscard]] Belongings promised(const Ledger& ledger) const;
  /// Connects as the same person, claims its boats, and returns what it has; nobody if that did not work.
  Belongings comeBack(std::uint16_t port, Ledger& ledger);
  void forgetPerson();

 private:
  v1::Command choose(std::mt19937& random);
  /// False if the connection has ended.
  bool sendOne(Ledger& ledger, std::mt19937& random);
  bool goElsewhere(std::uint16_t port, const Ledger& ledger, std::mt19937& random);

  const std::uint32_t number_;
  const bool wanders_;
  std::string room_;
  std::uint64_t opening_ = 0;
  std::string resume_key_;
  std::uint32_t person_id_ = 0;
  std::uint32_t promised_person_id_ = 0;
  std::uint64_t command_count_ = 0;
  std::vector<std::uint32_t> boats_;  ///< that it launched or took, newest last; some may be gone
  std::string scene_;
  std::unique_ptr<ScriptedClient> client_;
};

/// Checks that a player who came back is known and has what was promised.
void expectKept(const Player& player, const Belongings& promised, const Belongings& found);

/// Opens and closes rooms over REST until the server does not answer or `is_over`.
void openAndCloseRooms(std::uint16_t port, const std::vector<std::string>& names, Ledger& ledger, std::mt19937 random,
                       const std::atomic<bool>& is_over);

}  // namespace spindrift::test
