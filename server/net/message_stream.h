// The stream below a session's WebSocket: the session writes whole messages here, between the frames that Beast writes.
//
// Writing. Beast writes one message at a time, in pieces of at most 64 KiB, and each piece costs a kernel call and a
// turn of the event loop. This stream gives the kernel several messages in one call, however large, each with a frame
// header of its own, and comes back at once if the kernel takes them. Beast writes the response to the upgrade and
// control frames only. Its frames and the messages take turns: the stream follows the bytes that Beast writes, so a
// message begins where a frame has ended, and none follows a close frame.
//
// Reading. Beast joins fragments without reporting them, so its caller cannot bound their number. This stream counts
// them below Beast and stops reading when its owner asks for it.
//
// Closing. Beast echoes any close code from 3000 to 65535, but RFC 6455 section 7.4 ends at 4999.
//
// Measured: decisions 055, 062, 063, 124 and 152.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include <boost/asio/awaitable.hpp>
#include <boost/system/error_code.hpp>

#include <spindrift/core/bytes.h>

#include "transport.h"

namespace spindrift::net {

/// The part of some messages that the kernel has taken.
struct BegunWrite {
  std::size_t bytes_count = 0;  ///< with their headers
  bool is_all = false;
  boost::system::error_code error{};
};

/// Used on one strand, as its base class is.
class MessageStream : public Transport {
 public:
  explicit MessageStream(Transport&& stream);

  /// Call after the handshake and before the first read: from here on both directions are frames. The handler is called
  /// with the number of fragments in a read, if not 0. If it returns false, reading stops: later reads end only when
  /// the connection does.
  void beginFrames(std::function<bool(std::uint64_t)> on_fragments);

  /// Most messages of one write.
  static constexpr std::size_t kMessageMaxCount = 16;

  /// Offers the messages, each as one binary frame, to the kernel in one call, without waiting. Takes nothing with TLS,
  /// and while a frame of Beast's has begun. Call writeMessages() with the same messages unless it has taken all.
  BegunWrite beginMessages(std::span<const core::SharedBytes> messages);

  /// Writes each message as one frame, binary or text, all of them in one kernel call if the kernel has room, from
  /// where `begun` ends. At most kMessageMaxCount, which must stay valid until the write is done. One write at a time.
  /// After a close frame, the write ends when the connection does, with an error.
  boost::asio::awaitable<boost::system::error_code> writeMessages(std::span<const core::SharedBytes> messages,
                                                                  bool are_text = false, BegunWrite begun = {});

  /// Replaces the next frame that Beast writes, a close frame, by one with code 1002 (protocol error) and no reason.
  void closeAsProtocolError();

  /// Closes the socket at once; every pending operation ends.
  void close();

  // For Beast.
  void read(boost::asio::mutable_buffer into, Handler handler) override;
  void write(std::span<const boost::asio::const_buffer> parts, Handler handler) override;

 private:
  struct Shared;
  /// Kept by pending operations, because Beast may drop a stream whose operations have not ended.
  std::shared_ptr<Shared> shared_;
};

}  // namespace spindrift::net
