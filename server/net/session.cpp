// In one file although it has more than 400 lines: reader and writer share the deadlines and the end of the session.
#include "session.h"

#include <algorithm>
#include <exception>
#include <iterator>
#include <utility>

#include <boost/asio/dispatch.hpp>
#include <boost/asio/experimental/awaitable_operators.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/websocket.hpp>
#include <spdlog/spdlog.h>

#include <spindrift/core/text.h>

namespace spindrift::net {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;

/// This many fragments count as one message. A message sent in single bytes takes fewer tokens than a burst has, and a
/// stream of empty fragments is limited like one of messages.
constexpr std::uint64_t kFragmentsPerMessage = 64;
/// RFC 6455 section 7.4: 3000 to 4999 are for libraries and applications, larger codes are undefined.
constexpr std::uint16_t kCloseCodeMax = 4999;
constexpr std::uint16_t kProtocolError = 1002;

/// Messages are written together up to this size, so that a new answer or frame does not wait for long behind them.
constexpr std::size_t kGatheredMaxBytes = 32 * 1024;
/// After so many writes in a row other work of the thread comes before the next one.
constexpr std::size_t kWritesAtOnce = 16;

/// 1011: a failure of the server, not of the peer.
constexpr const char* kInternalReason = "the server failed on this session; its log says why";

constexpr const char* kTooManyMessages = "too many messages for too long: keep to Greeting.limits.messages_per_s";

/// RFC 6455 section 5.5: the payload of a control frame is at most 125 bytes, of which two are the code.
constexpr std::size_t kCloseReasonMaxBytes = 123;

/// RFC 6455 section 5.5.1: the reason is valid UTF-8. A longer one is cut between two characters.
websocket::close_reason closeFrame(const SessionEnd& end) {
  websocket::close_reason frame(static_cast<websocket::close_code>(end.code));
  const std::string text = core::cleanText(end.reason, kCloseReasonMaxBytes);
  frame.reason.assign(text.data(), text.size());
  return frame;
}

}  // namespace

Session::Session(Transport stream, ServerContext& context)
    : context_(context),
      id_(++context.last_session_id),
      outbox_(context.options.answer_max_count),
      ws_(std::move(stream)),
      strand_(ws_.get_executor()),
      message_tokens_(context.options.messages_per_s, context.options.message_burst_count, Clock::now()),
      wake_timer_(strand_),
      answers_timer_(strand_),
      stall_timer_(strand_),
      close_timer_(strand_),
      end_timer_(strand_),
      end_of_delay_(strand_) {}

asio::awaitable<void> Session::run(const Request& request, SessionOpening opening, std::string address) {
  using asio::experimental::awaitable_operators::operator&&;
  address_ = std::move(address);
  configure(opening.subprotocol);
  const auto [accept_error] = co_await ws_.async_accept(request, kToken);
  if (accept_error) {
    spdlog::debug("{}: the WebSocket handshake failed: {}", opening.peer, accept_error.message());
    co_return;
  }
  ws_.next_layer().beginFrames([this](std::uint64_t fragment_count) { return takeFragments(fragment_count); });
  // From here on Beast's "handshake" timeout is the one for closing.
  ws_.set_option(websocket::stream_base::timeout{context_.options.close_timeout, context_.options.idle_timeout, true});

  context_.counters.add(&ServerStats::accepted_session_count);
  context_.counters.add(&ServerStats::open_session_count);
  spdlog::debug("session {} opened by {}", id_, opening.peer);
  context_.hub.add(id_, shared_from_this());
  callApplication("sessionOpened", [&] {
    translator_ = context_.application.translatorFor(opening);
    context_.application.sessionOpened(id_, opening);
    if (translator_) take(translator_->open());
  });

  co_await (readLoop() && writeLoop());

  context_.hub.remove(id_);
  wake_timer_.cancel();
  stall_timer_.cancel();
  close_timer_.cancel();
  end_timer_.cancel();
  end_of_delay_.cancel();
  context_.counters.add(&ServerStats::open_session_count, -1);
  const SessionEnd end = end_.value_or(SessionEnd{});
  context_.counters.closed(end.code);
  spdlog::debug("session {} closed: {} {}", id_, end.code, end.reason);
  callApplication("sessionClosed", [&] { context_.application.sessionClosed(id_, end); });
}

void Session::configure(const std::string& subprotocol) {
  beast::get_lowest_layer(ws_).expires_never();  // the WebSocket layer has its own timeouts
  const auto& options = context_.options;
  ws_.set_option(websocket::stream_base::timeout{options.handshake_timeout, options.idle_timeout, true});
  ws_.set_option(websocket::stream_base::decorator([subprotocol](websocket::response_type& response) {
    response.set(beast::http::field::server, "Spindrift");
    for (const auto& [name, value] : securityHeaders()) response.set(name, value);
    if (!subprotocol.empty()) response.set(beast::http::field::sec_websocket_protocol, subprotocol);
  }));
  ws_.read_message_max(options.read_message_max_bytes);
  // Each ping costs a pong, so pings count as messages. A peer that sends a close frame gets a deadline to disconnect.
  ws_.control_callback([this](websocket::frame_type kind, beast::string_view) {
    if (kind == websocket::frame_type::close) {
      if (ws_.reason().code > kCloseCodeMax) {
        noteEnd(kProtocolError, "close code " + std::to_string(ws_.reason().code) + " is above 4999");
        ws_.next_layer().closeAsProtocolError();
      }
      armCloseDeadline();
    } else if (!message_tokens_.take(Clock::now())) {
      close(CloseCode::kPolicy, kTooManyMessages);
    }
  });
}

bool Session::takeFragments(std::uint64_t count) {
  untaken_fragment_count_ += count;
  for (; untaken_fragment_count_ >= kFragmentsPerMessage; untaken_fragment_count_ -= kFragmentsPerMessage) {
    if (message_tokens_.take(Clock::now())) continue;
    close(CloseCode::kPolicy, "too many fragments: send messages in fewer pieces, or slow down");
    return false;
  }
  return true;
}

asio::awaitable<void> Session::readLoop() {
  while (true) {
    co_await waitUntilAnswersAreTaken();
    if (outbox_.closing()) co_return;  // the writer's sayGoodbye() reads the rest
    const auto [error, bytes_count] = co_await ws_.async_read(read_buffer_, kToken);
    if (error) {
      if (error == websocket::error::closed) {
        noteEnd(ws_.reason().code, core::cleanText(ws_.reason().reason.c_str(), kCloseReasonMaxBytes));
      } else if (error == websocket::error::message_too_big || error == websocket::error::buffer_overflow) {
        noteEnd(static_cast<std::uint16_t>(CloseCode::kTooBig), "a message over the limit");  // Beast has sent 1009
      } else if (error == beast::error::timeout) {
        context_.counters.add(&ServerStats::silent_session_count);
        noteEnd(0, "nothing came for " + std::to_string(context_.options.idle_timeout.count()) + " ms, pongs included");
      } else {
        noteEnd(0, error.message());
      }
      // The stream has failed or is closed: nothing more could be sent.
      cut();
      outbox_.shut();
      wakeWriter();
      co_return;
    }
    if (outbox_.closing()) co_return;
    if (ws_.got_text() && !translator_) {
      close(CloseCode::kUnsupportedData, "text messages are not understood: send binary ones");
      co_return;
    }
    if (!message_tokens_.take(Clock::now())) {
      close(CloseCode::kPolicy, kTooManyMessages);
      co_return;
    }
    // All clients of the address share its rate. A message that comes too early waits, and TCP slows down the sender.
    if (const auto delay = context_.addresses.reserveMessage(address_, Clock::now()); delay > Clock::duration{}) {
      context_.counters.add(&ServerStats::delayed_message_count);
      end_of_delay_.expires_after(delay);
      (void)co_await end_of_delay_.async_wait(kToken);
      if (outbox_.closing()) co_return;
    }
    const core::ByteView message(static_cast<const std::uint8_t*>(read_buffer_.data().data()), bytes_count);
    receive(message, ws_.got_text());
    read_buffer_.consume(read_buffer_.size());
  }
}

void Session::receive(core::ByteView message, bool is_text) {
  callApplication("sessionMessage", [&] {
    if (!translator_) return context_.application.sessionMessage(id_, message);
    take(translator_->receive(message, is_text));
  });
}

void Session::take(core::Translator::Incoming incoming) {
  for (core::SharedBytes& answer : incoming.answers) sendAnswer(std::move(answer));
  for (const core::Bytes& message : incoming.messages) context_.application.sessionMessage(id_, message);
}

asio::awaitable<void> Session::waitUntilAnswersAreTaken() {
  while (!outbox_.closing() && outbox_.waiting().answer_count >= context_.options.answer_pause_count) {
    // The writer cancels it after each message; both run on the strand.
    is_reader_paused_ = true;
    answers_timer_.expires_at(Clock::time_point::max());
    (void)co_await answers_timer_.async_wait(kToken);
    is_reader_paused_ = false;
  }
}

asio::awaitable<void> Session::writeLoop() {
  while (true) {
    // Not in the condition of the switch: GCC 12 then lays out the frame of the coroutine in two ways.
    const Outbox::Kind left = sendAtOnce();
    switch (left) {
      case Outbox::Kind::kShut:
        co_return;
      case Outbox::Kind::kClose:
        answers_timer_.cancel();
        co_await sayGoodbye();
        co_return;
      case Outbox::Kind::kIdle:
        // A wake-up runs on this strand, so it cannot come between sendAtOnce() and the wait.
        is_writer_idle_ = true;
        wake_timer_.expires_at(Clock::time_point::max());
        (void)co_await wake_timer_.async_wait(kToken);
        is_writer_idle_ = false;
        break;
      case Outbox::Kind::kControl:
      case Outbox::Kind::kFrame:
        if (!co_await writeGathered()) {
          cut();
          outbox_.shut();
          answers_timer_.cancel();
          co_return;
        }
        afterWrite();
        break;
    }
  }
}

Outbox::Kind Session::sendAtOnce() {
  for (std::size_t count = 0; gathered_.messages.empty(); ++count) {
    Outbox::Next next = outbox_.next();
    if (!next.message) return next.kind;
    gather(std::move(next));
    if (translator_ || count == kWritesAtOnce) break;
    gathered_.begun = ws_.next_layer().beginMessages(gathered_.messages);
    if (!gathered_.begun.is_all) break;
    context_.counters.wrote(gathered_.bytes_count, gathered_.frame_count, true);
    gathered_ = {};
    afterWrite();
  }
  return Outbox::Kind::kFrame;
}

void Session::wake() {
  // The writer sleeps on unless something is left for it, so that most frames cost it nothing.
  if (is_writer_idle_ && sendAtOnce() != Outbox::Kind::kIdle) wake_timer_.cancel();
}

void Session::gather(Outbox::Next first) {
  gathered_ = {};
  const auto take = [this](Outbox::Next&& next) {
    gathered_.bytes_count += next.message->size();
    gathered_.frame_count += next.kind == Outbox::Kind::kFrame ? 1 : 0;
    gathered_.messages.push_back(std::move(next.message));
  };
  take(std::move(first));
  while (gathered_.messages.size() < MessageStream::kMessageMaxCount && gathered_.bytes_count < kGatheredMaxBytes) {
    auto next = outbox_.nextAlong(kGatheredMaxBytes - gathered_.bytes_count);
    if (!next) return;
    take(*std::move(next));
  }
}

asio::awaitable<bool> Session::writeGathered() {
  const Gathered gathered = std::exchange(gathered_, {});  // holds no frames while the session waits
  if (!translator_) co_return co_await write(gathered.messages, false, gathered.frame_count, gathered.begun);
  const bool is_written = co_await writeTranslated(gathered.messages);
  if (is_written) context_.counters.add(&ServerStats::sent_frame_count, gathered.frame_count);
  co_return is_written;
}

asio::awaitable<bool> Session::writeTranslated(std::span<const core::SharedBytes> messages) {
  std::vector<core::Translator::Outgoing> out;
  for (const core::SharedBytes& message : messages)
    callApplication("translation", [&] { std::ranges::move(translator_->send(*message), std::back_inserter(out)); });
  std::vector<core::SharedBytes> run;  // of messages of one kind
  for (std::size_t i = 0; i < out.size(); ++i) {
    run.push_back(std::move(out[i].bytes));
    const bool is_last = i + 1 == out.size() || out[i + 1].is_text != out[i].is_text;
    if (!is_last && run.size() < MessageStream::kMessageMaxCount) continue;
    const bool is_written = co_await write(run, out[i].is_text, 0, {});
    if (!is_written) co_return false;
    run.clear();
  }
  co_return true;
}

asio::awaitable<bool> Session::write(std::span<const core::SharedBytes> messages, bool are_text,
                                     std::size_t frame_count, BegunWrite begun) {
  write_deadline_ = Clock::now() + context_.options.write_stall_timeout;
  if (!watches_writes_) watchWrites();
  const boost::system::error_code error = co_await ws_.next_layer().writeMessages(messages, are_text, begun);
  write_deadline_.reset();
  if (error) {
    noteEnd(0, error.message());
    co_return false;
  }
  std::uint64_t bytes_count = 0;
  for (const core::SharedBytes& message : messages) bytes_count += message->size();
  context_.counters.wrote(bytes_count, frame_count, false);
  co_return true;
}

void Session::watchWrites() {
  watches_writes_ = true;
  stall_timer_.expires_at(*write_deadline_);
  stall_timer_.async_wait([self = shared_from_this()](const boost::system::error_code& error) {
    self->watches_writes_ = false;
    if (error || !self->write_deadline_) return;
    if (*self->write_deadline_ > Clock::now()) return self->watchWrites();
    self->context_.counters.add(&ServerStats::evicted_session_count);
    self->noteEnd(0, "evicted: a write took longer than " +
                         std::to_string(self->context_.options.write_stall_timeout.count()) + " ms");
    self->cut();
  });
}

void Session::afterWrite() {
  if (is_reader_paused_) answers_timer_.cancel();
  const auto level = outbox_.reviewLevel(Clock::now());
  if (!level) return;
  const core::Level before = std::exchange(level_, *level);
  context_.counters.add(*level < before ? &ServerStats::lowered_level_count : &ServerStats::raised_level_count);
  callApplication("sessionLevelChanged", [&] { context_.application.sessionLevelChanged(id_, *level); });
}

asio::awaitable<void> Session::sayGoodbye() {
  const SessionEnd end = outbox_.closeRequest().value_or(SessionEnd{});
  noteEnd(end.code, end.reason);
  const auto [error] = co_await ws_.async_close(closeFrame(end), kToken);
  if (error) spdlog::debug("session {}: the close frame could not be sent: {}", id_, error.message());
  cut();
}

void Session::sendAnswer(core::SharedBytes message) {
  const Outbox::Outcome outcome = outbox_.pushAnswer(std::move(message));
  if (outcome.overflow) {
    context_.counters.add(&ServerStats::evicted_session_count);
    asio::post(strand_, [self = shared_from_this()] { self->armCloseDeadline(); });
  }
  if (outcome.wake) wakeWriter();
}

void Session::sendState(const StateTopic& topic, core::SharedBytes message) {
  if (outbox_.pushState(topic, std::move(message)).wake) wakeWriter();
}

void Session::offerFrame(StreamIndex stream, const FrameBytes& frame, Wake wake) {
  const Outbox::Outcome outcome = outbox_.offerFrame(stream, frame, Clock::now());
  if (outcome.dropped) context_.counters.add(&ServerStats::dropped_frame_count);
  if (wake == Wake::kNow && takesFrames()) wakeWriter();
}

void Session::writeNow() {
  asio::dispatch(strand_, [self = shared_from_this()] { self->wake(); });
}

void Session::offerNewest(StreamIndex stream, const FrameBytes& frame) {
  if (outbox_.offerNewest(stream, frame).wake) wakeWriter();
}

void Session::close(CloseCode code, std::string reason) {
  if (!outbox_.requestClose(code, std::move(reason))) return;
  asio::post(strand_, [self = shared_from_this()] { self->armCloseDeadline(); });
  wakeWriter();
}

void Session::closeAt(Clock::time_point when, CloseCode code, std::string reason) {
  asio::post(strand_, [self = shared_from_this(), when, code, reason = std::move(reason)]() mutable {
    if (self->end_) return;  // already over; the timer would keep the session alive
    self->end_timer_.expires_at(when);
    if (when == Clock::time_point::max()) return;
    self->end_timer_.async_wait(
        [self, code, reason = std::move(reason)](const boost::system::error_code& error) mutable {
          if (!error) self->close(code, std::move(reason));
        });
  });
}

void Session::cut() {
  end_of_delay_.cancel();
  ws_.next_layer().close();
}

template <typename Callback>
void Session::callApplication(const char* name, Callback&& callback) {
  try {
    callback();
  } catch (const std::exception& error) {
    spdlog::error("session {}: {} failed: {}", id_, name, error.what());
    close(CloseCode::kInternalError, kInternalReason);
  }
}

void Session::armCloseDeadline() {
  if (close_timer_.expiry() != Clock::time_point{}) return;
  close_timer_.expires_after(context_.options.close_timeout);
  close_timer_.async_wait([self = shared_from_this()](const boost::system::error_code& error) {
    if (error) return;
    if (const auto asked = self->outbox_.closeRequest()) self->noteEnd(asked->code, asked->reason);
    self->cut();
  });
}

void Session::wakeWriter() {
  asio::post(strand_, [self = shared_from_this()] { self->wake(); });
}

void Session::noteEnd(std::uint16_t code, std::string reason) {
  if (!end_) end_ = SessionEnd{code, std::move(reason)};
}

}  // namespace spindrift::net
