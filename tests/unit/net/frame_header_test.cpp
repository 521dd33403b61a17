// Frame headers of messages of a server, against RFC 6455 section 5.2.
#include "frame_header.h"

#include <vector>

#include <gtest/gtest.h>

namespace spindrift::net {
namespace {

std::vector<int> headerOf(std::size_t payload_bytes_count) {
  const FrameHeader header(payload_bytes_count);
  return {header.bytes().begin(), header.bytes().end()};
}

TEST(FrameHeader, HasTheShortestLengthThatFits) {
  EXPECT_EQ(headerOf(0), (std::vector<int>{0x82, 0}));
  EXPECT_EQ(headerOf(125), (std::vector<int>{0x82, 125}));
  EXPECT_EQ(headerOf(126), (std::vector<int>{0x82, 126, 0, 126}));
  EXPECT_EQ(headerOf(0xffff), (std::vector<int>{0x82, 126, 0xff, 0xff}));
  EXPECT_EQ(headerOf(0x10000), (std::vector<int>{0x82, 127, 0, 0, 0, 0, 0, 1, 0, 0}));
  EXPECT_EQ(headerOf(0x0102030405), (std::vector<int>{0x82, 127, 0, 0, 0, 1, 2, 3, 4, 5}));
}

}  // namespace
}  // namespace spindrift::net
