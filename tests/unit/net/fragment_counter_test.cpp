#include "fragment_counter.h"

#include <gtest/gtest.h>

#include "ws_frames.h"

namespace spindrift::net {
namespace {

using test::bytesOf;
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

TEST(FragmentCounter, CountsDataFramesWithoutTheFinBit) {
  FragmentCounter counter;
  EXPECT_EQ(counter.count(view(frames())), 3U);
  EXPECT_EQ(counter.count(view(frames())), 3U) << "the stream continues";
  EXPECT_EQ(counter.count({}), 0U);
}

TEST(FragmentCounter, CountsTheSameWhereverTheBytesAreCut) {
  const std::string all = frames();
  for (std::size_t cut = 0; cut <= 1000; ++cut) {
    FragmentCounter counter;
    EXPECT_EQ(counter.count(view(all.substr(0, cut))) + counter.count(view(all.substr(cut))), 3U) << cut;
  }
  FragmentCounter counter;
  std::uint64_t count = 0;
  for (const char byte : all) count += counter.count(view(std::string(1, byte)));
  EXPECT_EQ(count, 3U);
}

TEST(FragmentCounter, TakesTheLongestLengthThereIs) {
  FragmentCounter counter;
  const std::string head = std::string("\x02\xff") + std::string(8, '\xff') + "mask";
  EXPECT_EQ(counter.count(view(head)), 1U);
  EXPECT_EQ(counter.count(view(std::string(100'000, '\0'))), 0U) << "all of it is payload";
}

}  // namespace
}  // namespace spindrift::net
