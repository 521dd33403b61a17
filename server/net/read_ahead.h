// A stream that reads as much as there is in one kernel call and keeps what was not asked for. Beast reads a message
// with one call for its header and one or more for the rest; a client of many small messages pays for each.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include <boost/asio/buffer.hpp>
#include <boost/asio/compose.hpp>
#include <boost/asio/post.hpp>

#include "transport.h"

namespace spindrift::net {

/// Used on one strand, as its base class is. With TLS it is used after the handshake.
class ReadAhead : public Transport {
 public:
  using Transport::Transport;

  template <typename Buffers, typename Handler>
  auto async_read_some(const Buffers& buffers, Handler&& handler) {
    namespace asio = boost::asio;
    enum class At { kBegin, kHasRead, kEnd };
    return asio::async_compose<Handler, void(boost::system::error_code, std::size_t)>(
        [this, buffers, at = At::kBegin](auto& self, boost::system::error_code error = {},
                                         std::size_t bytes_count = 0) mutable {
          switch (std::exchange(at, at == At::kBegin && isEmpty() ? At::kHasRead : At::kEnd)) {
            case At::kBegin:
              if (!isEmpty()) return asio::post(get_executor(), std::move(self));  // never completes within the call
              return Transport::async_read_some(asio::buffer(kept_), std::move(self));
            case At::kHasRead:
              if (error) return self.complete(error, 0);
              begin_ = 0;
              end_ = bytes_count;
              break;
            case At::kEnd:
              break;
          }
          const std::size_t taken = asio::buffer_copy(buffers, asio::buffer(kept_.data() + begin_, end_ - begin_));
          begin_ += taken;
          self.complete({}, taken);
        },
        handler, *this);
  }

 private:
  static constexpr std::size_t kKeptMaxBytes = 16 * 1024;

  [[nodiscard]] bool isEmpty() const { return begin_ == end_; }

  std::vector<std::uint8_t> kept_ = std::vector<std::uint8_t>(kKeptMaxBytes);
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
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
