// The TCP stream below a session's WebSocket, with three differences: what is left of the message being written goes to
// the kernel in one call; fragments are counted as they come in; and the answer to a close frame can be replaced.
//
// Writing. Asio's composed write hands on at most 64 KiB a call, and each call is a turn of the event loop. Beast
// writes through it with no say in that number. So this stream, which is told where the message lies, takes the rest
// along when it is offered a part of it. It then reports more bytes than it was offered; the composed write counts them
// off the whole sequence, which is the same message. That is no promise of Asio's but what Boost 1.81 does, the version
// that the build asks for. With any other version the stream writes what it is offered: right, and slower.
//
// Reading. Beast joins fragments without a word to its caller, who therefore cannot bound how many come. This stream
// counts them below Beast and stops reading when its owner says so.
//
// Closing. Beast echoes whatever code from 3000 to 65535 a peer closes with, but RFC 6455 section 7.4 ends at 4999.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <iterator>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/compose.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/websocket/teardown.hpp>
#include <boost/version.hpp>

#include <spindrift/core/bytes.h>

#include "fragment_counter.h"

namespace spindrift::net {

/// Whether the composed write is known to count bytes beyond those that it offered. Session and outflow tests hold it.
inline constexpr bool kWriteTakesRestAlong = BOOST_VERSION == 108100;

/// Used on one strand, as its base class is.
class MessageStream : public boost::beast::tcp_stream {
 public:
  explicit MessageStream(boost::beast::tcp_stream&& stream) : boost::beast::tcp_stream(std::move(stream)) {}

  /// Where the message lies that is written next, until another one does; it stays there until its write is over.
  /// Empty: none.
  void setMessage(core::ByteView message) { message_ = message; }

  /// Called with how many fragments a read has brought, where there are any; false stops reading: from then on a read
  /// only ends when the connection does. Before the first read.
  void setFragmentHandler(std::function<bool(std::uint64_t)> handler) { on_fragments_ = std::move(handler); }

  /// The next close frame says 1002 (protocol error) and no more, whatever it was going to say.
  void closeAsProtocolError() { close_is_replaced_ = true; }

  template <typename Buffers, typename Handler>
  auto async_read_some(const Buffers& buffers, Handler&& handler) {
    namespace asio = boost::asio;
    return asio::async_compose<Handler, void(boost::system::error_code, std::size_t)>(
        [this, buffers, began = false](auto& self, boost::system::error_code error = {},
                                       std::size_t bytes_count = 0) mutable {
          if (!std::exchange(began, true)) {
            if (!is_reading_stopped_) return boost::beast::tcp_stream::async_read_some(buffers, std::move(self));
            return socket().async_wait(asio::socket_base::wait_error, std::move(self));
          }
          if (!error && is_reading_stopped_) error = asio::error::connection_aborted;
          if (!error) is_reading_stopped_ = !mayGoOn(buffers, bytes_count);
          self.complete(error, bytes_count);
        },
        handler, *this);
  }

  template <typename Buffers, typename Handler>
  auto async_write_some(const Buffers& buffers, Handler&& handler) {
    namespace asio = boost::asio;
    std::array<asio::const_buffer, 2> parts;  // a frame's header and its payload, or the payload alone
    std::size_t count = 0;
    for (auto at = asio::buffer_sequence_begin(buffers); at != asio::buffer_sequence_end(buffers); ++at) {
      const asio::const_buffer part = *at;
      if (part.size() == 0) continue;
      if (count < parts.size()) parts[count] = part;
      ++count;
    }
    if (count == 1 && isReplacedClose(parts[0])) {
      const auto rest = asio::buffer(kProtocolErrorClose) + (kProtocolErrorClose.size() - parts[0].size());
      return boost::beast::tcp_stream::async_write_some(rest, std::forward<Handler>(handler));
    }
    if (!kWriteTakesRestAlong || count == 0 || count > parts.size() || !isOfMessage(parts[count - 1]))
      return boost::beast::tcp_stream::async_write_some(buffers, std::forward<Handler>(handler));
    const auto* first = static_cast<const std::uint8_t*>(parts[count - 1].data());
    parts[count - 1] = asio::const_buffer(first, static_cast<std::size_t>(message_.data() + message_.size() - first));
    return boost::beast::tcp_stream::async_write_some(parts, std::forward<Handler>(handler));
  }

 private:
  [[nodiscard]] bool isOfMessage(const boost::asio::const_buffer& part) const {
    const auto* first = static_cast<const std::uint8_t*>(part.data());
    const std::less<> before;
    return !before(first, message_.data()) && before(first, message_.data() + message_.size());
  }

  /// Fewer bytes than the whole frame are the rest of one that was written in part.
  bool isReplacedClose(const boost::asio::const_buffer& part) {
    const auto* bytes = static_cast<const std::uint8_t*>(part.data());
    if (!close_is_replaced_ || part.size() > kProtocolErrorClose.size()) return false;
    if (part.size() == kProtocolErrorClose.size())
      replaced_close_began_ = bytes[0] == kProtocolErrorClose[0] && bytes[1] == kProtocolErrorClose[1];
    return replaced_close_began_;
  }
  template <typename Buffers>
  bool mayGoOn(const Buffers& buffers, std::size_t bytes_count) {
    namespace asio = boost::asio;
    std::uint64_t fragment_count = 0;
    for (auto at = asio::buffer_sequence_begin(buffers); at != asio::buffer_sequence_end(buffers); ++at) {
      const asio::const_buffer part = *at;
      const std::size_t read = std::min(part.size(), bytes_count);
      fragment_count += fragments_.count({static_cast<const std::uint8_t*>(part.data()), read});
      bytes_count -= read;
    }
    return fragment_count == 0 || !on_fragments_ || on_fragments_(fragment_count);
  }

  /// FIN and the opcode, two bytes of payload, 1002.
  static constexpr std::array<std::uint8_t, 4> kProtocolErrorClose{0x88, 0x02, 0x03, 0xea};

  core::ByteView message_;
  FragmentCounter fragments_;
  std::function<bool(std::uint64_t)> on_fragments_;
  bool is_reading_stopped_ = false;
  bool close_is_replaced_ = false;
  bool replaced_close_began_ = false;
};

/// What Beast closes a connection with; found by the type of the stream.
template <typename Handler>
void async_teardown(boost::beast::role_type role, MessageStream& stream, Handler&& handler) {
  boost::beast::websocket::async_teardown(role, stream.socket(), std::forward<Handler>(handler));
}
inline void teardown(boost::beast::role_type role, MessageStream& stream, boost::system::error_code& error) {
  boost::beast::websocket::teardown(role, stream.socket(), error);
}

}  // namespace spindrift::net
