// One client of a script: its connection and what it has received. Runs only on the thread that drives the pool.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <spindrift/net/client.h>
#include <spindrift/v1/script.pb.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::script {

using Clock = std::chrono::steady_clock;

inline double since_s(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Statistics of one layer, or of the diagnostics.
struct LayerTally {
  std::uint64_t frame_count = 0;
  std::uint64_t state_count = 0;  ///< different states of the water in the frames; a paused room repeats its state
  std::uint64_t state_id = 0;     ///< of the last frame, and so the next
  std::uint64_t tick = 0;
  std::optional<Clock::time_point> last;  ///< time of the last frame, or of the subscription
  double longest_gap_s = 0.0;             ///< since the subscription or the last takeLongestGap_s()
  double longest_gap_ever_s = 0.0;
};

/// Messages and statistics of a client, through all of its connections.
struct Received {
  std::map<v1::Layer, v1::LayerFrame> newest;
  std::map<v1::Layer, LayerTally> tallies;
  v1::Diagnostics diagnostics;  ///< the newest
  v1::People people;
  double tick_rate_hz = 60.0;  ///< of the room's scene
  std::map<v1::RoomEventKind, std::uint64_t> event_counts;
  std::map<std::uint64_t, v1::ServerMessage> answers;  ///< Ack or Reject by the number of the command
  std::vector<double> answer_times_ms;
  std::uint64_t byte_count = 0;
  std::uint64_t malformed_count = 0;
};

class ScriptClient {
 public:
  /// `setup` and the pool must outlive the client.
  ScriptClient(const v1::ScriptClient& setup, net::ClientPool& pool, const net::ClientUrl& url);

  /// Call it often: after a Draining message it leaves and connects again when the time has come. A script does not see
  /// that as the end of a connection.
  void followDraining();
  /// Connects, then sends Hello and the subscriptions. After the end of a connection: as the same person.
  void connect();
  void disconnect(bool vanish);
  void send(const v1::ClientMessage& message);
  void subscribe(const v1::Subscribe& wanted);
  /// Subscribes with plain packing, unless already subscribed.
  void needLayer(v1::Layer layer);
  /// Sends the command with a new number and returns the number.
  std::uint64_t command(v1::Command command);

  [[nodiscard]] const std::string& name() const { return setup_.name(); }
  [[nodiscard]] bool wasConnected() const { return connection_ != nullptr; }
  [[nodiscard]] bool isWelcome() const { return welcome_.has_value() && !end_; }
  /// Reason why the connection ended or was never made.
  struct End {
    std::uint16_t code = 0;
    std::string reason;
  };
  [[nodiscard]] const std::optional<End>& end() const { return end_; }
  /// The same, but also while the client is about to come back after a Draining message.
  [[nodiscard]] const std::optional<End>& lastEnd() const { return last_end_; }
  /// Returns the longest gap since the last call, including the current one, and starts a new measurement.
  double takeLongestGap_s(v1::Layer layer);

  Received received;

 private:
  /// Address and times of the next connection, after a Draining message.
  struct Move {
    net::ClientUrl url;
    Clock::time_point next;      ///< of the next attempt
    Clock::time_point gives_up;  ///< an attempt that fails later is the end
  };
  void planMove(const v1::Draining& draining);
  void ended(const End& end);
  void take(core::ByteView bytes);
  void frame(v1::Layer layer, std::uint64_t state_id, std::uint64_t tick);

  const v1::ScriptClient& setup_;
  net::ClientPool& pool_;
  net::ClientUrl url_;
  std::shared_ptr<net::Client> connection_;
  std::uint64_t connection_number_ = 0;  ///< callbacks of an earlier connection are ignored
  std::optional<v1::Welcome> welcome_;
  std::optional<End> end_;
  std::optional<End> last_end_;
  std::optional<Move> move_;
  std::string refusal_;
  std::string resume_key_;
  std::map<v1::Layer, v1::Subscribe> subscriptions_;
  std::uint64_t last_command_id_ = 0;
  std::map<std::uint64_t, Clock::time_point> sent_at_;
};

}  // namespace spindrift::script
