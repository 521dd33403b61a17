// A keyframe made from a stream of deltas is the one that the encoder would have made, and the stream continues from
// it.
#include <cmath>

#include <gtest/gtest.h>

#include <spindrift/codec/frame_decoder.h>
#include <spindrift/codec/frame_encoder.h>

#include "damaged_frames.h"

namespace spindrift::codec {
namespace {

constexpr Stream kSurface{v1::LAYER_SURFACE, v1::PACKING_PACKED};
constexpr Stream kFoam{v1::LAYER_FOAM, v1::PACKING_PACKED};
constexpr Stream kFloaters{v1::LAYER_FLOATERS, v1::PACKING_PACKED};

/// Waves, foam on a grid of half as many samples, and objects, that change from frame to frame.
struct Water {
  core::CellCounts count;
  std::vector<std::uint32_t> surface;
  std::vector<std::uint32_t> foam;
  std::vector<std::uint32_t> floaters;

  Water(core::CellCounts size, std::uint64_t tick) : count(size), surface((size.total() + 1) / 2) {
    const core::CellCounts half = core::foamSamples(size);
    foam.resize((half.total() + 3) / 4);
    const double t = static_cast<double>(tick) / 10.0;
    for (std::uint32_t k = 0; k < count.total(); ++k) {
      const auto sample = static_cast<std::int16_t>(
          std::lround(900 * std::sin(0.3 * (k % count.x) + t) * std::cos(0.2 * (k / count.x))));
      surface[k / 2] |= static_cast<std::uint32_t>(static_cast<std::uint16_t>(sample)) << (16 * (k % 2));
    }
    for (std::uint32_t k = 0; k < half.total(); ++k) {
      foam[k / 4] |= static_cast<std::uint32_t>((k + tick * 7) % 256) << (8 * (k % 4));
    }
    for (std::uint32_t id = 1 + static_cast<std::uint32_t>(tick / 4); id < 90; ++id) {
      const auto at_mm = static_cast<std::uint32_t>(std::lround(900 * std::sin(0.3 * id + t)));
      const auto part = static_cast<std::uint32_t>(std::lround(9000 * std::sin(0.2 * id + 2 * t)));
      floaters.insert(floaters.end(), {id, at_mm, id * 10, at_mm + id, part & 0xffffu, 0x7000'0000u | (part & 0xffffu),
                                       30u | (1 + id % 8) << 16});
    }
  }
  [[nodiscard]] core::FrameView view(std::uint64_t tick) const {
    core::FrameView out;
    out.tick = tick;
    out.time_s = static_cast<double>(tick) / 60.0;
    out.asked_s = 100.0 + out.time_s;
    out.state_id = tick + 5;
    auto& full = out.at(core::Level::kFull);
    full.surface = core::SurfaceView{count, 16.0, 16.0 * count.z / count.x, 0.001, surface};
    full.foam = core::FoamView{core::foamSamples(count), 16.0, 16.0 * count.z / count.x, foam};
    out.floaters = core::FloatersView{static_cast<std::uint32_t>(floaters.size() / 7), floaters};
    return out;
  }
};

class FrameKeeperTest : public testing::TestWithParam<Stream> {};

TEST_P(FrameKeeperTest, MakesTheKeyframeOfTheEncoderToTheBit) {
  for (const core::CellCounts count : {core::CellCounts{64, 64}, core::CellCounts{37, 21}, core::CellCounts{1, 9}}) {
    FrameEncoder encoder;
    FrameKeeper keeper;
    for (std::uint64_t tick = 10; tick < 30; ++tick) {
      const Water water(count, tick);
      const EncodedFrame encoded = encoder.encode(GetParam(), water.view(tick), core::Level::kFull, true);
      ASSERT_EQ(encoded.delta == nullptr, tick == 10);
      ASSERT_TRUE(keeper.take(encoded.delta ? *encoded.delta : *encoded.keyframe));
      const core::SharedBytes made = keeper.keyframe();
      ASSERT_TRUE(made);
      EXPECT_EQ(frameOf(made).SerializeAsString(), frameOf(encoded.keyframe).SerializeAsString())
          << count.x << " x " << count.z << ", tick " << tick;
    }
  }
}

TEST_P(FrameKeeperTest, KeyframeFitsTheNextDelta) {
  const core::CellCounts count{48, 32};
  FrameEncoder encoder;
  FrameKeeper keeper;
  PackedSurfaceDecoder late_surface;
  PackedFoamDecoder late_foam;
  PackedFloaterDecoder late_floaters;
  const auto isRead = [&](const core::SharedBytes& bytes) {
    const v1::LayerFrame frame = frameOf(bytes);
    if (frame.has_floaters_predicted()) return static_cast<bool>(late_floaters.decode(frame));
    return frame.has_surface_predicted() ? static_cast<bool>(late_surface.decode(frame))
                                         : static_cast<bool>(late_foam.decode(frame));
  };
  for (std::uint64_t tick = 10; tick < 20; ++tick) {
    const Water water(count, tick);
    const EncodedFrame encoded = encoder.encode(GetParam(), water.view(tick), core::Level::kFull, false);
    ASSERT_TRUE(keeper.take(encoded.delta ? *encoded.delta : *encoded.keyframe));
    if (tick == 14) {
      ASSERT_TRUE(isRead(keeper.keyframe()));
    }
    if (tick > 14) {
      ASSERT_TRUE(isRead(encoded.delta)) << tick;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Layers, FrameKeeperTest, testing::Values(kSurface, kFoam, kFloaters),
                         [](const auto& of) { return v1::Layer_Name(of.param.layer); });

TEST(FrameKeeper, HasNothingAfterALostOrDamagedFrame) {
  const core::CellCounts count{32, 32};
  FrameEncoder encoder;
  FrameKeeper keeper;
  EXPECT_FALSE(keeper.keyframe()) << "nothing has come";
  const auto encoded = [&](std::uint64_t tick, bool wants_keyframe = false) {
    return encoder.encode(kSurface, Water(count, tick).view(tick), core::Level::kFull, wants_keyframe);
  };
  ASSERT_TRUE(keeper.take(*encoded(1).keyframe));
  (void)encoded(2);
  EXPECT_FALSE(keeper.take(*encoded(3).delta)) << "it builds on tick 2";
  EXPECT_FALSE(keeper.keyframe());
  const EncodedFrame fresh = encoded(4, true);
  EXPECT_FALSE(keeper.take(*fresh.delta));
  ASSERT_TRUE(keeper.take(*fresh.keyframe));
  EXPECT_TRUE(keeper.keyframe());
  core::Bytes damaged = *encoded(5).delta;
  damaged.back() ^= 1U;
  EXPECT_FALSE(keeper.take(damaged));
  EXPECT_FALSE(keeper.keyframe());
  EXPECT_FALSE(keeper.take({})) << "no message";
}

TEST(FrameKeeper, KnowsPackedFramesOnly) {
  const Water water({16, 16}, 1);
  FrameKeeper keeper;
  EXPECT_FALSE(keeper.take(*FrameEncoder().encode(v1::LAYER_SURFACE, water.view(1))));
  EXPECT_FALSE(keeper.keyframe());
}

}  // namespace
}  // namespace spindrift::codec
