// The stream below a session's WebSocket. It differs from its base class in four points: the rest of a message is
// written in one kernel call, further messages are written along with it, incoming fragments are counted, and the reply
// to a close frame can be replaced.
//
// Writing. Asio's composed write passes at most 64 KiB per call, and each call costs a turn of the event loop. Beast
// uses it and cannot change that number. This stream is told where the message lies. When it is offered a part of the
// message, it writes all the rest of it too, and reports more bytes than it was offered. The composed write subtracts
// them from the whole sequence, which is the same message. Asio does not promise this, but Boost 1.81 behaves so, the
// version that the build requires. With any other version the stream writes only what it is offered: correct, but
// slower.
//
// Writing along. A kernel call per message is most of what a session costs, and the layers of one moment of the water
// are several messages. When Beast writes the end of the message that this stream was told, the stream appends further
// messages, each with a frame header of its own (RFC 6455 section 5.2). Beast learns that its message is written when
// all of them are, so nothing of its own, such as a pong, can come between their bytes.
//
// Reading. Beast joins fragments without reporting them, so its caller cannot bound their number. This stream counts
// them below Beast and stops reading when its owner asks for it.
//
// Closing. Beast echoes any close code from 3000 to 65535, but RFC 6455 section 7.4 ends at 4999.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <boost/asio/buffer.hpp>
#include <boost/asio/compose.hpp>
#include <boost/asio/write.hpp>
#include <boost/version.hpp>

#include <spindrift/core/bytes.h>

#include "fragment_counter.h"
#include "frame_header.h"
#include "transport.h"

namespace spindrift::net {

/// Whether the composed write is known to count bytes beyond those it offered. The session and outflow tests check it.
inline constexpr bool kWriteTakesRestAlong = BOOST_VERSION == 108100;

/// Used on one strand, as its base class is.
class MessageStream : public Transport {
 public:
  explicit MessageStream(Transport&& stream) : Transport(std::move(stream)) {}

  /// Most messages that are written along with one.
  static constexpr std::size_t kAlongMaxCount = 15;

  /// Sets the message that is written next, and at most kAlongMaxCount messages that are written along with it, in this
  /// order. All bytes must stay valid until the write is done.
  void setMessage(core::ByteView message, std::span<const core::SharedBytes> along) {
    message_ = message;
    along_.clear();
    for (const core::SharedBytes& one : along) along_.push_back({FrameHeader(one->size()), *one});
  }
  /// After the write: no message is written next.
  void clearMessage() { setMessage({}, {}); }

  /// Sets a handler that is called with the number of fragments in a read, if not 0. If it returns false, reading
  /// stops: later reads end only when the connection does. Call it before the first read.
  void setFragmentHandler(std::function<bool(std::uint64_t)> handler) { on_fragments_ = std::move(handler); }

  /// Replaces the next close frame by one with code 1002 (protocol error) and no reason.
  void closeAsProtocolError() { close_is_replaced_ = true; }

  template <typename Buffers, typename Handler>
  auto async_read_some(const Buffers& buffers, Handler&& handler) {
    namespace asio = boost::asio;
    return asio::async_compose<Handler, void(boost::system::error_code, std::size_t)>(
        [this, buffers, began = false](auto& self, boost::system::error_code error = {},
                                       std::size_t bytes_count = 0) mutable {
          if (!std::exchange(began, true)) {
            if (!is_reading_stopped_) return Transport::async_read_some(buffers, std::move(self));
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
    std::array<asio::const_buffer, 2> parts;  // a frame's header and payload, or the payload alone
    std::size_t count = 0;
    for (auto at = asio::buffer_sequence_begin(buffers); at != asio::buffer_sequence_end(buffers); ++at) {
      const asio::const_buffer part = *at;
      if (part.size() == 0) continue;
      if (count < parts.size()) parts[count] = part;
      ++count;
    }
    if (count == 1 && isReplacedClose(parts[0])) {
      const auto rest = asio::buffer(kProtocolErrorClose) + (kProtocolErrorClose.size() - parts[0].size());
      return Transport::async_write_some(rest, std::forward<Handler>(handler));
    }
    if (count == 0 || count > parts.size() || !isOfMessage(parts[count - 1]))
      return Transport::async_write_some(buffers, std::forward<Handler>(handler));
    asio::const_buffer& last = parts[count - 1];
    const auto* first = static_cast<const std::uint8_t*>(last.data());
    const asio::const_buffer rest(first, static_cast<std::size_t>(message_.data() + message_.size() - first));
    if (kWriteTakesRestAlong) last = rest;
    if (!along_.empty() && last.size() == rest.size())
      return writeWithOthers(std::span(parts).first(count), std::forward<Handler>(handler));
    return Transport::async_write_some(parts, std::forward<Handler>(handler));
  }

 private:
  struct Along {
    FrameHeader header;
    core::ByteView message;
  };

  /// Writes `parts`, the end of the message, and the messages along with it. Reports the bytes of `parts`.
  template <typename Handler>
  auto writeWithOthers(std::span<const boost::asio::const_buffer> parts, Handler&& handler) {
    namespace asio = boost::asio;
    gathered_.assign(parts.begin(), parts.end());
    for (const Along& one : along_) {
      gathered_.emplace_back(one.header.bytes().data(), one.header.bytes().size());
      gathered_.emplace_back(one.message.data(), one.message.size());
    }
    return asio::async_compose<Handler, void(boost::system::error_code, std::size_t)>(
        [this, reported = asio::buffer_size(parts), began = false](auto& self, boost::system::error_code error = {},
                                                                   std::size_t bytes_count = 0) mutable {
          if (std::exchange(began, true)) return self.complete(error, std::min(bytes_count, reported));
          const auto unlimited = [](const boost::system::error_code& failed, std::size_t) {
            return failed ? std::size_t{0} : std::numeric_limits<std::size_t>::max();
          };
          asio::async_write(static_cast<Transport&>(*this), std::span<const asio::const_buffer>(gathered_), unlimited,
                            std::move(self));
        },
        handler, *this);
  }

  [[nodiscard]] bool isOfMessage(const boost::asio::const_buffer& part) const {
    const auto* first = static_cast<const std::uint8_t*>(part.data());
    const std::less<> before;
    return !before(first, message_.data()) && before(first, message_.data() + message_.size());
  }

  /// With fewer bytes than a whole frame, the part is the rest of a partly written one.
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

  /// FIN and the opcode, payload length 2, code 1002.
  static constexpr std::array<std::uint8_t, 4> kProtocolErrorClose{0x88, 0x02, 0x03, 0xea};

  core::ByteView message_;
  std::vector<Along> along_;
  std::vector<boost::asio::const_buffer> gathered_;  ///< what writeWithOthers() writes
  FragmentCounter fragments_;
  std::function<bool(std::uint64_t)> on_fragments_;
  bool is_reading_stopped_ = false;
  bool close_is_replaced_ = false;
  bool replaced_close_began_ = false;
};

/// Beast closes a connection with this function, found by the type of the stream.
template <typename Handler>
void async_teardown(boost::beast::role_type role, MessageStream& stream, Handler&& handler) {
  async_teardown(role, static_cast<Transport&>(stream), std::forward<Handler>(handler));
}
inline void teardown(boost::beast::role_type role, MessageStream& stream, boost::system::error_code& error) {
  teardown(role, static_cast<Transport&>(stream), error);
}

}  // namespace spindrift::net
