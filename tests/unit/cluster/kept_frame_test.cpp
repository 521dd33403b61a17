// What an edge keeps of a stream for late sessions.
#include "kept_frame.h"

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <spindrift/codec/frame_encoder.h>

namespace spindrift::cluster {
namespace {

/// A packed surface of one value, which changes from tick to tick.
class Source {
 public:
  codec::EncodedFrame next(bool wants_keyframe = false) {
    ++tick_;
    const std::vector<std::uint32_t> words(kSide * kSide / 2, tick_ * 0x00010001U);
    core::FrameView view;
    view.tick = tick_;
    view.at(core::Level::kFull).surface = core::SurfaceView{{kSide, kSide}, 8.0, 8.0, 0.001, words};
    return encoder_.encode({v1::LAYER_SURFACE, v1::PACKING_PACKED}, view, core::Level::kFull, wants_keyframe);
  }

 private:
  static constexpr std::uint32_t kSide = 16;
  codec::FrameEncoder encoder_;
  std::uint32_t tick_ = 0;
};

v1::LayerFrame frameOf(const core::SharedBytes& bytes) {
  return bytes ? codec::parseServerMessage(*bytes)->frame() : v1::LayerFrame();
}

TEST(KeptFrame, IsTheNewestKeyframeItself) {
  Source source;
  KeptFrame kept;
  EXPECT_FALSE(kept.isWhole());
  EXPECT_FALSE(kept.keyframe());
  const codec::EncodedFrame first = source.next();
  kept.takeKeyframe(first.keyframe);
  EXPECT_TRUE(kept.isWhole());
  EXPECT_EQ(kept.keyframe(), first.keyframe) << "not a copy";
}

TEST(KeptFrame, IsNothingAfterADeltaThatIsNotFollowed) {
  Source source;
  KeptFrame kept;
  kept.takeKeyframe(source.next().keyframe);
  kept.takeDelta(source.next().delta, false);
  EXPECT_FALSE(kept.isWhole()) << "the keyframe is older than what the others have";
  kept.takeDelta(source.next().delta, true);
  EXPECT_FALSE(kept.isWhole()) << "the frame before is not here";
}

TEST(KeptFrame, FollowsDeltasAndIsMadeOnce) {
  Source source;
  KeptFrame kept;
  kept.takeKeyframe(source.next().keyframe);
  for (std::uint64_t tick = 2; tick < 6; ++tick) {
    kept.takeDelta(source.next().delta, true);
    ASSERT_TRUE(kept.isWhole());
    const core::SharedBytes made = kept.keyframe();
    EXPECT_TRUE(frameOf(made).keyframe());
    EXPECT_EQ(frameOf(made).tick(), tick);
    EXPECT_EQ(kept.keyframe(), made) << "the same bytes for all who come before the next frame";
  }
  kept.takeDelta(source.next().delta, true);  // nobody came meanwhile
  kept.takeDelta(source.next().delta, true);
  EXPECT_EQ(frameOf(kept.keyframe()).tick(), 7U);
}

TEST(KeptFrame, BeginsAnewAfterALossAndAfterAKeyframe) {
  Source source;
  KeptFrame kept;
  kept.takeKeyframe(source.next().keyframe);
  kept.takeDelta(source.next().delta, true);
  (void)source.next();
  kept.takeDelta(source.next().delta, true);
  EXPECT_FALSE(kept.isWhole()) << "a frame between is missing";
  kept.takeKeyframe(source.next(true).keyframe);
  kept.takeDelta(source.next().delta, true);
  EXPECT_EQ(frameOf(kept.keyframe()).tick(), 6U);
  kept.forget();
  EXPECT_FALSE(kept.isWhole());
  EXPECT_FALSE(kept.keyframe());
}

}  // namespace
}  // namespace spindrift::cluster
