// A server in a cluster: its claims of rooms, its pulse, and sessions that come through edges. Longer than 400 lines,
// because one mutex guards what the bus's thread and the rooms' threads share.
#include <atomic>
#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

#include <spdlog/spdlog.h>

#include <spindrift/bus/bus.h>
#include <spindrift/cluster/node.h>
#include <spindrift/core/room_name.h>
#include <spindrift/service/metrics.h>

#include "directory.h"
#include "feed.h"
#include "messages.h"
#include "node_name.h"
#include "placement.h"
#include "remote_room.h"
#include "request_route.h"
#include "requests.h"
#include "subjects.h"

namespace spindrift::cluster {
namespace {

using namespace std::chrono_literals;

constexpr auto kRound = 50ms;
constexpr auto kDirectoryInterval = 250ms;
constexpr std::size_t kInboxWaitingMaxBytes = 64u << 20;
constexpr std::size_t kPulsesWaitingMaxBytes = 4u << 20;

class NodeImpl final : public Node {
 public:
  NodeImpl(const NodeOptions& options, std::unique_ptr<bus::Bus> bus)
      : options_(options),
        subjects_(options.cluster),
        bus_(std::move(bus)),
        requests_(*bus_, subjects_, options.name) {}
  NodeImpl(const NodeImpl&) = delete;
  NodeImpl& operator=(const NodeImpl&) = delete;
  ~NodeImpl() override { stop(); }

  core::Result<void> start();

  core::Result<std::vector<rooms::RoomSetup>> claim(std::vector<rooms::RoomSetup> rooms) override {
    return directory_->claim(std::move(rooms));
  }
  service::ClusterHooks hooks() override {
    return {.audience = feed_.get(), .cluster = this, .metrics = [this] { return metrics(); }};
  }
  void serve(service::Sessions& sessions, const ServerParts& server) override;
  [[nodiscard]] core::Result<void> ready() const override;
  void leave() override {
    leaving_ = true;
    if (directory_) directory_->leave();
  }
  void release() override {
    if (directory_) directory_->release();
  }

  // service::Cluster
  std::shared_ptr<service::Venue> find(const std::string& room) override;
  core::Result<void> accept(const std::string& room) override;
  bool takeRequest(const net::HttpRequest& request, const net::HttpResponder& respond) override;
  void openRoom(rooms::RoomSetup setup, const rooms::RoomHost::Done& done) override {
    directory_->open(std::move(setup), done);
  }

 private:
  void stop();
  void loop();
  void round(Clock::time_point now);
  void sendPulse(Clock::time_point now);
  void takeMail(core::ByteView message);
  /// Returns whether all servers that are alive were heard, so that a room that none of them runs does not exist.
  [[nodiscard]] bool hasHeardAll() const;
  /// Joins the list of rooms of this process, if it runs some, with those of other servers.
  void listRooms(const net::HttpRequest& request, std::vector<std::string> servers, const net::HttpResponder& respond);
  /// Returns one metric after the other, as Prometheus text; docs/cluster.md explains them.
  [[nodiscard]] std::string metrics() const;
  [[nodiscard]] std::string nameTaken(const std::string& process) const;
  [[nodiscard]] Servers servers() const {
    const std::lock_guard lock(mutex_);
    return servers_;
  }

  const NodeOptions options_;
  const Subjects subjects_;
  const std::unique_ptr<bus::Bus> bus_;
  std::unique_ptr<Feed> feed_;            ///< of a server
  std::unique_ptr<Directory> directory_;  ///< of a server
  Requests requests_;
  service::Sessions* sessions_ = nullptr;
  rooms::RoomHost* simulation_ = nullptr;  ///< of a server
  rooms::RoomOutlets* outlets_ = nullptr;  ///< likewise
  Answer answer_;
  std::atomic<bool> leaving_{false};
  std::atomic<bool> serving_{false};
  mutable std::mutex mutex_;
  Servers servers_;
  Clock::time_point heard_all_{};  ///< guarded by mutex_: hasHeardAll() from then on
  std::map<std::string, std::shared_ptr<RemoteRoom>> remote_;
  LinkStats ended_;  ///< of links that are gone
  Clock::time_point next_pulse_{};
  Clock::time_point next_review_{};
  std::condition_variable wake_;
  bool stopping_ = false;
  std::thread thread_;
  // Last: their handlers use all of the above.
  std::unique_ptr<bus::Subscription> inbox_;
  std::unique_ptr<bus::Subscription> pulses_;
  std::unique_ptr<bus::Subscription> forwards_;
  std::unique_ptr<NodeName> name_;
};

core::Result<void> NodeImpl::start() {
  if (options_.runs_rooms) {
    auto values = bus::KeyValues::open(*bus_, subjects_.directory());
    if (!values) return values.error();
    directory_ = std::make_unique<Directory>(
        *std::move(values), options_.name,
        Directory::Hooks{.servers = [this] { return servers(); },
                         .opened = [this] { sendPulse(Clock::now()); },
                         .lost =
                             [this](const std::string& room, const std::string& server) {
                               feed_->giveUp(room);
                               sessions_->dismiss(room, net::CloseCode::kGoingAway,
                                                  "the room continues at server " + server + ": connect again");
                             }});
    feed_ = std::make_unique<Feed>(
        *bus_, subjects_,
        Feed::Events{.displaced = [this](core::SessionId session) { sessions_->displace(session); },
                     .closed =
                         [this](const std::string& room) {
                           directory_->remove(room);
                           sendPulse(Clock::now());
                         },
                     .rejected =
                         [this](const rooms::Command& command, const wire::CommandRejection& rejection) {
                           outlets_->commandRejected(command, rejection);
                         }});
  }
  pulses_ = bus_->subscribe(subjects_.servers(), kPulsesWaitingMaxBytes, [this](core::ByteView message) {
    if (const auto pulse = parse<v1::ServerPulse>(message)) {
      const std::lock_guard lock(mutex_);
      servers_.note(*pulse, Clock::now());
    }
  });
  inbox_ = bus_->subscribe(subjects_.node(options_.name), kInboxWaitingMaxBytes,
                           [this](core::ByteView message) { takeMail(message); });
  if (!pulses_ || !inbox_) return core::unavailable("NATS: the node's subjects cannot be subscribed to");
  name_ = std::make_unique<NodeName>(*bus_, subjects_.name(options_.name), [this](const std::string& process) {
    spdlog::error("{}, and continues with it: this process ends", nameTaken(process));
    if (options_.on_name_lost) options_.on_name_lost();
  });
  if (const std::string process = name_->claim(kListenTime); !process.empty()) {
    return core::invalid(nameTaken(process) +
                         ": give each process a name of its own; a name is free when its process has ended");
  }
  return {};
}

std::string NodeImpl::nameTaken(const std::string& process) const {
  return "--node '" + options_.name + "': " + process + " has this name in cluster '" + options_.cluster + "'";
}

void NodeImpl::serve(service::Sessions& sessions, const ServerParts& server) {
  sessions_ = &sessions;
  simulation_ = server.simulation;
  outlets_ = server.outlets;
  answer_ = server.answer;
  if (directory_) directory_->serve(*simulation_);
  if (simulation_) {
    forwards_ = bus_->subscribe(subjects_.server(options_.name), kInboxWaitingMaxBytes, [this](core::ByteView message) {
      if (const auto forward = parse<v1::HttpForward>(message)) answerForward(*bus_, subjects_, *forward, answer_);
    });
  }
  serving_ = true;
  thread_ = std::thread([this] { loop(); });
}

void NodeImpl::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
  name_.reset();
  inbox_.reset();
  pulses_.reset();
  forwards_.reset();
  std::map<std::string, std::shared_ptr<RemoteRoom>> remote;
  {
    const std::lock_guard lock(mutex_);
    remote.swap(remote_);
  }
  for (const auto& [name, room] : remote) room->detach();
}

void NodeImpl::loop() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    lock.unlock();
    round(Clock::now());
    lock.lock();
    wake_.wait_for(lock, kRound, [this] { return stopping_; });
  }
}

void NodeImpl::round(Clock::time_point now) {
  std::vector<std::shared_ptr<RemoteRoom>> rooms;
  std::vector<std::shared_ptr<RemoteRoom>> idle;
  {
    const std::lock_guard lock(mutex_);
    if (!bus_->isConnected()) heard_all_ = now + kListenTime;
    servers_.review(now);
    for (auto it = remote_.begin(); it != remote_.end();) {
      // A reference here, one in `remote_`: no session has it.
      if (it->second.use_count() == 1 && it->second->isIdle(now)) {
        idle.push_back(std::move(it->second));
        it = remote_.erase(it);
      } else {
        rooms.push_back(it->second);
        ++it;
      }
    }
  }
  for (const auto& room : idle) {
    room->detach();
    const LinkStats stats = room->stats();
    const std::lock_guard lock(mutex_);
    ended_.add(stats);
  }
  for (const auto& room : rooms) room->review(now);
  requests_.review(now);
  if (now >= next_pulse_) {
    next_pulse_ = now + kPulseInterval;
    name_->pulse();
    if (simulation_) sendPulse(now);
  }
  if (!simulation_) return;
  feed_->review(simulation_->rooms(), *simulation_, now);
  if (now >= next_review_) {
    next_review_ = now + kDirectoryInterval;
    directory_->review();
  }
}

void NodeImpl::sendPulse(Clock::time_point now) {
  v1::ServerPulse pulse;
  pulse.set_server(options_.name);
  for (const auto& room : simulation_->rooms()) pulse.add_rooms(room->name());
  pulse.set_load(simulation_->busyShare());
  pulse.set_room_max_count(static_cast<std::uint32_t>(options_.room_max_count));
  pulse.set_is_leaving(leaving_);
  bus_->publish(subjects_.servers(), serialize(pulse));
  const std::lock_guard lock(mutex_);
  servers_.note(pulse, now);  // NATS sends no message back to its sender
}

void NodeImpl::takeMail(core::ByteView message) {
  const auto mail = parse<v1::ToNode>(message);
  if (!mail || !serving_) return;
  if (mail->has_http_answer()) return requests_.take(mail->http_answer());
  std::shared_ptr<RemoteRoom> room;
  {
    const std::lock_guard lock(mutex_);
    const auto found = remote_.find(mail->from_room().room());
    if (found != remote_.end()) room = found->second;
  }
  if (room) room->take(mail->from_room());
}

core::Result<void> NodeImpl::ready() const {
  if (!serving_) return core::unavailable("this process is starting");
  if (!bus_->isConnected()) return core::unavailable("there is no connection to NATS");
  const std::lock_guard lock(mutex_);
  if (!options_.runs_rooms && servers_.alive(Clock::now()).empty())
    return core::unavailable("no server of the cluster is alive");
  return {};
}

std::shared_ptr<service::Venue> NodeImpl::find(const std::string& asked) {
  const std::string& name = asked.empty() ? core::kDefaultRoom : asked;
  if (!serving_ || !core::isRoomName(name)) return nullptr;
  const std::lock_guard lock(mutex_);
  const auto known = remote_.find(name);
  if (known != remote_.end() && known->second->isOpen()) return known->second;
  if (servers_.serverOf(name).empty()) return nullptr;
  auto room = std::make_shared<RemoteRoom>(name, options_.name, *bus_, subjects_, *sessions_);
  remote_[name] = room;
  return room;
}

core::Result<void> NodeImpl::accept(const std::string& room) {
  if (auto can = ready(); !can) return can;
  if (find(room)) return {};
  if (!hasHeardAll()) return core::unavailable(kNotHeardAll);
  std::string names;
  for (const std::string& known : servers().rooms()) names += (names.empty() ? "" : ", ") + known;
  return core::invalid("room '" + room + "' does not exist; rooms are: " + names);
}

bool NodeImpl::hasHeardAll() const {
  const std::lock_guard lock(mutex_);
  return Clock::now() >= heard_all_;
}

bool NodeImpl::takeRequest(const net::HttpRequest& request, const net::HttpResponder& respond) {
  if (!serving_ || !request.path.starts_with(kApi)) return false;
  if (!simulation_) {
    if (const auto can = ready(); !can) {
      respond(tryAgain(can.error().message));
      return true;
    }
  }
  const auto now = Clock::now();
  const Servers known = servers();
  RequestRoute route = routeOf(request,
                               {.servers = known,
                                .self = options_.name,
                                .is_server = simulation_ != nullptr,
                                .has_heard_all = hasHeardAll(),
                                .runs = [this](const std::string& room) { return simulation_->find(room) != nullptr; }},
                               now);
  if (std::holds_alternative<Here>(route)) return false;
  if (auto* const reply = std::get_if<net::HttpReply>(&route)) {
    respond(std::move(*reply));
  } else if (const auto* const ask = std::get_if<Ask>(&route)) {
    if (const auto grant = admit(sessions_->access(), request, respond))
      requests_.ask(ask->server, request, *grant, respond);
  } else {
    listRooms(request, known.alive(now), respond);
  }
  return true;
}

void NodeImpl::listRooms(const net::HttpRequest& request, std::vector<std::string> servers,
                         const net::HttpResponder& respond) {
  std::erase(servers, options_.name);
  std::optional<net::HttpReply> own;
  if (simulation_) {
    answer_(
        request, [&own](std::optional<net::HttpReply> reply) { own = std::move(reply); }, std::nullopt);
    if (!own || own->status != 200) return respond(std::move(own));
  }
  if (const auto grant = admit(sessions_->access(), request, respond))
    requests_.askForRooms(servers, request, *grant, own ? std::move(own->body) : "", respond);
}

std::string NodeImpl::metrics() const {
  const bus::BusStats bus = bus_->stats();
  LinkStats links;  // those that ended included
  std::size_t alive_server_count = 0;
  {
    const std::lock_guard lock(mutex_);
    links = ended_;
    alive_server_count = servers_.alive(Clock::now()).size();
    for (const auto& [name, room] : remote_) links.add(room->stats());
  }
  std::string out;
  const auto add = [&out](const char* name, const char* type, const char* help, auto value) {
    out += service::metric(name, type, help, static_cast<double>(value));
  };
  add("nats_connected", "gauge", "1 while there is a connection to NATS.", bus.is_connected);
  add("nats_reconnects_total", "counter", "Times the connection to NATS came back.", bus.reconnect_count);
  add("nats_dropped_messages_total", "counter",
      "Messages lost: not sent while disconnected, or more than a receiver took.", bus.dropped_message_count);
  add("cluster_servers", "gauge", "Servers of the cluster that are alive.", alive_server_count);
  add("cluster_remote_frames_total", "counter", "Frames received from rooms of other servers.", links.frame_count);
  add("cluster_remote_gaps_total", "counter", "Times that frames or messages of a room were missing.", links.gap_count);
  add("cluster_lost_links_total", "counter", "Times that the server of a room fell silent.", links.lost_link_count);
  if (!feed_) return out;
  add("cluster_published_frames_total", "counter", "Frames published for nodes.", feed_->frameCount());
  add("cluster_lost_nodes_total", "counter", "Nodes that fell silent while they watched a room.",
      feed_->lostLinkCount());
  add("cluster_rooms_taken_total", "counter", "Rooms taken over from other servers.", directory_->takenCount());
  add("cluster_directory_failures_total", "counter",
      "Rooms that could not be taken over, and failures of the directory of rooms.", directory_->failureCount());
  return out;
}

}  // namespace

core::Result<std::unique_ptr<Node>> Node::connect(const NodeOptions& options) {
  for (const auto& [what, name] : {std::pair("--node", options.name), std::pair("--cluster", options.cluster)}) {
    if (!core::isRoomName(name)) {
      return core::invalid(std::string(what) + " '" + name + "': names have " + std::string(core::kRoomNameRule));
    }
  }
  auto bus =
      bus::Bus::connect({.url = options.nats_url, .name = "spindrift " + options.name, .ca_file = options.ca_file});
  if (!bus) return bus.error();
  auto node = std::make_unique<NodeImpl>(options, *std::move(bus));
  if (auto started = node->start(); !started) return started.error();
  return std::unique_ptr<Node>(std::move(node));
}

}  // namespace spindrift::cluster
