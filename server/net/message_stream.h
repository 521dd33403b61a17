// The TCP stream below a session's WebSocket, with one difference: what is left of the message being written goes to
// the kernel in one call.
//
// Asio's composed write hands on at most 64 KiB a call, and each call is a turn of the event loop. Beast writes through
// it with no say in that number. So this stream, which is told where the message lies, takes the rest along when it is
// offered a part of it. It then reports more bytes than it was offered; the composed write counts them off the whole
// sequence, which is the same message. That is no promise of Asio's but what version 1.81 does, the one that the build
// asks for; session and outflow tests would see it change.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <iterator>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/websocket/teardown.hpp>
#include <boost/version.hpp>

#include <spindrift/core/bytes.h>

namespace spindrift::net {

static_assert(BOOST_VERSION == 108100, "look whether the composed write still counts bytes beyond those it offered");

/// Of one strand, as its base.
class MessageStream : public boost::beast::tcp_stream {
 public:
  explicit MessageStream(boost::beast::tcp_stream&& stream) : boost::beast::tcp_stream(std::move(stream)) {}

  /// Where the message lies that is written next, until another one does; it stays there until its write is over.
  /// Empty: none.
  void setMessage(core::ByteView message) { message_ = message; }

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
    if (count == 0 || count > parts.size() || !isOfMessage(parts[count - 1]))
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

  core::ByteView message_;
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
