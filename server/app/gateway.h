// Between the network and the rooms: what the bytes of a session mean. Implements net::Application; runs on I/O
// threads.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include <spindrift/net/server.h>

#include "simulation_thread.h"

namespace spindrift::app {

class Gateway final : public net::Application, public RoomObserver {
 public:
  /// `rooms` outlives the gateway, though its thread may have ended.
  Gateway(const SimulationThread& rooms, std::size_t message_max_bytes, double messages_per_s);

  void serverStarts(net::Hub& hub) override { hub_ = &hub; }
  core::Result<void> acceptSession(const std::string& room) override;
  void sessionOpened(net::SessionId session, const std::string& room, const std::string& peer) override;
  void sessionMessage(net::SessionId session, core::ByteView message) override;
  void sessionClosed(net::SessionId session, const net::SessionEnd& end) override;
  std::optional<net::HttpReply> httpRequest(const net::HttpRequest& request) override;

  /// Greets everybody in the room again; their layers go on.
  void sceneChanged(const Room& room) override;

 private:
  struct Session {
    Room* room = nullptr;
    bool said_hello = false;
  };

  net::Hub& hub() { return *hub_; }
  /// Sends a greeting and returns the state that it described.
  std::shared_ptr<const RoomSnapshot> greet(net::SessionId session, const Room& room);

  const SimulationThread& rooms_;
  const std::size_t message_max_bytes_;
  const double messages_per_s_;
  net::Hub* hub_ = nullptr;  ///< set before any session exists
  std::mutex mutex_;
  std::map<net::SessionId, Session> sessions_;
};

}  // namespace spindrift::app
