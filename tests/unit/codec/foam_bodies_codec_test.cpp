#include <numbers>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/codec/frame_decoder.h>
#include <spindrift/codec/frame_encoder.h>
#include <spindrift/core/scene.h>

#include "damaged_frames.h"

namespace spindrift::codec {
namespace {

v1::LayerFrame encoded(v1::Layer layer, const core::FrameView& view) {
  return frameOf(FrameEncoder().encode(layer, view));
}

v1::LayerFrame foamFrame() {
  const std::vector<std::uint32_t> words = {0x0302'0100u, 0x0000'0000u, 0xFFFE'FDFCu, 0x8080'8080u};
  core::FrameView view;
  view.tick = 60;
  view.time_s = 1.0;
  view.at(core::Level::kFull).foam = core::FoamView{{4, 4}, 16.0, 16.0, words};
  return encoded(v1::LAYER_FOAM, view);
}

v1::LayerFrame bodiesFrame(const std::vector<std::uint32_t>& words) {
  core::FrameView view;
  view.tick = 60;
  view.time_s = 1.0;
  view.bodies = core::BodiesView{static_cast<std::uint32_t>(words.size() / 7), words};
  return encoded(v1::LAYER_BODIES, view);
}

constexpr std::uint32_t kMinus20 = -20u, kMinus2250 = -2'250u;

const std::vector<std::uint32_t> kTwoBoats = {
    1, 1'500, kMinus20, kMinus2250, 0x0000'4000u, 0x0000'0000u, 0x0000'0000u,  //
    9, 0,     0,        0,          0x7FFF'8001u, 0xFF38'C000u, 0x0000'7F81u};

v1::LayerFrame floatersFrame(const std::vector<std::uint32_t>& words) {
  core::FrameView view;
  view.tick = 60;
  view.time_s = 1.0;
  view.floaters = core::FloatersView{static_cast<std::uint32_t>(words.size() / 7), words};
  return encoded(v1::LAYER_FLOATERS, view);
}

/// A duck of 0.6 m at rest; a held stone of 2 m, half a turn about z.
const std::vector<std::uint32_t> kTwoFloaters = {
    3,         1'500, kMinus20, kMinus2250, 0x0000'0000u, 0x7FFF'0000u, 0x0005'003Cu,  //
    1'000'000, 0,     0,        0,          0x0000'0000u, 0x0000'8001u, 0x0108'00C8u};

TEST(FoamCodec, RoundTripsEveryByte) {
  const v1::LayerFrame frame = foamFrame();
  EXPECT_EQ(frame.layer(), v1::LAYER_FOAM);
  EXPECT_TRUE(frame.keyframe());
  const auto samples = decodeFoam(frame);
  ASSERT_TRUE(samples) << samples.error().message;
  EXPECT_EQ(samples->count.x, 4u);
  EXPECT_EQ(samples->length_m, 16.0);
  EXPECT_THAT(samples->foam, testing::ElementsAre(0, 1, 2, 3, 0, 0, 0, 0, 252, 253, 254, 255, 128, 128, 128, 128));
}

TEST(BodiesCodec, RoundTripsPositionAnglesSpeedAndControls) {
  const auto bodies = decodeBodies(bodiesFrame(kTwoBoats));
  ASSERT_TRUE(bodies) << bodies.error().message;
  ASSERT_EQ(bodies->size(), 2u);
  const BodySample& one = bodies->at(0);
  EXPECT_EQ(one.boat_id, 1u);
  EXPECT_DOUBLE_EQ(one.position_m[0], 1.5);
  EXPECT_DOUBLE_EQ(one.position_m[1], -0.02);
  EXPECT_DOUBLE_EQ(one.position_m[2], -2.25);
  EXPECT_NEAR(one.heading_rad, std::numbers::pi / 2, 1e-4);
  EXPECT_EQ(one.speed_mps, 0.0);
  const BodySample& other = bodies->at(1);
  EXPECT_EQ(other.boat_id, 9u);
  EXPECT_DOUBLE_EQ(other.heading_rad, -std::numbers::pi);
  EXPECT_DOUBLE_EQ(other.pitch_rad, std::numbers::pi);
  EXPECT_NEAR(other.roll_rad, -std::numbers::pi / 2, 1e-4);
  EXPECT_DOUBLE_EQ(other.speed_mps, -2.0);
  EXPECT_DOUBLE_EQ(other.throttle_ratio, -1.0);
  EXPECT_DOUBLE_EQ(other.rudder_ratio, 1.0);
}

TEST(BodiesCodec, HandlesAnEmptyWater) {
  const auto bodies = decodeBodies(bodiesFrame({}));
  ASSERT_TRUE(bodies) << bodies.error().message;
  EXPECT_TRUE(bodies->empty());
}

TEST(FloatersCodec, RoundTripsPositionRotationSizeAndKind) {
  const auto floaters = decodeFloaters(floatersFrame(kTwoFloaters));
  ASSERT_TRUE(floaters) << floaters.error().message;
  ASSERT_EQ(floaters->size(), 2u);
  const FloaterSample& duck = floaters->at(0);
  EXPECT_EQ(duck.floater_id, 3u);
  EXPECT_THAT(duck.position_m, testing::ElementsAre(1.5, -0.02, -2.25));
  EXPECT_THAT(duck.rotation, testing::ElementsAre(0.0, 0.0, 0.0, 1.0));
  EXPECT_DOUBLE_EQ(duck.size_m, 0.6);
  EXPECT_EQ(duck.kind, v1::FLOATER_KIND_DUCK);
  EXPECT_FALSE(duck.is_held);
  const FloaterSample& stone = floaters->at(1);
  EXPECT_EQ(stone.floater_id, 1'000'000u);
  EXPECT_THAT(stone.rotation, testing::ElementsAre(0.0, 0.0, -1.0, 0.0));
  EXPECT_DOUBLE_EQ(stone.size_m, 2.0);
  EXPECT_EQ(stone.kind, v1::FLOATER_KIND_STONE);
  EXPECT_TRUE(stone.is_held);
}

TEST(FloatersCodec, HandlesAnEmptyWaterAndAFullOne) {
  const auto none = decodeFloaters(floatersFrame({}));
  ASSERT_TRUE(none) << none.error().message;
  EXPECT_TRUE(none->empty());
  std::vector<std::uint32_t> words;
  for (std::uint32_t k = 0; k < core::kMaxFloaters; ++k)
    words.insert(words.end(), kTwoFloaters.begin(), kTwoFloaters.begin() + 7);
  const auto all = decodeFloaters(floatersFrame(words));
  ASSERT_TRUE(all) << all.error().message;
  EXPECT_EQ(all->size(), core::kMaxFloaters);
}

TEST(FoamCodec, RefusesDamagedFrames) {
  expectRefusals(
      foamFrame(),
      {
          {"layer", [](v1::LayerFrame& f) { f.set_layer(v1::LAYER_SURFACE); }, "LAYER_FOAM"},
          {"codec", [](v1::LayerFrame& f) { f.mutable_surface_fixed16(); }, "codec"},
          {"not whole", [](v1::LayerFrame& f) { f.set_keyframe(false); }, "keyframe"},
          {"time", [](v1::LayerFrame& f) { f.set_time_s(std::nan("")); }, "time_s"},
          {"resolution 0", [](v1::LayerFrame& f) { f.mutable_foam_fixed8()->set_resolution_count(0); }, "4096"},
          {"resolution wraps", [](v1::LayerFrame& f) { f.mutable_foam_fixed8()->set_resolution_count(0x1'0004u); },
           "4096"},
          {"resolution 5", [](v1::LayerFrame& f) { f.mutable_foam_fixed8()->set_resolution_count(5); }, "payload"},
          {"side", [](v1::LayerFrame& f) { f.mutable_foam_fixed8()->set_side_m(std::nan("")); }, "side_m"},
          {"side 0", [](v1::LayerFrame& f) { f.mutable_foam_fixed8()->set_side_m(0); }, "side_m"},
          {"short", [](v1::LayerFrame& f) { f.mutable_payload()->pop_back(); }, "15 bytes"},
          {"flipped", [](v1::LayerFrame& f) { (*f.mutable_payload())[3] ^= 1; }, "crc32c", false},
      },
      [](const v1::LayerFrame& frame) { return decodeFoam(frame); });
}

TEST(BodiesCodec, RefusesDamagedFrames) {
  expectRefusals(
      bodiesFrame(kTwoBoats),
      {
          {"layer", [](v1::LayerFrame& f) { f.set_layer(v1::LAYER_FOAM); }, "LAYER_BODIES"},
          {"codec", [](v1::LayerFrame& f) { f.clear_codec(); }, "codec"},
          {"not whole", [](v1::LayerFrame& f) { f.set_keyframe(false); }, "keyframe"},
          {"count 3", [](v1::LayerFrame& f) { f.mutable_bodies_fixed28()->set_count(3); }, "calls for 84"},
          {"count over", [](v1::LayerFrame& f) { f.mutable_bodies_fixed28()->set_count(kBodyMaxCount + 1); }, "1024"},
          // 28 * count would wrap to the payload's 56 bytes in 32 bits.
          {"count wraps", [](v1::LayerFrame& f) { f.mutable_bodies_fixed28()->set_count(0x4000'0002u); }, "count"},
          {"id 0", [](v1::LayerFrame& f) { (*f.mutable_payload())[0] = 0; }, "boat_id"},
          {"far away", [](v1::LayerFrame& f) { (*f.mutable_payload())[7] = 0x7F; }, "position_m"},
          {"short", [](v1::LayerFrame& f) { f.mutable_payload()->resize(55); }, "55 bytes"},
          {"flipped", [](v1::LayerFrame& f) { (*f.mutable_payload())[30] ^= 4; }, "crc32c", false},
      },
      [](const v1::LayerFrame& frame) { return decodeBodies(frame); });
}

TEST(FloatersCodec, RefusesDamagedFrames) {
  expectRefusals(
      floatersFrame(kTwoFloaters),
      {
          {"layer", [](v1::LayerFrame& f) { f.set_layer(v1::LAYER_BODIES); }, "LAYER_FLOATERS"},
          {"codec", [](v1::LayerFrame& f) { f.mutable_bodies_fixed28()->set_count(2); }, "codec"},
          {"not whole", [](v1::LayerFrame& f) { f.set_keyframe(false); }, "keyframe"},
          {"count 3", [](v1::LayerFrame& f) { f.mutable_floaters_fixed28()->set_count(3); }, "calls for 84"},
          {"count over", [](v1::LayerFrame& f) { f.mutable_floaters_fixed28()->set_count(1025); }, "1024"},
          // 28 * count would wrap to the payload's 56 bytes in 32 bits.
          {"count wraps", [](v1::LayerFrame& f) { f.mutable_floaters_fixed28()->set_count(0x4000'0002u); }, "count"},
          {"id 0", [](v1::LayerFrame& f) { (*f.mutable_payload())[0] = 0; }, "floater_id"},
          {"far away", [](v1::LayerFrame& f) { (*f.mutable_payload())[7] = 0x7F; }, "position_m"},
          {"no rotation", [](v1::LayerFrame& f) { (*f.mutable_payload())[23] = 0; }, "rotation"},
          {"rotation too long", [](v1::LayerFrame& f) { (*f.mutable_payload())[17] = 0x10; }, "rotation"},
          {"kind 0", [](v1::LayerFrame& f) { (*f.mutable_payload())[26] = 0; }, "kind"},
          {"short", [](v1::LayerFrame& f) { f.mutable_payload()->resize(55); }, "55 bytes"},
          {"flipped", [](v1::LayerFrame& f) { (*f.mutable_payload())[30] ^= 4; }, "crc32c", false},
      },
      [](const v1::LayerFrame& frame) { return decodeFloaters(frame); });
}

}  // namespace
}  // namespace spindrift::codec
