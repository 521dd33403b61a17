// A small Application for tests: greets, echoes, and follows commands in the clients' messages.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <spindrift/net/server.h>

#include "ws_client.h"

namespace spindrift::test {

inline core::Bytes bytes(std::string_view text) {
  return {text.begin(), text.end()};
}
inline std::string text(const std::optional<core::Bytes>& message) {
  return message ? std::string(message->begin(), message->end()) : std::string("(nothing)");
}
inline core::SharedBytes shared(std::string_view content) {
  return core::share(bytes(content));
}

/// Waits for a condition that must become true; false only after kPatience.
inline bool eventually(const std::function<bool()>& holds) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (!holds()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

/// The demand tables of rooms, made when they are first asked for. Any thread.
class DemandTables {
 public:
  std::shared_ptr<core::DemandTable> of(const std::string& room) {
    const std::lock_guard lock(mutex_);
    auto& table = tables_[room];
    if (!table) table = std::make_shared<core::DemandTable>();
    return table;
  }
  /// Number of watchers of a stream at any level.
  std::size_t watcherCount(const std::string& room, net::StreamIndex stream) {
    std::size_t count = 0;
    for (const core::LevelDemand& level : of(room)->of(stream, {})) count += level.watcher_count;
    return count;
  }

 private:
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<core::DemandTable>> tables_;
};

/// Messages: "echo ..." is sent back; "watch L RATE" watches and answers "watching"; "flood N BYTES" sends N control
/// messages "0 ...", "1 ..."; "throw" throws; "bye" closes with 1000. Rooms: "" and "pool"; each session joins the room
/// of its path.
class TestApplication final : public net::Application {
 public:
  struct Closed {
    net::SessionId session;
    net::SessionEnd end;
  };

  net::Hub* hub = nullptr;
  /// Set it before a session that uses it.
  std::function<std::unique_ptr<core::Translator>(const net::SessionOpening&)> make_translator;
  DemandTables demands;

  void serverStarts(net::Hub& served_by) override { hub = &served_by; }

  core::Result<void> acceptSession(const std::string& room) override {
    if (room == "throws") throw std::runtime_error("acceptSession was asked to throw");
    if (room.empty() || room == "pool") return {};
    if (room == "later") return core::Error{core::ErrorCode::kUnavailable, "the room cannot be reached now"};
    return core::Error{core::ErrorCode::kInvalidInput, "there is no room \"" + room + "\""};
  }

  std::unique_ptr<core::Translator> translatorFor(const net::SessionOpening& opening) override {
    return make_translator ? make_translator(opening) : nullptr;
  }

  void sessionOpened(net::SessionId session, const net::SessionOpening& opening) override {
    const Alone alone(*this, session);
    {
      const std::lock_guard lock(mutex_);
      opened_.push_back(session);
      peers_.push_back(opening.peer);
    }
    hub->join(session, opening.room, demands.of(opening.room));
    hub->sendAnswer(session, shared("hello " + opening.room + (opening.is_onlooker ? " to look" : "")));
  }

  void sessionMessage(net::SessionId session, core::ByteView message) override {
    const Alone alone(*this, session);
    ++message_count;
    std::istringstream words(std::string(message.begin(), message.end()));
    std::string verb;
    words >> verb;
    if (verb == "echo") {
      hub->sendAnswer(session, core::share(core::Bytes(message.begin(), message.end())));
    } else if (verb == "watch") {
      net::StreamIndex stream = 0;
      double rate_hz = 0.0;
      words >> stream >> rate_hz;
      hub->watch(session, stream, {.max_rate_hz = rate_hz});
      hub->sendAnswer(session, shared("watching"));
    } else if (verb == "flood") {
      std::size_t count = 0;
      std::size_t size_bytes = 0;
      words >> count >> size_bytes;
      for (std::size_t k = 0; k < count; ++k) {
        core::Bytes content = bytes(std::to_string(k) + " ");
        content.resize(std::max(content.size(), size_bytes));
        hub->sendAnswer(session, core::share(std::move(content)));
      }
    } else if (verb == "throw") {
      throw std::runtime_error("sessionMessage was asked to throw");
    } else if (verb == "bye") {
      hub->sendAnswer(session, shared("last words"));
      hub->close(session, net::CloseCode::kNormal, "as you wish");
    }
  }

  void sessionClosed(net::SessionId session, const net::SessionEnd& end) override {
    const Alone alone(*this, session);
    const std::lock_guard lock(mutex_);
    closed_.push_back({session, end});
  }

  /// "/api/keep" keeps the responder in `kept`, "/api/forget" drops it.
  void httpRequest(const net::HttpRequest& request, net::HttpResponder respond) override {
    if (request.path == "/healthz") return respond(net::HttpReply{200, "text/plain", "ok\n"});
    if (request.path == "/api/throw") throw std::runtime_error("httpRequest was asked to throw");
    if (request.path == "/api/forget") return;
    if (request.path == "/api/keep") {
      const std::lock_guard lock(mutex_);
      kept.push_back(std::move(respond));
      return;
    }
    if (request.path != "/api/echo") return respond(std::nullopt);
    respond(net::HttpReply{
        200, "text/plain",
        request.method + " " + request.query + " " + std::string(request.body.begin(), request.body.end())});
  }
  std::size_t keptCount() const {
    const std::lock_guard lock(mutex_);
    return kept.size();
  }
  std::vector<net::HttpResponder> kept;

  std::vector<net::SessionId> opened() const {
    const std::lock_guard lock(mutex_);
    return opened_;
  }
  std::vector<std::string> peers() const {
    const std::lock_guard lock(mutex_);
    return peers_;
  }
  std::vector<Closed> closed() const {
    const std::lock_guard lock(mutex_);
    return closed_;
  }

  std::atomic<int> message_count{0};
  std::atomic<int> overlap_count{0};       ///< callbacks of one session that ran at the same time
  std::atomic<int> after_closed_count{0};  ///< callbacks after sessionClosed

 private:
  /// Reports a callback that runs at the same time as another of its session, or after its last one.
  class Alone {
   public:
    Alone(TestApplication& application, net::SessionId session) : application_(application), session_(session) {
      const std::lock_guard lock(application_.mutex_);
      if (!application_.inside_.insert(session).second) ++application_.overlap_count;
      for (const Closed& closed : application_.closed_) application_.after_closed_count += closed.session == session;
    }
    Alone(const Alone&) = delete;
    Alone& operator=(const Alone&) = delete;
    ~Alone() {
      const std::lock_guard lock(application_.mutex_);
      application_.inside_.erase(session_);
    }

   private:
    TestApplication& application_;
    const net::SessionId session_;
  };

  mutable std::mutex mutex_;
  std::set<net::SessionId> inside_;
  std::vector<net::SessionId> opened_;
  std::vector<std::string> peers_;
  std::vector<Closed> closed_;
};

/// A server on a free port with a TestApplication.
struct TestServer {
  explicit TestServer(net::ServerOptions options = {}) {
    options.port = 0;
    auto started = net::Server::start(options, application);
    if (!started) throw std::runtime_error(started.error().message);
    server = std::move(*started);
  }

  /// Returns a client that has received its greeting.
  WsClient client(const std::string& target = "/ws", int receive_buffer_bytes = 0) const {
    WsClient out;
    if (receive_buffer_bytes > 0) out.setReceiveBuffer(receive_buffer_bytes);
    EXPECT_TRUE(out.connect("127.0.0.1", server->port(), target)) << out.handshakeStatus() << out.handshakeBody();
    EXPECT_TRUE(text(out.receive()).starts_with("hello"));
    return out;
  }

  /// Returns a client that watches the stream.
  WsClient watcher(net::StreamIndex stream, double rate_hz = 1e6, int receive_buffer_bytes = 0) const {
    WsClient out = client("/ws/pool", receive_buffer_bytes);
    out.sendBinary(bytes("watch " + std::to_string(stream) + " " + std::to_string(rate_hz)));
    EXPECT_EQ(text(out.receive()), "watching");
    return out;
  }

  /// Returns whether the server still answers a new client.
  bool serves() const {
    WsClient probe = client();
    return probe.sendBinary(bytes("echo alive")) && text(probe.receive()) == "echo alive";
  }

  TestApplication application;
  std::unique_ptr<net::Server> server;
};

}  // namespace spindrift::test
