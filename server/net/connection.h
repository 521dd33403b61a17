// One TCP connection: HTTP requests one after another, and perhaps an upgrade to a WebSocket session.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>

#include "http_routes.h"
#include "server_context.h"
#include "session.h"

namespace spindrift::net {

class Connection final : public Stoppable, public std::enable_shared_from_this<Connection> {
 public:
  /// The socket's executor is a strand of its own.
  Connection(std::uint64_t id, boost::asio::ip::tcp::socket socket, ServerContext& context);

  /// Serves in the background until the connection is gone, then leaves context.connections.
  void start();

  void shutDown() override;
  void cut() override;

 private:
  boost::asio::awaitable<void> run();
  boost::asio::awaitable<void> upgrade(const UpgradeRequest& request);
  /// False if the connection is gone.
  boost::asio::awaitable<bool> send(const Reply& reply, bool head_only, unsigned version, bool keep_alive);
  /// Sends the last reply of this connection and hangs up so that the peer can still read it.
  boost::asio::awaitable<void> sendLast(Reply reply, bool head_only);

  const std::uint64_t id_;
  ServerContext& context_;
  const boost::asio::any_io_executor strand_;
  const std::string peer_;
  boost::beast::tcp_stream stream_;
  boost::beast::flat_buffer buffer_;
  std::shared_ptr<Session> session_;  ///< owns the stream after the upgrade
  bool stopping_ = false;
};

}  // namespace spindrift::net
