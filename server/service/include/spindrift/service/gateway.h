// Connects the network to the rooms: handles the messages of sessions and requests. Implements net::Application; runs
// on I/O threads.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include <spindrift/core/token_bucket.h>
#include <spindrift/net/server.h>
#include <spindrift/rooms/encoder_thread.h>
#include <spindrift/rooms/frame_outlet.h>
#include <spindrift/rooms/room_outlets.h>
#include <spindrift/rooms/simulation_thread.h>
#include <spindrift/service/access.h>
#include <spindrift/service/metrics.h>
#include <spindrift/service/rest_api.h>

namespace spindrift::service {

struct GatewayOptions {
  Access access;
  std::size_t message_max_bytes = 16 * 1024;  ///< same value as in the network; sent in greetings
  double messages_per_s = 500.0;              ///< same
  double message_burst_count = 1000.0;        ///< same
  double commands_per_s = 200.0;              ///< token bucket per session; commands beyond it are rejected as BUSY
  double command_burst_count = 400.0;
  std::chrono::milliseconds hello_patience{10'000};  ///< sessions that have not sent Hello by then are closed
  std::function<void()> on_drain{};                  ///< an operator asks for the server's end; empty: not offered
};

class Gateway final : public net::Application, public rooms::RoomOutlets, public rooms::FrameOutlet {
 public:
  /// `sources` outlives the gateway.
  Gateway(GatewayOptions options, const MetricsSources& sources);
  /// Sets the rooms and the encoder of their frames; call it before the network starts. Both must exist as long as the
  /// network calls the gateway, though their threads may have ended.
  void serve(rooms::SimulationThread& rooms, rooms::EncoderThread& encoder);

  /// Tells every client that knows the message, and refuses new rooms from now on. /readyz answers 503.
  void drain(const v1::Draining& draining);

  void serverStarts(net::Hub& served) override;
  core::Result<void> acceptSession(const std::string& room) override;
  void sessionOpened(net::SessionId session, const std::string& room, const std::string& peer) override;
  void sessionMessage(net::SessionId session, core::ByteView message) override;
  void sessionLevelChanged(net::SessionId session, core::Level level) override;
  void sessionClosed(net::SessionId session, const net::SessionEnd& end) override;
  void httpRequest(const net::HttpRequest& request, net::HttpResponder respond) override;

  // RoomOutlets interface
  /// Sends a new greeting to all sessions of the room; their subscriptions stay valid.
  void sceneChanged(const rooms::Room& room) override;
  void timeChanged(const rooms::Room& room, bool paused, double speed) override;
  void parameterChanged(const rooms::Room& room, const std::string& path, double value) override;
  void boatsChanged(const rooms::Room& room, const v1::BoatList& boats) override;
  void peopleChanged(const rooms::Room& room, const v1::People& people) override;
  void wasReset(const rooms::Room& room) override;
  void hasRecovered(const rooms::Room& room, const std::string& how) override;
  void fidelityChanged(const rooms::Room& room, const std::string& how) override;
  void closed(const rooms::Room& room) override;
  void frameReady(const rooms::Room& room, core::FrameView frame) override;
  [[nodiscard]] rooms::WatchedLayers watched(const rooms::Room& room, const core::ReducedCounts& counts) const override;
  [[nodiscard]] std::size_t sessionCount(const rooms::Room& room) const override;
  [[nodiscard]] std::size_t sessionCount() const override;
  void commandApplied(const rooms::Command& command, std::uint64_t tick, std::uint32_t boat_id) override;
  void commandRejected(const rooms::Command& command, const wire::CommandRejection& rejection) override;

  // FrameOutlet interface
  [[nodiscard]] core::StreamDemand demand(const std::string& room, codec::Stream stream,
                                          std::uint32_t reduced_count) const override;
  void publish(const std::string& room, codec::Stream stream, const codec::EncodedFrame& frame, core::Level level,
               std::uint32_t reduced_count) override;

 private:
  struct SessionState {
    std::shared_ptr<rooms::Room> room;
    std::shared_ptr<const rooms::RoomSnapshot> greeted;  ///< the state sent in the last greeting
    core::TokenBucket commands;
    bool said_hello = false;
    std::uint32_t wire_minor = 0;  ///< of the client, once it has said hello
    core::Role role = core::Role::kViewer;
    std::uint32_t person_id = 0;
  };

  [[nodiscard]] net::Hub& hub() const { return *hub_; }
  [[nodiscard]] rooms::SimulationThread& simulation() const { return *rooms_; }
  /// Sends a greeting with the room's present state and stores that state.
  void greet(net::SessionId session, const rooms::Room& room);
  void hello(net::SessionId session, const SessionState& state, const wire::Hello& hello);
  void subscribe(net::SessionId session, const SessionState& state, const wire::Subscribe& subscribe);
  void command(net::SessionId session, const SessionState& state, v1::Command message);
  /// Takes a token of the session's command rate; returns false if there is none.
  bool takeCommand(net::SessionId session);
  void refuse(net::SessionId session, net::CloseCode code, const std::string& why);
  /// Closes all sessions of a room that is about to close.
  void dismiss(const rooms::Room& room);

  const GatewayOptions options_;
  rooms::SimulationThread* rooms_ = nullptr;  ///< set before any session exists
  rooms::EncoderThread* encoder_ = nullptr;   ///< set before any session exists
  CommandCounters counters_;
  RestApi rest_;
  net::Hub* hub_ = nullptr;  ///< set before any session exists
  std::mutex mutex_;
  std::map<net::SessionId, SessionState> sessions_;
};

}  // namespace spindrift::service
