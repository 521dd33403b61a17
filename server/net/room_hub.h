// Which sessions are in which room, and what they watch. Sessions are links only, so tests need no network.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include <spindrift/net/server.h>

#include "outbox.h"

namespace spindrift::net {

/// The sending side of one session. Every call is thread-safe, returns at once and never calls back into the hub.
class SessionLink {
 public:
  virtual ~SessionLink() = default;
  virtual void sendAnswer(core::SharedBytes message) = 0;
  virtual void sendState(const StateTopic& topic, core::SharedBytes message) = 0;
  /// kLater: the frame may wait for wakeForFrames().
  enum class Wake { kNow, kLater };
  virtual void offerFrame(StreamIndex stream, const FrameBytes& frame, Wake wake) = 0;
  /// Frames that wait are sent from now on.
  virtual void wakeForFrames() = 0;
  virtual void offerNewest(StreamIndex stream, const FrameBytes& frame) = 0;
  /// Sets the watch of a stream; nullopt stops it.
  virtual void setWatch(StreamIndex stream, const std::optional<Watch>& watch) = 0;
  /// Outbox::enterRoom().
  virtual void enterRoom(std::shared_ptr<core::DemandTable> demand) = 0;
  virtual Outbox::Waiting waiting() const = 0;
  virtual void close(CloseCode code, std::string reason) = 0;
  virtual void closeAt(std::chrono::steady_clock::time_point when, CloseCode code, std::string reason) = 0;
};

/// The Hub of a Server. One mutex; publish() visits only the sessions that watch that room and stream. A session keeps
/// its watches when it changes the room.
class RoomHub final : public Hub {
 public:
  /// In a room with this many sessions or more, sessions are woken once for all frames of the next moment, because most
  /// of the cost of a frame is the write, and a write takes all frames along that wait.
  static constexpr std::size_t kGatherSessionCount = 64;
  /// Calls its argument once, about a millisecond later, on any thread and without the hub's lock.
  using Later = std::function<void(std::function<void()>)>;
  /// Without this call every frame wakes its sessions at once. Call it before the first session.
  void gatherFrames(Later later) { later_ = std::move(later); }

  void add(SessionId session, std::shared_ptr<SessionLink> link);
  /// Removes the session; no call reaches its link afterwards.
  void remove(SessionId session);

  void sendAnswer(SessionId session, core::SharedBytes message) override;
  void sendState(SessionId session, const StateTopic& topic, core::SharedBytes message) override;
  void broadcastState(const std::string& room, const StateTopic& topic, core::SharedBytes message) override;
  void publish(const std::string& room, StreamIndex stream, const FrameBytes& frame) override;
  void offerNewest(const std::string& room, StreamIndex stream, const FrameBytes& frame) override;
  void join(SessionId session, const std::string& room, std::shared_ptr<core::DemandTable> demand) override;
  void watch(SessionId session, StreamIndex stream, const Watch& watch) override;
  void close(SessionId session, CloseCode code, std::string reason) override;
  void closeAt(SessionId session, std::chrono::steady_clock::time_point when, CloseCode code,
               std::string reason) override;

  /// Sum over all sessions.
  Outbox::Waiting waiting() const;
  /// Number of rooms with at least one session.
  std::size_t roomCount() const;

 private:
  struct Member {
    std::shared_ptr<SessionLink> link;
    std::optional<std::string> room;
    std::array<bool, kMaxStreamCount> watches{};
  };
  struct Watcher {
    SessionId session = 0;
    SessionLink* link = nullptr;  ///< owned by the session, which leaves the room before it is destroyed
  };
  struct Group {
    std::vector<Watcher> sessions;
    bool will_wake = false;  ///< wakeRoom() comes
    std::array<std::vector<Watcher>, kMaxStreamCount> watchers;
  };

  void enterRoom(SessionId session, Member& member, const std::string& room);
  void leaveRoom(SessionId session, Member& member);
  void wakeRoom(const std::string& room);

  Later later_;
  mutable std::mutex mutex_;
  std::unordered_map<SessionId, Member> members_;
  std::map<std::string, Group> rooms_;
};

}  // namespace spindrift::net
