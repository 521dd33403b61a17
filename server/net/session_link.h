// What a Hub knows of a session: tests of the hub need no network.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include <spindrift/net/server.h>

namespace spindrift::net {

/// The sending side of one session. Every call is thread-safe and returns at once; only writeNow() may call back into
/// the hub.
class SessionLink {
 public:
  virtual ~SessionLink() = default;
  virtual void sendAnswer(core::SharedBytes message) = 0;
  virtual void sendState(const StateTopic& topic, core::SharedBytes message) = 0;
  /// kLater: the frame may wait for takesFrames() and writeNow().
  enum class Wake { kNow, kLater };
  virtual void offerFrame(StreamIndex stream, const FrameBytes& frame, Wake wake) = 0;
  /// Returns whether frames wait that nobody sends yet: call writeNow().
  virtual bool takesFrames() = 0;
  /// Sends what waits: on this thread if it is an I/O thread and nothing else of the session runs. Call it without
  /// locks.
  virtual void writeNow() = 0;
  virtual void offerNewest(StreamIndex stream, const FrameBytes& frame) = 0;
  /// Sets the watch of a stream; nullopt stops it.
  virtual void setWatch(StreamIndex stream, const std::optional<Watch>& watch) = 0;
  /// Outbox::enterRoom().
  virtual void enterRoom(std::shared_ptr<core::DemandTable> demand) = 0;
  virtual Waiting waiting() const = 0;
  virtual void close(CloseCode code, std::string reason) = 0;
  virtual void closeAt(std::chrono::steady_clock::time_point when, CloseCode code, std::string reason) = 0;
};

}  // namespace spindrift::net
