// Where rooms run: which servers are alive, and which of them takes a room that has none. Pure decisions without a
// clock or a network, so that all servers come to the same ones.
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>

#include <spindrift/v1/cluster.pb.h>

namespace spindrift::cluster {

using Clock = std::chrono::steady_clock;

/// A server whose last pulse is older is dead.
inline constexpr std::chrono::milliseconds kServerPatience{1'000};
/// Whoever is alive is heard within this time.
inline constexpr std::chrono::milliseconds kListenTime{700};

/// The servers of the cluster, from their pulses.
class Servers {
 public:
  /// Pulses of servers whose names no server can have, and rooms of that kind, are left out.
  void note(v1::ServerPulse pulse, Clock::time_point now);
  /// Forgets servers that have been dead for a minute.
  void review(Clock::time_point now);

  [[nodiscard]] bool isAlive(const std::string& server, Clock::time_point now) const;
  /// Returns whether this server is alive and says that it runs the room; after a cut, another one may say so as well.
  [[nodiscard]] bool runs(const std::string& server, const std::string& room, Clock::time_point now) const;
  /// Returns the names of those alive, in order.
  [[nodiscard]] std::vector<std::string> alive(Clock::time_point now) const;
  /// Returns the server that says that it runs the room; also a dead one, until another has the room. Empty: none.
  [[nodiscard]] std::string serverOf(const std::string& room) const;
  /// Returns all rooms that a server runs, or ran until it died, in order.
  [[nodiscard]] std::vector<std::string> rooms() const;
  /// Returns the server to open one more room: the least loaded that is alive, is not leaving and may have more rooms.
  /// `placed`: rooms placed on servers too lately for their pulses to show it. Empty: all have reached their limit.
  [[nodiscard]] std::string choose(Clock::time_point now, const std::map<std::string, int>& placed = {}) const;

 private:
  struct Server {
    v1::ServerPulse pulse;
    Clock::time_point heard{};
  };
  std::map<std::string, Server> servers_;
};

}  // namespace spindrift::cluster
