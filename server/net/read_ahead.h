// A stream that reads as much as there is in one kernel call and keeps what was not asked for. Beast reads a message
// with one call for its header and one or more for the rest; a client of many small messages pays for each, and for the
// ways of each through the strand. Messages that have come whole can be taken past Beast.
#pragma once

#include <optional>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/compose.hpp>
#include <boost/asio/post.hpp>

#include <spindrift/core/bytes.h>

#include "frame_cutter.h"
#include "transport.h"

namespace spindrift::net {

/// Used on one strand, as its base class is. With TLS it is used after the handshake.
class ReadAhead : public Transport {
 public:
  using Transport::Transport;

  template <typename Buffers, typename Handler>
  auto async_read_some(const Buffers& buffers, Handler&& handler) {
    namespace asio = boost::asio;
    enum class At { kBegin, kHasRead, kHasMore };
    return asio::async_compose<Handler, void(boost::system::error_code, std::size_t)>(
        [this, buffers, at = At::kBegin](auto& self, boost::system::error_code error = {},
                                         std::size_t bytes_count = 0) mutable {
          if (at == At::kHasRead) {
            if (error) return self.complete(error, 0);
            kept_.added(bytes_count);
          }
          if (at == At::kBegin && !kept_.next().empty()) {
            at = At::kHasMore;
            return asio::post(get_executor(), std::move(self));  // never completes within the call
          }
          if (kept_.next().empty()) {
            at = At::kHasRead;
            const auto room = kept_.room();
            return Transport::async_read_some(asio::buffer(room.data(), room.size()), std::move(self));
          }
          const core::ByteView next = kept_.next();
          const std::size_t taken = asio::buffer_copy(buffers, asio::buffer(next.data(), next.size()));
          kept_.taken(taken);
          self.complete({}, taken);
        },
        handler, *this);
  }

  /// The handshake has ended; only messages follow.
  void beginMessages() { kept_.beginFrames(); }
  /// Returns a message that has come whole, valid until the next read; nullopt: it, or something else, has to be read.
  /// Call when a message was read to its end.
  std::optional<core::ByteView> takeMessage(std::size_t max_bytes) { return kept_.takeMessage(max_bytes); }

 private:
  static constexpr std::size_t kKeptMaxBytes = 16 * 1024;

  FrameCutter kept_{kKeptMaxBytes};
};

/// Beast closes a connection with these functions, found by the type of the stream.
template <typename Handler>
void async_teardown(boost::beast::role_type role, ReadAhead& stream, Handler&& handler) {
  async_teardown(role, static_cast<Transport&>(stream), std::forward<Handler>(handler));
}
inline void teardown(boost::beast::role_type role, ReadAhead& stream, boost::system::error_code& error) {
  teardown(role, static_cast<Transport&>(stream), error);
}

}  // namespace spindrift::net
