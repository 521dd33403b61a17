// One WebSocket session, from the upgrade to the last byte. Everything but the SessionLink calls runs on the session's
// strand; a reader and a writer coroutine share it.
#pragma once

#include <memory>
#include <string>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "message_stream.h"
#include "outbox.h"
#include "rate_limit.h"
#include "room_hub.h"
#include "server_context.h"

namespace spindrift::net {

using UpgradeRequest = boost::beast::http::request<boost::beast::http::string_body>;

class Session final : public SessionLink, public std::enable_shared_from_this<Session> {
 public:
  /// Takes the stream over; its executor is the session's strand.
  Session(boost::beast::tcp_stream stream, ServerContext& context);

  /// Answers the upgrade, serves until the connection is gone, then returns. Calls sessionOpened first and
  /// sessionClosed last (neither, if the handshake fails). On the strand.
  boost::asio::awaitable<void> run(const UpgradeRequest& request, std::string room, std::string peer,
                                   std::string address, bool echo_subprotocol);

  void sendAnswer(core::SharedBytes message) override;
  void sendState(const StateTopic& topic, core::SharedBytes message) override;
  void offerFrame(LayerIndex layer, const LayerBytes& frame) override;
  Outbox::Demand demand(LayerIndex layer, std::uint32_t reduced_count) const override;
  void setWatch(LayerIndex layer, const std::optional<Watch>& watch) override;
  void clearFrames() override;
  Outbox::Waiting waiting() const override { return outbox_.waiting(); }
  void close(CloseCode code, std::string reason) override;
  void closeAt(std::chrono::steady_clock::time_point when, CloseCode code, std::string reason) override;

  /// Closes the socket now; every pending operation ends. On the strand.
  void cut();

 private:
  void configure(bool echo_subprotocol);
  boost::asio::awaitable<void> readLoop();
  boost::asio::awaitable<void> writeLoop();
  /// Returns once fewer than answer_pause_count answers wait, or the connection is gone: a client that does not read
  /// what it asked for is not heard any further, and TCP holds back what follows.
  boost::asio::awaitable<void> waitUntilAnswersAreTaken();
  /// One message; false if the connection is gone.
  boost::asio::awaitable<bool> write(const core::Bytes& message);
  /// After a message went out: whether the link carries what it is given.
  void reviewLevel();
  /// Cuts the connection when a write passes its deadline. One timer runs on from write to write, not moved for each.
  void watchWrites();
  /// Sends the close frame and waits for the peer's, within the close deadline.
  boost::asio::awaitable<void> sayGoodbye();
  /// Runs an application callback; an exception in it ends this session and no other.
  template <typename Callback>
  void callApplication(const char* name, Callback&& callback);
  /// Cuts the connection at the deadline unless it is gone before. On the strand, once.
  void armCloseDeadline();
  void wakeWriter();
  /// Keeps the first account of why the session ended.
  void noteEnd(std::uint16_t code, std::string reason);

  ServerContext& context_;
  const SessionId id_;
  boost::beast::websocket::stream<MessageStream> ws_;
  const boost::asio::any_io_executor strand_;
  Outbox outbox_;
  TokenBucket message_tokens_;
  std::uint64_t untaken_fragment_count_ = 0;  ///< that no token was taken for yet
  boost::beast::flat_buffer read_buffer_;
  boost::asio::steady_timer wake_timer_;     ///< the writer sleeps on it
  boost::asio::steady_timer answers_timer_;  ///< the reader sleeps on it; see waitUntilAnswersAreTaken()
  boost::asio::steady_timer stall_timer_;    ///< looks whether a write takes too long; see watchWrites()
  boost::asio::steady_timer close_timer_;
  boost::asio::steady_timer end_timer_;                                  ///< of closeAt()
  boost::asio::steady_timer end_of_delay_;                               ///< a message waits for its address's bucket
  std::optional<std::chrono::steady_clock::time_point> write_deadline_;  ///< while a write is out
  bool watches_writes_ = false;
  std::string address_;  ///< what AddressLimits knows the peer by
  std::optional<SessionEnd> end_;
};

}  // namespace spindrift::net
