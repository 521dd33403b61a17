// Rooms of this server, for nodes of the cluster: publishes each watched stream and level once per frame, tells the
// nodes what changes, and takes their people and commands in. What it costs depends on the number of nodes that watch a
// room, not on the number of their clients.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include <spindrift/bus/bus.h>
#include <spindrift/rooms/room_host.h>
#include <spindrift/service/cluster_hooks.h>
#include <spindrift/v1/cluster.pb.h>

#include "subjects.h"

namespace spindrift::cluster {

/// Version of cluster.proto, the frames' head and the numbers of streams.
inline constexpr std::uint32_t kClusterVersion = 5;
/// A link whose other end was silent for so long is dead.
inline constexpr std::chrono::milliseconds kLinkPatience{1'500};
/// Interval of the messages that show that an end of a link is alive.
inline constexpr std::chrono::milliseconds kPulseInterval{200};

/// Thread-safe: called by the rooms' threads, the encoder thread, the bus and the thread of the node.
class Feed final : public service::RemoteAudience {
 public:
  using Clock = std::chrono::steady_clock;

  struct Events {
    /// Another session continues in the place of one of this process.
    std::function<void(core::SessionId)> displaced;
    /// A room was closed for good.
    std::function<void(const std::string& room)> closed;
    /// A command of a node was not admitted; the feed gets it back through commandRejected().
    std::function<void(const rooms::Command&, const wire::CommandRejection&)> rejected;
  };
  /// `bus` outlives it.
  Feed(bus::Bus& bus, Subjects subjects, Events events)
      : bus_(bus), subjects_(std::move(subjects)), events_(std::move(events)) {}

  /// Opens the rooms that are new to the nodes, drops silent links, sends pulses, counts who only watches. Call it some
  /// twenty times per second.
  void review(const std::vector<std::shared_ptr<rooms::Room>>& rooms, const rooms::RoomHost& simulation,
              Clock::time_point now);
  /// The room continues at another server, to which the nodes attach: they are not told that it was closed.
  void giveUp(const std::string& name);
  [[nodiscard]] std::uint64_t frameCount() const { return frame_count_; }
  /// Links whose node fell silent.
  [[nodiscard]] std::uint64_t lostLinkCount() const { return lost_link_count_; }

  // RemoteAudience
  void sceneChanged(const rooms::Room& room) override;
  void stateChanged(const rooms::Room& room, const net::StateTopic& topic, const core::SharedBytes& message) override;
  void closed(const rooms::Room& room) override;
  bool commandApplied(const rooms::Command& command, const v1::Ack& ack) override;
  bool commandRejected(const rooms::Command& command, const wire::CommandRejection& rejection) override;
  bool queryAnswered(const core::Sender& sender, const v1::QueryAnswer& answer) override;
  bool hullsFelt(const core::Sender& sender, const v1::HullForces& forces) override;
  void publish(const std::string& name, codec::Stream stream, const codec::EncodedFrame& frame,
               const core::FrameLevels& levels) override;

 private:
  /// Needs of a node; nullopt: it does not watch this stream at this level.
  using StreamTable =
      std::array<std::array<std::optional<core::DemandTable::Need>, core::kLevelCount>, codec::kStreamCount>;
  /// One node that has attached to one room.
  struct Link {
    std::uint64_t number = 0;    ///< of the node
    std::uint32_t prefix = 0;    ///< of the ids of its sessions in this process
    std::uint64_t sequence = 0;  ///< of the last message sent
    Clock::time_point heard{};
    StreamTable watched{};
    std::uint32_t session_count = 0;
    std::uint32_t unlisted_count = 0;  ///< of these, people who only watch and are not in the roster
    std::set<std::uint64_t> arrived;   ///< sessions of the node whose people are in the roster
  };
  struct FedRoom {
    std::shared_ptr<rooms::Room> room;
    std::uint64_t run = 0;
    std::map<std::string, Link> links;  ///< by node
    std::array<std::array<std::uint64_t, core::kLevelCount>, codec::kStreamCount> sequences{};
    core::ReducedCounts reduced_counts{};   ///< as the nodes know them
    std::uint32_t told_unlisted_count = 0;  ///< of all links, as the roster has it
    Clock::time_point next_unlisted{};
    std::string device;
    std::vector<std::string> scenes;
    std::unique_ptr<bus::Subscription> requests;
  };

  void take(const std::string& name, core::ByteView bytes);
  void attach(FedRoom& room, const v1::ToRoom& message);
  /// The people of a link leave the room, and nobody of it watches.
  static void endLink(FedRoom& room, Link& link);
  /// The node says what its sessions watch.
  static void takeWatching(FedRoom& room, Link& link, const v1::Watching& watching);
  /// Call with the mutex held.
  void send(const std::string& room, const std::string& node, Link& link, v1::FromRoom message) const;
  void sendView(const std::string& name, FedRoom& room, const std::string& node, Link& link, double node_time_s) const;
  /// Sends the message to the node of the session; false: it is of this process.
  bool sendToNodeOf(core::SessionId session, v1::FromRoom message);

  bus::Bus& bus_;
  const Subjects subjects_;
  const Events events_;
  mutable std::mutex mutex_;
  mutable std::map<std::string, FedRoom> rooms_;
  std::uint32_t last_prefix_ = 0;
  std::map<std::uint32_t, std::pair<std::string, std::string>> by_prefix_;  ///< room and node
  Clock::time_point next_pulse_{};
  std::atomic<std::uint64_t> frame_count_{0};
  std::atomic<std::uint64_t> lost_link_count_{0};
};

}  // namespace spindrift::cluster
