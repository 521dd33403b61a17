#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/codec/frame_decoder.h>
#include <spindrift/codec/frame_encoder.h>
#include <spindrift/core/crc32c.h>

namespace spindrift::codec {
namespace {

using testing::HasSubstr;

v1::LayerFrame encoded(v1::Layer layer, const core::FrameView& view) {
  const core::SharedBytes bytes = FrameEncoder().encode(layer, view);
  if (!bytes) {
    ADD_FAILURE() << "nothing encoded";
    return {};
  }
  const auto message = parseServerMessage(*bytes);
  EXPECT_TRUE(message) << message.error().message;
  return message ? message->frame() : v1::LayerFrame();
}

void seal(v1::LayerFrame& frame) {
  frame.set_crc32c(
      core::crc32c({reinterpret_cast<const std::uint8_t*>(frame.payload().data()), frame.payload().size()}));
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

const std::vector<std::uint32_t> kTwoBoats = {1,
                                              1'500,
                                              static_cast<std::uint32_t>(-20),
                                              static_cast<std::uint32_t>(-2'250),
                                              0x0000'4000u,
                                              0x0000'0000u,
                                              0u,  //
                                              9,
                                              0,
                                              0,
                                              0,
                                              0x7FFF'8001u,
                                              0xFF38'C000u,
                                              0x0000'7F81u};

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

struct DamagedFrame {
  const char* name;
  void (*damage)(v1::LayerFrame&);
  const char* must_hold;
  bool reseal = true;
};

template <typename Decode>
void expectRefusals(const v1::LayerFrame& good, const std::vector<DamagedFrame>& cases, Decode decode) {
  ASSERT_TRUE(decode(good));
  for (const DamagedFrame& bad : cases) {
    v1::LayerFrame frame = good;
    bad.damage(frame);
    if (bad.reseal) seal(frame);
    const auto result = decode(frame);
    ASSERT_FALSE(result) << bad.name;
    EXPECT_EQ(result.error().code, core::ErrorCode::kInvalidInput) << bad.name;
    EXPECT_THAT(result.error().message, HasSubstr(bad.must_hold)) << bad.name;
  }
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

}  // namespace
}  // namespace spindrift::codec
