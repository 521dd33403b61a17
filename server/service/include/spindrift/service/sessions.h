// The client protocol: what a session may say and what it is told, whatever process its room runs in. Called on I/O
// threads and by the rooms.
#pragma once

#include <chrono>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include <spindrift/core/token_bucket.h>
#include <spindrift/net/server.h>
#include <spindrift/service/access_control.h>
#include <spindrift/service/metrics.h>
#include <spindrift/service/venue.h>

namespace spindrift::service {

struct SessionRules {
  std::size_t message_max_bytes = 16 * 1024;  ///< same value as in the network; sent in greetings
  double messages_per_s = 500.0;              ///< same
  double message_burst_count = 1000.0;        ///< same
  double commands_per_s = 200.0;              ///< token bucket per session; commands beyond it are rejected as BUSY
  double command_burst_count = 400.0;
  std::chrono::milliseconds hello_patience{10'000};  ///< sessions that have not sent Hello by then are closed
};

/// Thread-safe. Messages of one session are handled one at a time, in their order.
class Sessions {
 public:
  /// `access` and `counters` outlive it.
  Sessions(const SessionRules& rules, AccessControl& access, CommandCounters& counters)
      : rules_(rules), access_(access), counters_(counters) {}
  /// Takes the hub. Call it before the first session.
  void serve(net::Hub& hub) { hub_ = &hub; }
  [[nodiscard]] net::Hub& hub() const { return *hub_; }
  [[nodiscard]] AccessControl& access() const { return access_; }

  // From the network.
  void opened(net::SessionId session, const std::shared_ptr<Venue>& venue, const net::SessionOpening& opening);
  void message(net::SessionId session, core::ByteView message);
  void levelChanged(net::SessionId session, core::Level level);
  void closed(net::SessionId session, const net::SessionEnd& end);

  // From the rooms.
  /// Sends a new greeting to the sessions of a room that has another scene, or can be reached again. Their
  /// subscriptions stay valid.
  void roomChanged(const Venue& venue);
  /// Sends the same to a session that may now be another person, or have another key.
  void readmitted(net::SessionId session, const rooms::Admission& admission);
  /// Closes all sessions of a room that is about to close. `why`: one line.
  void dismiss(const std::string& room, net::CloseCode code = net::CloseCode::kRoomClosed,
               const std::string& why = "the room was closed");
  /// Sends the answer to the session that sent the command; counts and the audit log are the caller's.
  void commandApplied(const rooms::Command& command, const v1::Ack& ack);
  /// Sends the answer to the session whose queries it belongs to. One that ends a query is never left out; of the
  /// others, which belong to streams alone, only the newest waits for a slow connection.
  void queryAnswered(net::SessionId session, const v1::QueryAnswer& answer);
  /// Sends the forces to the session that moves the boats; only the newest wait for a slow connection.
  void hullsFelt(net::SessionId session, const v1::HullForces& forces);
  /// Sends the rejection, counts it, and enters it into the audit log.
  void commandRejected(const rooms::Command& command, const wire::CommandRejection& rejection);
  /// Closes a session in whose place another connection continues.
  void displace(net::SessionId session);
  /// Prepares the end of the process: `network` refuses new sessions from now on. Tells every client that knows the
  /// message when its session is closed, where to go (empty: back here), and within which time to come, spread so that
  /// they do not come all at once.
  void drain(net::Server& network, std::chrono::milliseconds closes_in, const std::string& go_to);
  /// Tells the client why, and closes.
  void refuse(net::SessionId session, net::CloseCode code, const std::string& why);

 private:
  enum class Stage : std::uint8_t {
    kNew,       ///< Hello has not come
    kArriving,  ///< the room was asked; messages wait
    kIn
  };
  struct State {
    std::shared_ptr<Venue> venue;
    std::shared_ptr<const VenueView> greeted;  ///< what the last greeting said; null: none was sent
    core::TokenBucket commands;
    Stage stage = Stage::kNew;
    std::deque<core::Bytes> waiting{};  ///< while kArriving; bounded
    std::uint32_t wire_minor = 0;       ///< of the client, once it has said hello
    std::uint32_t watched_layers = 0;   ///< a bit for each v1::Layer that it has ever subscribed to
    core::Role role = core::Role::kViewer;
    std::uint32_t person_id = 0;
    std::string resume_key{};
    std::string peer{};
    bool is_onlooker = false;  ///< nobody of the room: not among its people, without commands
    std::string person{};      ///< whose budget commands take; empty: only the session's own
    std::shared_ptr<const core::SenderDetails> details{};  ///< once it has said hello
  };

  /// Sends a greeting with the room's present state and stores that state. Does nothing if the last greeting had the
  /// same state, or while the room cannot be reached.
  void greet(net::SessionId session, const Venue& venue);
  /// Sends the lesson and the game, no older ones than the room's news.
  void tellLesson(net::SessionId session, const Venue& venue);
  void handle(net::SessionId session, const State& state, core::ByteView message);
  void hello(net::SessionId session, const State& state, const v1::Hello& hello);
  void arrived(net::SessionId session, const v1::Hello& hello, core::Role role,
               const core::Result<rooms::Admission>& admission);
  /// Handles what came while the session arrived.
  void handleWaiting(net::SessionId session);
  void welcome(net::SessionId session, const rooms::Admission& admission, core::Role role, const Venue& venue);
  void subscribe(net::SessionId session, const State& state, const wire::Subscribe& subscribe);
  void command(net::SessionId session, const State& state, v1::Command message);
  /// Notes that the session watches the layer; true: for the first time.
  bool noteWatched(net::SessionId session, v1::Layer layer);
  /// Takes a token of the session's command rate; returns false if the bucket is empty.
  bool takeCommand(net::SessionId session);

  const SessionRules rules_;
  AccessControl& access_;
  CommandCounters& counters_;
  /// Calls `use` with the session's state, under the lock; returns false, without a call, if the session has ended.
  template <typename Use>
  bool with(net::SessionId session, Use&& use) {
    const std::lock_guard lock(mutex_);
    const auto known = sessions_.find(session);
    if (known == sessions_.end()) return false;
    use(known->second);
    return true;
  }

  net::Hub* hub_ = nullptr;  ///< set before any session exists
  /// Held from reading a room's state until the greeting is sent, so that no older greeting follows a newer one. Lock
  /// it before mutex_.
  std::mutex greeting_mutex_;
  std::mutex mutex_;
  std::map<net::SessionId, State> sessions_;
};

}  // namespace spindrift::service
