// Frames on the bus: which bytes are one, and where its parts lie.
#include "frame_head.h"

#include <random>
#include <string>

#include <gtest/gtest.h>

namespace spindrift::cluster {
namespace {

core::Bytes messageOf(const FrameHead& head, const std::string& content) {
  const auto bytes = toBytes(head);
  core::Bytes out(bytes.begin(), bytes.end());
  out.insert(out.end(), content.begin(), content.end());
  return out;
}

std::string text(core::ByteView bytes) {
  return {bytes.begin(), bytes.end()};
}

core::LevelSet allBut(core::Level level) {
  core::LevelSet out = core::LevelSet::all();
  out.erase(level);
  return out;
}

TEST(FrameHead, KeepsItsBytes) {
  const FrameHead head{.run = 0x0102030405060708,
                       .sequence = 0x1112131415161718,
                       .reduced_count = 0x2324,
                       .due = allBut(core::Level::kMedium),
                       .keyframe_bytes = 0x31323334,
                       .delta_bytes = 0x41424344};
  const core::Bytes expected{'1',  'F',  'P',  'S',  8,    7,    6,  5, 4,    3,    2,    1,    0x18, 0x17, 0x16, 0x15,
                             0x14, 0x13, 0x12, 0x11, 0x24, 0x23, 13, 0, 0x34, 0x33, 0x32, 0x31, 0x44, 0x43, 0x42, 0x41};
  EXPECT_EQ(messageOf(head, ""), expected);
}

TEST(Frame, HasKeyframeThenDelta) {
  const core::Bytes message = messageOf({.run = 7,
                                         .sequence = 9,
                                         .reduced_count = 2,
                                         .due = allBut(core::Level::kCoarse),
                                         .keyframe_bytes = 3,
                                         .delta_bytes = 2},
                                        "keyde");
  const auto frame = readFrame(message);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->head.run, 7U);
  EXPECT_EQ(frame->head.sequence, 9U);
  EXPECT_EQ(frame->head.reduced_count, 2U);
  EXPECT_EQ(frame->head.due, allBut(core::Level::kCoarse));
  EXPECT_EQ(text(frame->keyframe), "key");
  EXPECT_EQ(text(frame->delta), "de");
}

TEST(Frame, UnknownLevelsAreRefused) {
  core::Bytes message = messageOf({.keyframe_bytes = 3}, "key");
  constexpr std::size_t kDuePlace = 22;
  message[kDuePlace] = 1U << core::kLevelCount;
  EXPECT_FALSE(readFrame(message));
  message[kDuePlace] = 1;
  EXPECT_TRUE(readFrame(message));
  message[kDuePlace + 1] = 1;
  EXPECT_FALSE(readFrame(message));
}

TEST(Frame, MayLackOneOfThem) {
  const core::Bytes key = messageOf({.keyframe_bytes = 3}, "key"), delta = messageOf({.delta_bytes = 2}, "de");
  ASSERT_TRUE(readFrame(key));
  EXPECT_EQ(text(readFrame(key)->keyframe), "key");
  EXPECT_TRUE(readFrame(key)->delta.empty());
  ASSERT_TRUE(readFrame(delta));
  EXPECT_TRUE(readFrame(delta)->keyframe.empty());
  EXPECT_EQ(text(readFrame(delta)->delta), "de");
}

TEST(Frame, WrongSizeIsRefused) {
  EXPECT_FALSE(readFrame(messageOf({}, ""))) << "neither keyframe nor delta";
  EXPECT_FALSE(readFrame(messageOf({.keyframe_bytes = 3}, "ke")));
  EXPECT_FALSE(readFrame(messageOf({.keyframe_bytes = 3}, "keys")));
  EXPECT_FALSE(readFrame(messageOf({.keyframe_bytes = 3, .delta_bytes = 1}, "key")));
  // The sum does not wrap: these sizes are 3 modulo 2^32.
  EXPECT_FALSE(readFrame(messageOf({.keyframe_bytes = 0xFFFFFFFF, .delta_bytes = 4}, "key")));
  EXPECT_FALSE(readFrame(messageOf({.keyframe_bytes = 4, .delta_bytes = 0xFFFFFFFF}, "key")));
}

TEST(Frame, WrongMarkIsRefused) {
  core::Bytes message = messageOf({.keyframe_bytes = 3}, "key");
  for (std::size_t k = 0; k < 4; ++k) {
    message[k] ^= 1U;
    EXPECT_FALSE(readFrame(message)) << k;
    message[k] ^= 1U;
  }
  EXPECT_TRUE(readFrame(message));
}

TEST(Frame, CutAnywhereIsNone) {
  const core::Bytes message = messageOf({.keyframe_bytes = 3, .delta_bytes = 2}, "keyde");
  for (std::size_t size = 0; size < message.size(); ++size) {
    EXPECT_FALSE(readFrame(core::ByteView(message).first(size))) << size;
  }
}

TEST(Frame, GarbageIsNone) {
  std::mt19937 random(42);
  for (int k = 0; k < 10'000; ++k) {
    core::Bytes noise(random() % 100);
    for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random());
    EXPECT_FALSE(readFrame(noise));
  }
}

}  // namespace
}  // namespace spindrift::cluster
