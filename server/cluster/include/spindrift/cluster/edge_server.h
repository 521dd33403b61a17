// A whole edge in one object: serves sessions of the rooms of a cluster, and runs none.
#pragma once

#include <atomic>
#include <memory>

#include <spindrift/cluster/node.h>
#include <spindrift/core/result.h>
#include <spindrift/net/server.h>
#include <spindrift/service/metrics.h>
#include <spindrift/service/sessions.h>
#include <spindrift/service/translators.h>

namespace spindrift::cluster {

struct EdgeOptions {
  NodeOptions node;
  net::ServerOptions network;
  service::AccessOptions access;
};

class EdgeServer final : public net::Application {
 public:
  /// Starts the edge. Errors: those of Node::connect() and of the port.
  static core::Result<std::unique_ptr<EdgeServer>> start(EdgeOptions options);
  ~EdgeServer() override;
  EdgeServer(const EdgeServer&) = delete;
  EdgeServer& operator=(const EdgeServer&) = delete;

  /// Does for an edge what WaterServer::drain() does.
  void drain(std::chrono::milliseconds closes_in, const std::string& go_to);
  [[nodiscard]] net::Server& network() { return *network_; }
  /// Closes the sessions with 1001. Idempotent.
  void stop();
  [[nodiscard]] service::AccessControl& access() { return access_; }
  [[nodiscard]] std::uint16_t port() const { return network_->port(); }
  [[nodiscard]] net::ServerStats networkStats() const { return network_->stats(); }

  // net::Application
  void serverStarts(net::Hub& hub) override;
  core::Result<void> acceptSession(const std::string& room) override;
  std::unique_ptr<core::Translator> translatorFor(const net::SessionOpening& opening) override {
    return service::translatorOf(opening);
  }
  void sessionOpened(net::SessionId session, const net::SessionOpening& opening) override;
  void sessionLevelChanged(net::SessionId session, core::Level level) override {
    sessions_.levelChanged(session, level);
  }
  void sessionMessage(net::SessionId session, core::ByteView message) override { sessions_.message(session, message); }
  void sessionClosed(net::SessionId session, const net::SessionEnd& end) override { sessions_.closed(session, end); }
  void httpRequest(const net::HttpRequest& request, net::HttpResponder respond) override;

 private:
  explicit EdgeServer(service::AccessOptions access) : access_(std::move(access)), sessions_({}, access_, counters_) {}

  std::atomic<bool> is_draining_{false};
  service::CommandCounters counters_;
  service::AccessControl access_;
  service::Sessions sessions_;
  std::unique_ptr<net::Server> network_;
  std::atomic<net::Server*> started_{nullptr};
  std::unique_ptr<Node> node_;  ///< before the network ends its links use the sessions
};

}  // namespace spindrift::cluster
