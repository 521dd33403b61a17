#include "message_stream.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/container/static_vector.hpp>

#include "websocket_frames.h"

namespace spindrift::net {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;

/// FIN and the opcode, payload length 2, code 1002.
constexpr std::array<std::uint8_t, 4> kProtocolErrorClose{0x88, 0x02, 0x03, 0xea};
/// Up to this size one copy more costs less than the kernel's walk through headers and messages.
constexpr std::size_t kCopiedMaxBytes = 16 * 1024;

core::ByteView bytesOf(const asio::const_buffer& buffer) {
  return {static_cast<const std::uint8_t*>(buffer.data()), buffer.size()};
}

/// Messages as frames: a header and the message itself in turn.
struct Framed {
  Framed(std::span<const core::SharedBytes> messages, bool are_text) {
    for (const core::SharedBytes& message : messages) {
      headers.push_back(frameHeader(message->size(), are_text));
      parts.emplace_back(headers.back().data(), headers.back().size());
      parts.emplace_back(message->data(), message->size());
    }
  }

  boost::container::static_vector<FrameHeader, MessageStream::kMessageMaxCount> headers;
  boost::container::static_vector<asio::const_buffer, 2 * MessageStream::kMessageMaxCount> parts;
};

}  // namespace

struct MessageStream::Shared : std::enable_shared_from_this<Shared> {
  /// Who may write. Beast keeps its turn while a frame of its has begun, and after its close frame.
  enum class Turn { kFree, kMessages, kBeast };

  explicit Shared(const Transport& stream)
      : below(stream), turn_ends(below.get_executor(), asio::steady_timer::time_point::max()) {}

  void endTurn(Turn next) {
    turn = next;
    turn_ends.cancel();
  }

  void writeFrames(const Parts& parts, Handler handler) {
    beast_waits = turn == Turn::kMessages;
    if (beast_waits) {
      return turn_ends.async_wait([kept = shared_from_this(), parts, handler = std::move(handler)](
                                      const error_code&) mutable { kept->writeFrames(parts, std::move(handler)); });
    }
    turn = Turn::kBeast;
    const bool replaces = replaces_close && sent.isBetweenFrames();
    auto end = [kept = shared_from_this(), parts, replaces, handler = std::move(handler)](const error_code& error,
                                                                                          std::size_t written_bytes) {
      if (replaces) written_bytes = error ? 0 : asio::buffer_size(parts);
      kept->endWrite(parts, replaces ? 0 : written_bytes, error);
      handler(error, written_bytes);
    };
    if (!replaces) return below.write({parts.data(), parts.size()}, std::move(end));
    if (sent.hasClose()) return asio::post(below.get_executor(), [end = std::move(end)] { end({}, 0); });
    sent.scan(kProtocolErrorClose);
    asio::async_write(below, asio::buffer(kProtocolErrorClose), std::move(end));
  }

  /// Takes note of the first `frame_bytes` of the parts, which were written as Beast's.
  void endWrite(const Parts& parts, std::size_t frame_bytes, const error_code& error) {
    for (const asio::const_buffer& part : parts) {
      const asio::const_buffer written = asio::buffer(part, frame_bytes);
      if (has_frames) sent.scan(bytesOf(written));
      frame_bytes -= written.size();
    }
    if (error || (sent.isBetweenFrames() && !sent.hasClose())) endTurn(Turn::kFree);
  }

  Transport below;
  bool has_frames = false;  ///< false: HTTP, before the end of the handshake
  FrameScanner received;
  FrameScanner sent;  ///< by Beast
  Turn turn = Turn::kFree;
  bool beast_waits = false;      ///< for its turn
  asio::steady_timer turn_ends;  ///< never expires; cancelled when a turn ends
  std::function<bool(std::uint64_t)> on_fragments;
  bool is_reading_stopped = false;
  bool replaces_close = false;
};

MessageStream::MessageStream(Transport&& stream)
    : Transport(std::move(stream)), shared_(std::make_shared<Shared>(*this)) {}

void MessageStream::beginFrames(std::function<bool(std::uint64_t)> on_fragments) {
  shared_->has_frames = true;
  error_code ignored;
  socket().non_blocking(true, ignored);  // for beginMessages()
  shared_->on_fragments = std::move(on_fragments);
}

BegunWrite MessageStream::beginMessages(std::span<const core::SharedBytes> messages) {
  BegunWrite out;
  if (isTls() || shared_->turn != Shared::Turn::kFree) return out;
  const Framed framed(messages, false);
  const std::size_t size_bytes = asio::buffer_size(framed.parts);
  if (size_bytes <= kCopiedMaxBytes) {
    std::array<std::uint8_t, kCopiedMaxBytes> copy;
    asio::buffer_copy(asio::buffer(copy), framed.parts);
    out.bytes_count = socket().write_some(asio::buffer(copy, size_bytes), out.error);
  } else {
    out.bytes_count = socket().write_some(framed.parts, out.error);
  }
  if (out.error == asio::error::would_block) out.error.clear();
  out.is_all = out.bytes_count == size_bytes;
  if (out.bytes_count > 0 && !out.is_all) shared_->turn = Shared::Turn::kMessages;
  return out;
}

asio::awaitable<error_code> MessageStream::writeMessages(std::span<const core::SharedBytes> messages, bool are_text,
                                                         BegunWrite begun) {
  using Turn = Shared::Turn;
  if (begun.error) co_return begun.error;
  const std::shared_ptr<Shared> shared = shared_;
  if (begun.bytes_count == 0) {
    while (shared->turn != Turn::kFree) (void)co_await shared->turn_ends.async_wait(kToken);
  }
  shared->turn = Turn::kMessages;
  Framed framed(messages, are_text);
  for (asio::const_buffer& part : framed.parts) {
    const std::size_t written_bytes = std::min(begun.bytes_count, part.size());
    part += written_bytes;
    begun.bytes_count -= written_bytes;
  }
  const auto unlimited = [](const error_code& failed, std::size_t) {
    return failed ? std::size_t{0} : std::numeric_limits<std::size_t>::max();
  };
  const auto [error, bytes_count] =
      co_await asio::async_write(shared->below, std::span<const asio::const_buffer>(framed.parts), unlimited, kToken);
  shared->endTurn(shared->beast_waits ? Turn::kBeast : Turn::kFree);
  co_return error;
}

void MessageStream::closeAsProtocolError() {
  shared_->replaces_close = true;
}

void MessageStream::close() {
  Transport::close();
  shared_->endTurn(Shared::Turn::kFree);
}

void MessageStream::read(asio::mutable_buffer into, Handler handler) {
  auto end = [kept = shared_, into, handler = std::move(handler)](error_code error, std::size_t bytes_count) {
    if (!error && kept->is_reading_stopped) error = asio::error::connection_aborted;
    if (!error && kept->has_frames) {
      kept->received.scan(bytesOf(asio::buffer(into, bytes_count)));
      const std::uint64_t fragment_count = kept->received.takeFragmentCount();
      kept->is_reading_stopped = fragment_count > 0 && !kept->on_fragments(fragment_count);
    }
    handler(error, bytes_count);
  };
  if (!shared_->is_reading_stopped) return shared_->below.read(into, std::move(end));
  shared_->below.socket().async_wait(asio::socket_base::wait_error,
                                     [end = std::move(end)](const error_code& error) { end(error, 0); });
}

void MessageStream::write(std::span<const asio::const_buffer> parts, Handler handler) {
  shared_->writeFrames(Parts(parts.begin(), parts.end()), std::move(handler));
}

}  // namespace spindrift::net
