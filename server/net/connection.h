// One TCP connection: HTTP requests one after another, which may end in an upgrade to a WebSocket session.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>

#include <spindrift/http/request.h>

#include "server_context.h"
#include "session.h"
#include "transport.h"

namespace spindrift::net {

class PendingAnswer;

class Connection final : public std::enable_shared_from_this<Connection> {
 public:
  /// The socket's executor must be a strand of its own.
  Connection(std::uint64_t id, boost::asio::ip::tcp::socket socket, ServerContext& context);

  /// Serves in the background until the connection is gone, then leaves context.connections.
  void start();

  /// A session closes with 1001; a plain HTTP connection is just closed. Thread-safe; returns at once.
  void shutDown();
  /// Closes the socket now. Thread-safe; returns at once.
  void cut();

 private:
  boost::asio::awaitable<void> run();
  /// Reads one request; returns false if the connection is over: it was closed, or the request refused.
  boost::asio::awaitable<bool> read(RequestParser& parser);
  /// Makes the connection a TLS one; returns false if it is over.
  boost::asio::awaitable<bool> secure();
  /// Asks the application; 503 if the server ends meanwhile.
  boost::asio::awaitable<Reply> ask(const HttpRequest& request);
  boost::asio::awaitable<void> upgrade(const Request& request);
  /// Adapts the reply to this request's target and origin: see asProblem() and allowOrigin().
  Reply fitted(const Request& request, Reply reply) const;
  /// Returns whether this is a CORS preflight of an allowed Origin for the REST interface.
  bool isPreflight(const Request& request) const;
  /// Sets peer_ and address_ for this request, whose client a trusted proxy may name; returns the refusal of a
  /// malformed X-Forwarded-For.
  std::optional<Reply> identify(const Request& request);
  /// Returns a refusal for a request over its address's rate or from a foreign page, upgrade or not; else nullopt.
  std::optional<Reply> refuseAny(const Request& request);
  /// Returns false if the connection is gone.
  boost::asio::awaitable<bool> send(const Reply& reply, bool head_only, unsigned version, bool keep_alive);
  /// Sends the last reply of this connection, then closes so that the peer can still read it.
  boost::asio::awaitable<void> sendLast(Reply reply, bool head_only);

  const std::uint64_t id_;
  ServerContext& context_;
  const boost::asio::any_io_executor strand_;
  const boost::asio::ip::tcp::endpoint endpoint_;  ///< of the TCP peer
  const bool is_by_proxy_;                         ///< the TCP peer is a trusted proxy
  std::string peer_;                               ///< client of the present request, for the log
  std::string address_;                            ///< its key in AddressLimits
  Transport stream_;
  boost::beast::flat_buffer buffer_;
  std::shared_ptr<Session> session_;  ///< owns the stream after the upgrade
  PendingAnswer* pending_ = nullptr;  ///< while a request waits for the application
  bool is_sending_ = false;           ///< a reply, which shutDown() lets go out
  bool stopping_ = false;
};

}  // namespace spindrift::net
