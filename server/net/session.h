// One WebSocket session, from the upgrade to the last byte. All functions except those of SessionLink run on the
// session's strand; a reader and a writer coroutine share it.
#pragma once

#include <memory>
#include <string>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <boost/container/small_vector.hpp>

#include <spindrift/http/request.h>

#include "message_stream.h"
#include "outbox.h"
#include "rate_limit.h"
#include "server_context.h"
#include "session_link.h"

namespace spindrift::net {

class Session final : public SessionLink, public std::enable_shared_from_this<Session> {
 public:
  /// Takes over the stream; its executor is the session's strand.
  Session(Transport stream, ServerContext& context);

  /// Answers the upgrade, serves until the connection is gone, then returns. Calls sessionOpened first and
  /// sessionClosed last; neither if the handshake fails. Call it on the strand.
  boost::asio::awaitable<void> run(const Request& request, SessionOpening opening, std::string address);

  void sendAnswer(core::SharedBytes message) override;
  void sendState(const StateTopic& topic, core::SharedBytes message) override;
  void offerFrame(StreamIndex stream, const FrameBytes& frame, Wake wake) override;
  bool takesFrames() override { return outbox_.wakeForFrames(); }
  void writeNow() override;
  void offerNewest(StreamIndex stream, const FrameBytes& frame) override;
  void setWatch(StreamIndex stream, const std::optional<Watch>& watch) override { outbox_.setWatch(stream, watch); }
  void enterRoom(std::shared_ptr<core::DemandTable> demand) override { outbox_.enterRoom(std::move(demand)); }
  Waiting waiting() const override { return outbox_.waiting(); }
  void close(CloseCode code, std::string reason) override;
  void closeAt(std::chrono::steady_clock::time_point when, CloseCode code, std::string reason) override;

  /// Closes the socket now; every pending operation ends. Call it on the strand.
  void cut();

 private:
  /// Messages that are written together.
  struct Gathered {
    boost::container::small_vector<core::SharedBytes, 8> messages;
    std::size_t bytes_count = 0;
    std::size_t frame_count = 0;
    BegunWrite begun{};
  };

  void configure(const std::string& subprotocol);
  /// Takes message tokens for fragments; false if there are too few, and the session closes.
  bool takeFragments(std::uint64_t count);
  boost::asio::awaitable<void> readLoop();
  boost::asio::awaitable<void> writeLoop();
  /// Sends what waits, as far as the kernel takes it at once. Returns what is left to the writer; kFrame: messages that
  /// were gathered, and wait for the kernel, Beast or TLS, for their translation, or for other work of the thread.
  Outbox::Kind sendAtOnce();
  /// Does the same for a writer that sleeps, and wakes it only if something is left.
  void wake();
  /// Hands a message of the client to the application.
  void receive(core::ByteView message, bool is_text);
  /// Hands over what a translator made of one.
  void take(core::Translator::Incoming incoming);
  /// Returns once fewer than answer_pause_count answers wait, or the connection is gone. Meanwhile the session reads
  /// nothing: a client that does not read its answers is slowed down by TCP.
  boost::asio::awaitable<void> waitUntilAnswersAreTaken();
  /// Takes the first message and those from the outbox that can be written with it.
  void gather(Outbox::Next first);
  /// Writes the gathered messages, translated if the session has a translator; returns false if the connection is gone,
  /// as the next two.
  boost::asio::awaitable<bool> writeGathered();
  boost::asio::awaitable<bool> writeTranslated(std::span<const core::SharedBytes> messages);
  /// Writes messages of one kind, from where `begun` ends.
  boost::asio::awaitable<bool> write(std::span<const core::SharedBytes> messages, bool are_text,
                                     std::size_t frame_count, BegunWrite begun);
  /// Called after each write: lets the reader see whether answers still wait, and evaluates whether the link can carry
  /// its level.
  void afterWrite();
  /// Closes the socket when a write passes its deadline. One timer runs across writes and is not set again for each.
  void watchWrites();
  /// Sends the close frame and waits for the peer's until the close deadline.
  boost::asio::awaitable<void> sayGoodbye();
  /// Runs an application callback; an exception in it ends this session and no other.
  template <typename Callback>
  void callApplication(const char* name, Callback&& callback);
  /// Closes the socket at the deadline if it is still open. On the strand, once.
  void armCloseDeadline();
  void wakeWriter();
  /// Stores the reason of the session's end; only the first one counts.
  void noteEnd(std::uint16_t code, std::string reason);

  ServerContext& context_;
  const SessionId id_;
  // First what is looked at for each frame.
  bool is_writer_idle_ = false;                   ///< it waits on wake_timer_
  bool is_reader_paused_ = false;                 ///< it waits on answers_timer_
  std::unique_ptr<core::Translator> translator_;  ///< null: the client speaks the application's protocol
  Outbox outbox_;
  boost::beast::websocket::stream<MessageStream, false> ws_;  ///< without permessage-deflate
  const boost::asio::any_io_executor strand_;
  Gathered gathered_;
  core::Level level_ = core::Level::kFull;  ///< of the newest review
  TokenBucket message_tokens_;
  std::uint64_t untaken_fragment_count_ = 0;  ///< fragments for which no token was taken yet
  boost::beast::flat_buffer read_buffer_;
  boost::asio::steady_timer wake_timer_;     ///< the writer waits on it
  boost::asio::steady_timer answers_timer_;  ///< the reader waits on it; see waitUntilAnswersAreTaken()
  boost::asio::steady_timer stall_timer_;    ///< checks for a write that takes too long; see watchWrites()
  boost::asio::steady_timer close_timer_;
  boost::asio::steady_timer end_timer_;                                  ///< for closeAt()
  boost::asio::steady_timer end_of_delay_;                               ///< see AddressLimits::reserveMessage()
  std::optional<std::chrono::steady_clock::time_point> write_deadline_;  ///< set while a write is in flight
  bool watches_writes_ = false;
  std::string address_;  ///< key of the peer in AddressLimits
  std::optional<SessionEnd> end_;
};

}  // namespace spindrift::net
