// Frames of Beast and messages of the session on one stream, byte by byte.
#include "message_stream.h"

#include <optional>
#include <string>
#include <vector>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <gtest/gtest.h>

#include "test_application.h"
#include "websocket_frames.h"
#include "ws_frames.h"

namespace spindrift::net {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;
using test::bytesOf;
using test::Opcode;

/// More than the kernel buffers of a connection hold.
constexpr std::size_t kHugeBytes = 16U << 20U;

struct Ended {
  error_code error;
  std::size_t bytes_count = 0;
};

class MessageStreamTest : public testing::Test {
 protected:
  MessageStreamTest() {
    tcp::acceptor acceptor(io_, {asio::ip::address_v4::loopback(), 0});
    peer_.connect(acceptor.local_endpoint());
    stream_.emplace(Transport(acceptor.accept()));
    stream_->beginFrames([](std::uint64_t) { return true; });
  }

  /// Runs what is ready; returns whether the operation has ended.
  template <typename Value>
  bool hasEnded(const std::shared_ptr<std::optional<Value>>& operation) {
    io_.restart();
    io_.poll();
    return operation->has_value();
  }
  template <typename Value>
  Value waitFor(const std::shared_ptr<std::optional<Value>>& operation) {
    EXPECT_TRUE(test::eventually([&] { return hasEnded(operation); }));
    return operation->value_or(Value{});
  }

  /// Starts a write of Beast's; `bytes` must stay valid.
  std::shared_ptr<std::optional<Ended>> startWrite(std::string_view bytes) {
    auto out = std::make_shared<std::optional<Ended>>();
    stream_->async_write_some(asio::buffer(bytes), [out](const error_code& error, std::size_t bytes_count) {
      *out = Ended{error, bytes_count};
    });
    return out;
  }
  /// Starts writes of the session's, one message each.
  std::shared_ptr<std::optional<error_code>> startMessages(std::vector<core::SharedBytes> messages,
                                                           BegunWrite begun = {}) {
    auto out = std::make_shared<std::optional<error_code>>();
    const auto write = [](MessageStream& stream, std::vector<core::SharedBytes> all,
                          BegunWrite first) -> asio::awaitable<error_code> {
      error_code error;
      for (const core::SharedBytes& one : all)
        if (!error) error = co_await stream.writeMessages({&one, 1}, false, std::exchange(first, {}));
      co_return error;
    };
    asio::co_spawn(io_, write(*stream_, std::move(messages), begun),
                   [out](const std::exception_ptr&, error_code error) { *out = error; });
    return out;
  }

  /// Returns the next bytes that the peer receives.
  std::string received(std::size_t bytes_count) {
    std::string out(bytes_count, '\0');
    auto ended = std::make_shared<std::optional<error_code>>();
    asio::async_read(peer_, asio::buffer(out), [ended](const error_code& error, std::size_t) { *ended = error; });
    EXPECT_FALSE(waitFor(ended));
    return out;
  }

  static std::string frameOf(const core::Bytes& message) {
    const FrameHeader header = frameHeader(message.size());
    return std::string(header.begin(), header.end()) + std::string(message.begin(), message.end());
  }

  asio::io_context io_;
  tcp::socket peer_{io_};
  std::optional<MessageStream> stream_;
};

TEST_F(MessageStreamTest, MessagesWaitForTheRestOfAFrame) {
  const std::string pong = bytesOf({.opcode = Opcode::kPong, .payload = "pong", .masked = false});
  const core::SharedBytes message = test::shared("water");
  const auto begin = startWrite(std::string_view(pong).substr(0, 1));
  EXPECT_EQ(waitFor(begin).bytes_count, 1U);
  const auto written = startMessages({message});
  EXPECT_FALSE(hasEnded(written));
  const auto rest = startWrite(std::string_view(pong).substr(1));
  EXPECT_EQ(waitFor(rest).bytes_count, pong.size() - 1);
  EXPECT_FALSE(waitFor(written));
  EXPECT_EQ(received(pong.size() + 7), pong + frameOf(*message));
}

TEST_F(MessageStreamTest, AFrameOfBeastComesAfterTheMessageBeingWritten) {
  const std::string pong = bytesOf({.opcode = Opcode::kPong, .payload = "pong", .masked = false});
  const core::SharedBytes huge = core::share(core::Bytes(kHugeBytes, 7));
  const core::SharedBytes small = test::shared("water");
  const auto written = startMessages({huge, small, small});
  EXPECT_FALSE(hasEnded(written));
  const auto answered = startWrite(pong);
  EXPECT_FALSE(hasEnded(answered));
  EXPECT_TRUE(received(10 + kHugeBytes) == frameOf(*huge));
  EXPECT_EQ(received(pong.size() + 14), pong + frameOf(*small) + frameOf(*small)) << "and before the others";
  EXPECT_FALSE(waitFor(written));
  EXPECT_EQ(waitFor(answered).bytes_count, pong.size());
}

TEST_F(MessageStreamTest, NoMessageFollowsACloseFrame) {
  const std::string close = "\x88\x02\x03\xe8";
  EXPECT_EQ(waitFor(startWrite(close)).bytes_count, close.size());
  const auto written = startMessages({test::shared("late")});
  EXPECT_EQ(received(close.size()), close);
  EXPECT_FALSE(hasEnded(written));
  EXPECT_EQ(peer_.available(), 0U);
  stream_->close();
  EXPECT_TRUE(waitFor(written)) << "fails when the connection ends";
}

TEST_F(MessageStreamTest, TheKernelTakesWhatItHasRoomForAtOnce) {
  const std::vector<core::SharedBytes> small{test::shared("water"), test::shared("waves")};
  const BegunWrite all = stream_->beginMessages(small);
  EXPECT_TRUE(all.is_all);
  EXPECT_EQ(all.bytes_count, 14U);
  EXPECT_EQ(received(14), frameOf(*small[0]) + frameOf(*small[1]));
}

TEST_F(MessageStreamTest, ASmallMessageContinuesWhereTheKernelStopped) {
  core::Bytes bytes(11'003);
  for (std::size_t k = 0; k < bytes.size(); ++k) bytes[k] = static_cast<std::uint8_t>(k * 13);
  const core::SharedBytes small = core::share(std::move(bytes));
  std::string expected;
  BegunWrite begun{.is_all = true};
  while (begun.is_all) {  // until the buffers of the kernel are full
    begun = stream_->beginMessages({&small, 1});
    EXPECT_FALSE(begun.error);
    expected += frameOf(*small);
  }
  const auto written = startMessages({small}, begun);
  EXPECT_TRUE(received(expected.size()) == expected);
  EXPECT_FALSE(waitFor(written));
}

TEST_F(MessageStreamTest, TheRestOfABegunMessageComesBeforeAFrameOfBeast) {
  const std::string pong = bytesOf({.opcode = Opcode::kPong, .payload = "pong", .masked = false});
  core::Bytes bytes(kHugeBytes);
  for (std::size_t k = 0; k < bytes.size(); ++k) bytes[k] = static_cast<std::uint8_t>(k * 13 + k / 65'521);
  const core::SharedBytes huge = core::share(std::move(bytes));
  const BegunWrite begun = stream_->beginMessages({&huge, 1});
  EXPECT_FALSE(begun.is_all);
  EXPECT_FALSE(begun.error);
  EXPECT_GT(begun.bytes_count, 0U);
  const auto answered = startWrite(pong);
  EXPECT_FALSE(hasEnded(answered));
  const auto written = startMessages({huge}, begun);
  EXPECT_TRUE(received(10 + kHugeBytes) == frameOf(*huge));
  EXPECT_FALSE(waitFor(written));
  EXPECT_EQ(received(pong.size()), pong);
  EXPECT_EQ(waitFor(answered).bytes_count, pong.size());
}

TEST_F(MessageStreamTest, BeginsNothingWithinOrAfterAFrameOfBeast) {
  const std::string close = "\x88\x02\x03\xe8";
  const core::SharedBytes message = test::shared("water");
  EXPECT_EQ(waitFor(startWrite(std::string_view(close).substr(0, 1))).bytes_count, 1U);
  EXPECT_EQ(stream_->beginMessages({&message, 1}).bytes_count, 0U);
  EXPECT_EQ(waitFor(startWrite(std::string_view(close).substr(1))).bytes_count, 3U);
  EXPECT_EQ(stream_->beginMessages({&message, 1}).bytes_count, 0U);
  EXPECT_EQ(received(close.size()), close);
  EXPECT_EQ(peer_.available(), 0U);
}

TEST_F(MessageStreamTest, ReportsAConnectionThatIsGone) {
  const core::SharedBytes message = test::shared("water");
  stream_->close();
  EXPECT_TRUE(stream_->beginMessages({&message, 1}).error);
}

TEST_F(MessageStreamTest, ReplacesACloseFrameInPieces) {
  const std::string close = std::string("\x88\x06\x13\x88", 4) + "five";
  const std::string pong = bytesOf({.opcode = Opcode::kPong, .masked = false});
  EXPECT_EQ(waitFor(startWrite(std::string_view(pong).substr(0, 1))).bytes_count, 1U);
  stream_->closeAsProtocolError();
  EXPECT_EQ(waitFor(startWrite(std::string_view(pong).substr(1))).bytes_count, 1U) << "not the frame that has begun";
  EXPECT_EQ(waitFor(startWrite(std::string_view(close).substr(0, 3))).bytes_count, 3U);
  EXPECT_EQ(waitFor(startWrite(std::string_view(close).substr(3))).bytes_count, close.size() - 3);
  EXPECT_EQ(received(pong.size() + 4), pong + "\x88\x02\x03\xea");
  EXPECT_EQ(peer_.available(), 0U);
}

TEST_F(MessageStreamTest, PendingOperationsMayOutliveTheStream) {
  const core::SharedBytes huge = core::share(core::Bytes(kHugeBytes));
  const auto written = startMessages({huge});
  EXPECT_FALSE(hasEnded(written));
  const std::string ping = std::string("\x89\x00", 2);
  const auto waiting = startWrite(ping);
  stream_->close();
  stream_.reset();
  EXPECT_TRUE(waitFor(written));
  EXPECT_TRUE(waitFor(waiting).error);
}

}  // namespace
}  // namespace spindrift::net
