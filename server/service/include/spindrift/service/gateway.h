// Connects the network to the rooms of this process: their sessions, their requests and their frames. Implements
// net::Application; called on I/O threads, the rooms' threads and the encoder thread.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include <spindrift/net/server.h>
#include <spindrift/rooms/encoder_thread.h>
#include <spindrift/rooms/room_host.h>
#include <spindrift/rooms/room_outlets.h>
#include <spindrift/service/cluster_hooks.h>
#include <spindrift/service/metrics.h>
#include <spindrift/service/recordings.h>
#include <spindrift/service/rest_api.h>
#include <spindrift/service/sessions.h>
#include <spindrift/service/translators.h>

namespace spindrift::service {

class Gateway final : public net::Application, public rooms::RoomOutlets, public rooms::FrameOutlet {
 public:
  /// `sources` outlives the gateway. `on_drain`: an operator asks for the server's end; empty: not offered.
  Gateway(AccessOptions access, const SessionRules& rules, const MetricsSources& sources,
          std::function<void()> on_drain = {}, RecordingRules recordings = {});
  [[nodiscard]] AccessControl& access() { return access_; }
  /// Sets the rooms and the encoder of their frames; call it before the network starts. Both must exist as long as the
  /// network calls the gateway, though their threads may have ended.
  void serve(rooms::RoomHost& rooms, rooms::EncoderThread& encoder);
  /// Makes the server part of a cluster; call it before the network starts. What the hooks point to outlives the rooms
  /// and the network.
  void join(const ClusterHooks& cluster);
  [[nodiscard]] Sessions& sessions() { return sessions_; }
  [[nodiscard]] RestApi& rest() { return rest_; }
  [[nodiscard]] Recordings& recordings() { return recordings_; }

  /// Does what Sessions::drain() does, and refuses new rooms from now on. /readyz answers 503.
  void drain(net::Server& network, std::chrono::milliseconds closes_in, const std::string& go_to);

  void serverStarts(net::Hub& served) override { sessions_.serve(served); }
  core::Result<void> acceptSession(const std::string& room) override;
  std::unique_ptr<core::Translator> translatorFor(const net::SessionOpening& opening) override {
    return translatorOf(opening);
  }
  void sessionOpened(net::SessionId session, const net::SessionOpening& opening) override;
  void sessionMessage(net::SessionId session, core::ByteView message) override { sessions_.message(session, message); }
  void sessionLevelChanged(net::SessionId session, core::Level level) override {
    sessions_.levelChanged(session, level);
  }
  void sessionClosed(net::SessionId session, const net::SessionEnd& end) override { sessions_.closed(session, end); }
  void httpRequest(const net::HttpRequest& request, net::HttpResponder respond) override;

  // RoomOutlets interface
  /// Sends a new greeting to all sessions of the room; their subscriptions stay valid.
  void sceneChanged(const rooms::Room& room) override;
  void timeChanged(const rooms::Room& room, const v1::RoomState& state) override;
  void clockChanged(const rooms::Room& room, const std::string& how, std::uint32_t person_id) override;
  void parameterChanged(const rooms::Room& room, const std::string& path, double value) override;
  void boatsChanged(const rooms::Room& room, const v1::BoatList& boats) override;
  void peopleChanged(const rooms::Room& room, const v1::People& people) override;
  void strokesChanged(const rooms::Room& room, const v1::Strokes& strokes) override;
  void lessonChanged(const rooms::Room& room, const v1::Lesson& lesson) override;
  void gameChanged(const rooms::Room& room, const v1::Game& game) override;
  void wasReset(const rooms::Room& room, std::uint32_t person_id) override;
  void hasRecovered(const rooms::Room& room, const std::string& how) override;
  void fidelityChanged(const rooms::Room& room, const std::string& how) override;
  void closed(const rooms::Room& room) override;
  void queryAnswered(const rooms::Room& room, const core::Sender& sender, const v1::QueryAnswer& answer) override;
  void hullsFelt(const rooms::Room& room, const core::Sender& sender, const v1::HullForces& forces) override;
  void frameReady(const rooms::Room& room, core::FrameView frame) override;
  void commandApplied(const rooms::Command& command, const v1::Ack& ack) override;
  void commandRejected(const rooms::Command& command, const wire::CommandRejection& rejection) override;

  // FrameOutlet interface
  void publish(const std::string& room, codec::Stream stream, const codec::EncodedFrame& frame,
               const core::FrameLevels& levels) override;

 private:
  [[nodiscard]] net::Hub& hub() const { return sessions_.hub(); }
  [[nodiscard]] rooms::RoomHost& simulation() const { return *rooms_; }
  /// Returns the room of that name, here or in the cluster; null if it does not exist.
  [[nodiscard]] std::shared_ptr<Venue> find(const std::string& room);
  /// Sends a state message to all sessions of the room, in this process and in others.
  void tell(const rooms::Room& room, const net::StateTopic& topic, const core::SharedBytes& message);

  rooms::RoomHost* rooms_ = nullptr;         ///< set before any session exists
  rooms::EncoderThread* encoder_ = nullptr;  ///< set before any session exists
  ClusterHooks cluster_;                     ///< set before any session exists
  CommandCounters counters_;
  AccessControl access_;
  Sessions sessions_;
  Recordings recordings_;
  RestApi rest_;
};

}  // namespace spindrift::service
