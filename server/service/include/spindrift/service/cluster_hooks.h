// What a server that is part of a cluster adds to its gateway; implemented by server/cluster.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include <spindrift/codec/frame_encoder.h>
#include <spindrift/core/bytes.h>
#include <spindrift/net/server.h>
#include <spindrift/rooms/room_host.h>
#include <spindrift/service/venue.h>

namespace spindrift::service {

/// Those who follow this server's rooms from other processes; they are in the demand of the rooms. Thread-safe; no call
/// blocks.
class RemoteAudience {
 public:
  virtual ~RemoteAudience() = default;
  /// Takes a change of the room's scene.
  virtual void sceneChanged(const rooms::Room& room) = 0;
  /// Takes a state message, which the sessions of this process get too.
  virtual void stateChanged(const rooms::Room& room, const net::StateTopic& topic,
                            const core::SharedBytes& message) = 0;
  virtual void closed(const rooms::Room& room) = 0;
  /// Returns whether the command came from another process; it gets the answer.
  virtual bool commandApplied(const rooms::Command& command, const v1::Ack& ack) = 0;
  virtual bool commandRejected(const rooms::Command& command, const wire::CommandRejection& rejection) = 0;
  /// Returns whether the sender is a session of another process; it gets the answer.
  virtual bool queryAnswered(const core::Sender& sender, const v1::QueryAnswer& answer) = 0;
  virtual bool hullsFelt(const core::Sender& sender, const v1::HullForces& forces) = 0;
  virtual void publish(const std::string& room, codec::Stream stream, const codec::EncodedFrame& frame,
                       const core::FrameLevels& levels) = 0;
};

/// The other servers and their rooms. Thread-safe; no call blocks.
class Cluster {
 public:
  virtual ~Cluster() = default;
  /// Returns the room of that name, wherever it runs, or null. The empty name is the default room.
  virtual std::shared_ptr<Venue> find(const std::string& room) = 0;
  /// Decides as net::Application::acceptSession() does, for a room of another server.
  virtual core::Result<void> accept(const std::string& room) = 0;
  /// Takes a request that another server has to answer, or several together; returns false if this process should.
  virtual bool takeRequest(const net::HttpRequest& request, const net::HttpResponder& respond) = 0;
  /// Opens a room on this server, under a name that no server of the cluster uses. Errors: as
  /// RoomHost::openRoom(), and kUnavailable when the directory of rooms does not answer.
  virtual void openRoom(rooms::RoomSetup setup, const rooms::RoomHost::Done& done) = 0;
};

/// All empty: the server is alone.
struct ClusterHooks {
  RemoteAudience* audience = nullptr;
  Cluster* cluster = nullptr;
  std::function<std::string()> metrics{};  ///< added to the page of metrics
};

}  // namespace spindrift::service
