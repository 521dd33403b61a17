// Frame headers of WebSocket, written and followed, against RFC 6455 section 5.2.
#include "websocket_frames.h"

#include <vector>

#include <gtest/gtest.h>

#include "ws_frames.h"

namespace spindrift::net {
namespace {

using test::bytesOf;
using test::closeFrame;
using test::Opcode;

core::ByteView view(const std::string& bytes) {
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
}

/// Frames with every form of length; three of them are fragments.
std::string frames() {
  return bytesOf({.payload = std::string(200, 'a'), .fin = false}) +
         bytesOf({.opcode = Opcode::kPing, .payload = "p"}) + bytesOf({.opcode = Opcode::kContinuation, .fin = false}) +
         bytesOf({.opcode = Opcode::kContinuation, .payload = std::string(70'000, '\0'), .fin = false}) +
         bytesOf({.opcode = Opcode::kContinuation, .payload = "end"}) + bytesOf({.payload = "whole", .masked = false});
}

std::uint64_t fragmentCount(FrameScanner& scanner, const std::string& bytes) {
  scanner.scan(view(bytes));
  return scanner.takeFragmentCount();
}

std::vector<int> headerOf(std::uint64_t payload_bytes_count) {
  const FrameHeader header = frameHeader(payload_bytes_count);
  return {header.begin(), header.end()};
}

TEST(FrameHeader, HasTheShortestLengthThatFits) {
  EXPECT_EQ(headerOf(0), (std::vector<int>{0x82, 0}));
  EXPECT_EQ(headerOf(125), (std::vector<int>{0x82, 125}));
  EXPECT_EQ(headerOf(126), (std::vector<int>{0x82, 126, 0, 126}));
  EXPECT_EQ(headerOf(0xffff), (std::vector<int>{0x82, 126, 0xff, 0xff}));
  EXPECT_EQ(headerOf(0x10000), (std::vector<int>{0x82, 127, 0, 0, 0, 0, 0, 1, 0, 0}));
  EXPECT_EQ(headerOf(0x0102030405), (std::vector<int>{0x82, 127, 0, 0, 0, 1, 2, 3, 4, 5}));
}

TEST(FrameScanner, CountsDataFramesWithoutTheFinBit) {
  FrameScanner scanner;
  EXPECT_EQ(fragmentCount(scanner, frames()), 3U);
  EXPECT_EQ(fragmentCount(scanner, frames()), 3U) << "the stream continues";
  EXPECT_EQ(fragmentCount(scanner, ""), 0U);
}

TEST(FrameScanner, CountsTheSameWhereverTheBytesAreCut) {
  const std::string all = frames();
  for (std::size_t cut = 0; cut <= 1000; ++cut) {
    FrameScanner scanner;
    const std::uint64_t before = fragmentCount(scanner, all.substr(0, cut));
    EXPECT_EQ(before + fragmentCount(scanner, all.substr(cut)), 3U) << cut;
  }
  FrameScanner scanner;
  std::uint64_t count = 0;
  for (const char byte : all) count += fragmentCount(scanner, std::string(1, byte));
  EXPECT_EQ(count, 3U);
}

TEST(FrameScanner, TakesTheLongestLengthThereIs) {
  FrameScanner scanner;
  const std::string head = std::string("\x02\xff") + std::string(8, '\xff') + "mask";
  EXPECT_EQ(fragmentCount(scanner, head), 1U);
  EXPECT_EQ(fragmentCount(scanner, std::string(100'000, '\0')), 0U) << "all of it is payload";
  EXPECT_FALSE(scanner.isBetweenFrames());
}

TEST(FrameScanner, KnowsWhereFramesEnd) {
  for (const std::size_t size : {0U, 1U, 125U, 126U, 70'000U}) {
    const std::string frame = bytesOf({.opcode = Opcode::kPong, .payload = std::string(size, 'p'), .masked = false});
    FrameScanner scanner;
    EXPECT_TRUE(scanner.isBetweenFrames());
    for (std::size_t at = 0; at < frame.size(); ++at) {
      scanner.scan(view(frame.substr(at, 1)));
      EXPECT_EQ(scanner.isBetweenFrames(), at + 1 == frame.size()) << "byte " << at << " of " << frame.size();
    }
    EXPECT_FALSE(scanner.hasClose());
  }
}

TEST(FrameScanner, FindsTheCloseFrame) {
  FrameScanner scanner;
  scanner.scan(view(frames()));
  EXPECT_FALSE(scanner.hasClose());
  scanner.scan(view(bytesOf(closeFrame(1000))));
  EXPECT_TRUE(scanner.hasClose());
}

}  // namespace
}  // namespace spindrift::net
