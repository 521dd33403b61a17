// The data plane over loopback: shared buffers, dropping, rates, and clients that do not read.
#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "test_application.h"

namespace spindrift::net {
namespace {

using test::bytes;
using test::eventually;
using test::shared;
using test::TestServer;
using test::text;
using test::WsClient;

/// More than the kernel buffers of a connection hold, so that a write to a client that does not read never ends.
constexpr std::size_t kHugeFrameBytes = 16U << 20U;
constexpr int kTinyReceiveBuffer = 4096;
constexpr double kUnlimitedRate_hz = 1e6;

TEST(Outflow, BringsAFrameToEveryWatcherWhole) {
  TestServer served;
  WsClient ada = served.watcher(1);
  WsClient bob = served.watcher(1);
  WsClient eve = served.watcher(2);
  core::Bytes frame(300'000);
  for (std::size_t k = 0; k < frame.size(); ++k) frame[k] = static_cast<std::uint8_t>(k * 7 + k / 251);
  served.server->hub().publish("pool", 1, {core::share(frame), {}});
  EXPECT_EQ(ada.receive(), frame);
  EXPECT_EQ(bob.receive(), frame);
  ASSERT_TRUE(eve.sendBinary(bytes("echo nothing else")));
  EXPECT_EQ(text(eve.receive()), "echo nothing else");
}

TEST(Outflow, SharesOneBufferAmongAllClients) {
  TestServer served;
  std::vector<WsClient> clients;
  for (int k = 0; k < 6; ++k) clients.push_back(served.watcher(1, kUnlimitedRate_hz, kTinyReceiveBuffer));
  const core::SharedBytes frame = core::share(core::Bytes(kHugeFrameBytes));
  served.server->hub().publish("pool", 1, {frame, {}});
  // No client reads, so each session holds one reference, in its slot or in the unfinished write.
  EXPECT_EQ(frame.use_count(), 1 + 6);
  served.server->stop();
  EXPECT_EQ(frame.use_count(), 1);
}

TEST(Outflow, DropsForAClientThatDoesNotReadAndServesTheOthers) {
  TestServer served({.write_stall_timeout = 3 * test::kPatience});  // longer than the client needs to read at the end
  WsClient stuck = served.watcher(1, kUnlimitedRate_hz, kTinyReceiveBuffer);
  WsClient lively = served.watcher(1);
  // The first frame can never be written to the stuck client; it is in flight before the small ones are published.
  std::vector<std::weak_ptr<const core::Bytes>> frames;
  constexpr int kFrameCount = 100;
  for (int k = 0; k < kFrameCount; ++k) {
    const core::SharedBytes frame =
        core::share(core::Bytes(k == 0 ? kHugeFrameBytes : 1000, static_cast<std::uint8_t>(k)));
    frames.push_back(frame);
    served.server->hub().publish("pool", 1, {frame, {}});
    const auto received = lively.receive();
    ASSERT_TRUE(received) << "frame " << k;
    ASSERT_EQ(*received, *frame) << "frame " << k;
  }
  // Of 100 frames one is in flight, the newest waits, and the others are dropped and counted.
  EXPECT_TRUE(eventually([&] { return served.server->stats().sent_frame_count == kFrameCount; }));
  EXPECT_EQ(served.server->stats().dropped_frame_count, kFrameCount - 2U);
  EXPECT_TRUE(eventually(
      [&] { return std::ranges::count_if(frames, [](const auto& frame) { return !frame.expired(); }) == 2; }));
  // When it reads at last, it gets the frame in flight and then the newest one.
  EXPECT_EQ(stuck.receive().value_or(core::Bytes{}).size(), kHugeFrameBytes);
  EXPECT_EQ(stuck.receive(), core::Bytes(1000, kFrameCount - 1));
}

TEST(Outflow, SendsNothingInsideAPartlyWrittenFrame) {
  TestServer served;
  WsClient slow = served.watcher(1, kUnlimitedRate_hz, kTinyReceiveBuffer);
  core::Bytes frame(kHugeFrameBytes);
  for (std::size_t k = 0; k < frame.size(); ++k) frame[k] = static_cast<std::uint8_t>(k * 13 + k / 65'521);
  served.server->hub().publish("pool", 1, {core::share(frame), {}});
  ASSERT_TRUE(eventually([&] { return served.server->stats().waiting_frame_count == 0; }));
  // The write has begun and cannot end; the kernel is offered the rest again and again while these are answered.
  for (int k = 0; k < 5; ++k) {
    ASSERT_TRUE(slow.sendPing());
    ASSERT_TRUE(slow.sendBinary(bytes("echo " + std::to_string(k))));
  }
  EXPECT_TRUE(slow.receive() == frame);
  for (int k = 0; k < 5; ++k) EXPECT_EQ(text(slow.receive()), "echo " + std::to_string(k));
}

TEST(Outflow, AFrameTakesOneCallPerReader) {
  TestServer served;
  constexpr std::size_t kReaderCount = Hub::kGatherSessionCount;
  constexpr int kFrameCount = 20;
  std::vector<WsClient> readers;
  for (std::size_t k = 0; k < kReaderCount; ++k) readers.push_back(served.watcher(1));
  // The greeting and the answer to "watch": a reader may have the last one before it is counted.
  ASSERT_TRUE(eventually([&] { return served.server->stats().write_count == 2 * kReaderCount; }));
  const ServerStats before = served.server->stats();
  for (int k = 0; k < kFrameCount; ++k) {
    served.server->hub().publish("pool", 1, {core::share(core::Bytes(20'000, static_cast<std::uint8_t>(k))), {}});
    for (WsClient& reader : readers) ASSERT_EQ(reader.receive(), core::Bytes(20'000, static_cast<std::uint8_t>(k)));
  }
  ASSERT_TRUE(eventually(
      [&] { return served.server->stats().sent_frame_count - before.sent_frame_count == kFrameCount * kReaderCount; }));
  const ServerStats after = served.server->stats();
  EXPECT_EQ(after.write_count - before.write_count, kFrameCount * kReaderCount);
  EXPECT_EQ(after.waiting_write_count, before.waiting_write_count);
}

TEST(Outflow, WritesTogetherWhatWaits) {
  TestServer served;
  WsClient slow = served.watcher(1, kUnlimitedRate_hz, kTinyReceiveBuffer);
  constexpr StreamIndex kStreamCount = 7;
  for (StreamIndex stream = 2; stream <= kStreamCount; ++stream) {
    ASSERT_TRUE(slow.sendBinary(bytes("watch " + std::to_string(stream) + " 1000000")));
    ASSERT_EQ(text(slow.receive()), "watching");
  }
  // While this is written, one message of every length of header and more than fit together wait behind it.
  served.server->hub().publish("pool", 1, {core::share(core::Bytes(kHugeFrameBytes)), {}});
  ASSERT_TRUE(eventually([&] { return served.server->stats().waiting_frame_count == 0; }));
  const std::uint64_t write_count = served.server->stats().write_count;
  const std::array<std::size_t, kStreamCount - 1> sizes{1, 125, 126, 30'000, 20'000, 70'000};
  std::vector<core::Bytes> frames;
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    frames.emplace_back(sizes[k]);
    for (std::size_t at = 0; at < sizes[k]; ++at) frames[k][at] = static_cast<std::uint8_t>(at * (k + 3) + at / 251);
    served.server->hub().publish("pool", static_cast<StreamIndex>(k + 2), {core::share(frames[k]), {}});
  }
  ASSERT_TRUE(slow.sendBinary(bytes("echo")));
  ASSERT_TRUE(slow.sendPing());
  EXPECT_EQ(slow.receive().value_or(core::Bytes{}).size(), kHugeFrameBytes);
  EXPECT_EQ(text(slow.receive()), "echo") << "control goes first, also within a write";
  for (const core::Bytes& frame : frames) EXPECT_TRUE(slow.receive() == frame) << frame.size() << " bytes";
  ASSERT_TRUE(eventually([&] { return served.server->stats().sent_frame_count == 1 + frames.size(); }));
  EXPECT_GE(served.server->stats().waiting_write_count, 1U) << "the large one";
  // The large one, then the echo with 1 to 30,000 bytes, then 20,000, then 70,000.
  EXPECT_EQ(served.server->stats().write_count, write_count + 4);
}

TEST(Outflow, EvictsAClientWhoseWriteStalls) {
  TestServer served({.write_stall_timeout = std::chrono::milliseconds(200)});
  const WsClient stuck = served.watcher(1, kUnlimitedRate_hz, kTinyReceiveBuffer);
  served.server->hub().publish("pool", 1, {core::share(core::Bytes(kHugeFrameBytes)), {}});
  ASSERT_TRUE(eventually([&] { return served.application.closed().size() == 1; }));
  EXPECT_EQ(served.application.closed()[0].end.code, 0);
  EXPECT_EQ(served.application.closed()[0].end.reason, "evicted: a write took longer than 200 ms");
  EXPECT_EQ(served.server->stats().evicted_session_count, 1U);
  EXPECT_EQ(served.application.demands.watcherCount("pool", 1), 0U);
  EXPECT_TRUE(served.serves());
}

TEST(Outflow, DropsAStuckClientThatIsBeingClosed) {
  TestServer served({.close_timeout = std::chrono::milliseconds(200)});
  const WsClient stuck = served.watcher(1, kUnlimitedRate_hz, kTinyReceiveBuffer);
  served.server->hub().publish("pool", 1, {core::share(core::Bytes(kHugeFrameBytes)), {}});
  served.server->hub().close(served.application.opened().at(0), CloseCode::kNormal, "enough");
  ASSERT_TRUE(eventually([&] { return served.application.closed().size() == 1; }));
  EXPECT_EQ(served.application.closed()[0].end.reason, "enough");
}

TEST(Outflow, KeepsEachWatchToItsOwnRate) {
  TestServer served;
  WsClient fast = served.watcher(1, kUnlimitedRate_hz);
  WsClient slow = served.watcher(1, 1e-3);
  for (int k = 0; k < 20; ++k) {
    served.server->hub().publish("pool", 1, {shared("frame " + std::to_string(k)), {}});
    ASSERT_EQ(text(fast.receive()), "frame " + std::to_string(k));
  }
  ASSERT_EQ(text(slow.receive()), "frame 0");
  ASSERT_TRUE(slow.sendBinary(bytes("echo end")));
  EXPECT_EQ(text(slow.receive()), "echo end") << "no second frame before";
  EXPECT_TRUE(eventually([&] { return served.server->stats().sent_frame_count == 21; }));
  EXPECT_EQ(served.server->stats().dropped_frame_count, 0U) << "a skipped frame is not a dropped one";
}

TEST(Outflow, StopsALayer) {
  TestServer served;
  WsClient client = served.watcher(1);
  EXPECT_EQ(served.application.demands.watcherCount("pool", 1), 1U);
  ASSERT_TRUE(client.sendBinary(bytes("watch 1 0")));
  EXPECT_EQ(text(client.receive()), "watching");
  EXPECT_EQ(served.application.demands.watcherCount("pool", 1), 0U);
  served.server->hub().publish("pool", 1, {shared("frame"), {}});
  ASSERT_TRUE(client.sendBinary(bytes("echo end")));
  EXPECT_EQ(text(client.receive()), "echo end");
}

TEST(Outflow, CountsWhatItSent) {
  TestServer served;
  WsClient client = served.watcher(1);
  const std::uint64_t control_bytes = std::string("hello poolwatching").size();
  ASSERT_TRUE(eventually([&] { return served.server->stats().sent_bytes_count == control_bytes; }));
  EXPECT_EQ(served.server->stats().sent_frame_count, 0U);
  served.server->hub().publish("pool", 1, {core::share(core::Bytes(5000)), {}});
  ASSERT_TRUE(client.receive());
  ASSERT_TRUE(eventually([&] { return served.server->stats().sent_frame_count == 1; }));
  EXPECT_EQ(served.server->stats().sent_bytes_count, control_bytes + 5000);
  EXPECT_EQ(served.server->stats().open_session_count, 1U);
  EXPECT_EQ(served.server->stats().accepted_session_count, 1U);
}

}  // namespace
}  // namespace spindrift::net
