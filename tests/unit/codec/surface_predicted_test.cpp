// The packed surface: the same samples as the plain one to the bit, in fewer bytes, also after lost or damaged frames.
#include <cmath>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/codec/frame_decoder.h>
#include <spindrift/codec/frame_encoder.h>

#include "damaged_frames.h"

namespace spindrift::codec {
namespace {

using testing::HasSubstr;

constexpr Stream kPacked{v1::LAYER_SURFACE, v1::PACKING_PACKED};

/// A square of samples, any size, as the GPU packs them.
struct Surface {
  std::uint32_t n;
  std::vector<std::uint32_t> words;

  template <typename SampleAt>
  Surface(std::uint32_t resolution_count, SampleAt sample_at) : n(resolution_count), words(n * n / 2) {
    for (std::uint32_t i = 0; i < n * n; ++i) {
      const auto sample = static_cast<std::uint16_t>(static_cast<std::int16_t>(sample_at(i % n, i / n)));
      words[i / 2] |= static_cast<std::uint32_t>(sample) << (16 * (i % 2));
    }
  }
  [[nodiscard]] core::FrameView view(std::uint64_t tick) const {
    core::FrameView view;
    view.tick = tick;
    view.time_s = static_cast<double>(tick) / 60.0;
    view.at(core::Level::kFull).surface = core::SurfaceView{{n, n}, 16.0, 16.0, 0.001, words};
    return view;
  }
};

/// Two standing waves at a tick, in quanta.
Surface waves(std::uint32_t n, std::uint64_t tick) {
  const double t = static_cast<double>(tick) / 60.0;
  return {n, [&](std::uint32_t x, std::uint32_t z) {
            const double u = 6.283 * x / n, w = 6.283 * z / n;
            return std::lround(300 * std::cos(2 * u) * std::cos(w) * std::cos(3 * t) + 80 * std::sin(5 * w + 4 * t));
          }};
}

/// The samples that the plain codec sends.
std::vector<float> plainOf(const Surface& surface) {
  const auto samples = decodeSurface(frameOf(FrameEncoder().encode(v1::LAYER_SURFACE, surface.view(1))));
  EXPECT_TRUE(samples);
  return samples ? samples->elevation_m : std::vector<float>();
}

TEST(SurfacePredicted, IsThePlainSurfaceToTheBitFrameAfterFrame) {
  for (const std::uint32_t n : {2u, 6u, 16u, 30u, 64u}) {
    FrameEncoder encoder;
    PackedSurfaceDecoder decoder;
    for (std::uint64_t tick = 10; tick < 30; tick += 2) {
      const Surface surface = waves(n, tick);
      const EncodedFrame encoded = encoder.encode(kPacked, surface.view(tick), core::Level::kFull, tick == 10);
      ASSERT_EQ(encoded.keyframe != nullptr, tick == 10);
      ASSERT_EQ(encoded.delta != nullptr, tick != 10);
      const v1::LayerFrame frame = frameOf(encoded.keyframe ? encoded.keyframe : encoded.delta);
      EXPECT_EQ(frame.keyframe(), tick == 10);
      if (tick > 10) {
        EXPECT_EQ(frame.base_tick(), tick - 2);
      }
      const auto samples = decoder.decode(frame);
      ASSERT_TRUE(samples) << samples.error().message;
      EXPECT_EQ(samples->count.x, n);
      EXPECT_EQ(samples->length_m, 16.0);
      EXPECT_EQ(samples->elevation_m, plainOf(surface)) << n << " samples per side, tick " << tick;
    }
  }
}

TEST(SurfacePredicted, RoundTripsAnythingThatFitsInto16Bits) {
  std::mt19937 random(1);
  const auto wild = [&](std::uint32_t, std::uint32_t) { return static_cast<std::int16_t>(random()); };
  const auto ends = [](std::uint32_t x, std::uint32_t z) { return (x + z) % 2 != 0 ? -32768 : 32767; };
  const auto spike = [](std::uint32_t x, std::uint32_t z) { return x == 7 && z == 9 ? 30000 : 0; };
  FrameEncoder encoder;
  PackedSurfaceDecoder decoder;
  std::uint64_t tick = 0;
  for (const Surface& surface : {Surface(32, wild), Surface(32, ends), Surface(32, spike), Surface(32, wild)}) {
    const EncodedFrame encoded = encoder.encode(kPacked, surface.view(++tick), core::Level::kFull, false);
    const auto samples = decoder.decode(frameOf(tick == 1 ? encoded.keyframe : encoded.delta));
    ASSERT_TRUE(samples) << samples.error().message;
    EXPECT_EQ(samples->elevation_m, plainOf(surface)) << "surface " << tick;
  }
}

TEST(SurfacePredicted, TakesAFractionOfThePlainBytes) {
  FrameEncoder encoder;
  std::size_t packed_bytes = 0, whole_bytes = 0, plain_bytes = 0;
  for (std::uint64_t tick = 10; tick < 60; tick += 2) {
    const Surface surface = waves(128, tick);
    const EncodedFrame encoded = encoder.encode(kPacked, surface.view(tick), core::Level::kFull, true);
    whole_bytes += encoded.keyframe->size();
    if (encoded.delta) {
      packed_bytes += encoded.delta->size();
      plain_bytes += encoder.encode(v1::LAYER_SURFACE, surface.view(tick))->size();
    }
  }
  EXPECT_LT(8 * packed_bytes, plain_bytes) << "2 bits per sample are left over by rounding";
  EXPECT_LT(2 * whole_bytes, plain_bytes) << "two frames in each";
  const Surface still(128, [](std::uint32_t, std::uint32_t) { return 0; });
  (void)encoder.encode(kPacked, still.view(100), core::Level::kFull, false);
  (void)encoder.encode(kPacked, still.view(102), core::Level::kFull, false);
  EXPECT_LT(encoder.encode(kPacked, still.view(104), core::Level::kFull, false).delta->size(), 150u) << "nothing moves";
}

TEST(SurfacePredicted, AKeyframeLetsALateReaderDecodeTheDeltasAfterIt) {
  FrameEncoder encoder;
  PackedSurfaceDecoder early, late;
  for (std::uint64_t tick = 10; tick < 40; tick += 2) {
    const Surface surface = waves(48, tick);
    const EncodedFrame encoded =
        encoder.encode(kPacked, surface.view(tick), core::Level::kFull, tick == 10 || tick == 20);
    ASSERT_TRUE(early.decode(frameOf(tick == 10 ? encoded.keyframe : encoded.delta)));
    if (tick < 20) continue;
    const auto samples = late.decode(frameOf(tick == 20 ? encoded.keyframe : encoded.delta));
    ASSERT_TRUE(samples) << samples.error().message;
    EXPECT_EQ(samples->elevation_m, plainOf(surface)) << "tick " << tick;
  }
}

TEST(SurfacePredicted, BeginsAgainWhenTheGridChanges) {
  FrameEncoder encoder;
  EXPECT_TRUE(encoder.encode(kPacked, waves(32, 1).view(1), core::Level::kFull, false).keyframe);
  EXPECT_FALSE(encoder.encode(kPacked, waves(32, 3).view(3), core::Level::kFull, false).keyframe);
  const EncodedFrame other = encoder.encode(kPacked, waves(48, 5).view(5), core::Level::kFull, false);
  EXPECT_TRUE(other.keyframe);
  EXPECT_FALSE(other.delta);
}

TEST(SurfacePredicted, ReportsAMissingBaseUntilAKeyframeComes) {
  FrameEncoder encoder;
  PackedSurfaceDecoder decoder;
  std::vector<EncodedFrame> encoded;
  for (std::uint64_t tick = 1; tick < 6; ++tick)
    encoded.push_back(encoder.encode(kPacked, waves(32, tick).view(tick), core::Level::kFull, true));
  const auto expectMissing = [&](const core::SharedBytes& bytes) {
    const auto samples = decoder.decode(frameOf(bytes));
    ASSERT_FALSE(samples);
    EXPECT_EQ(samples.error().code, core::ErrorCode::kUnavailable);
    EXPECT_THAT(samples.error().message, HasSubstr("subscribe again"));
  };
  expectMissing(encoded[1].delta);
  EXPECT_TRUE(decoder.decode(frameOf(encoded[1].keyframe)));
  expectMissing(encoded[3].delta);
  expectMissing(encoded[2].delta);
  EXPECT_TRUE(decoder.decode(frameOf(encoded[3].keyframe)));
  EXPECT_TRUE(decoder.decode(frameOf(encoded[4].delta)));
}

TEST(FoamPredicted, IsThePlainFoamToTheByte) {
  FrameEncoder encoder;
  PackedFoamDecoder decoder;
  std::mt19937 random(4);
  std::size_t packed_bytes = 0;
  for (std::uint64_t tick = 1; tick < 12; ++tick) {
    std::vector<std::uint32_t> words(32 * 32 / 4, 0u);
    for (std::size_t i = 0; i < 40; ++i)
      words[i] = tick == 5 ? static_cast<std::uint32_t>(random()) : 0xFFF0'A050u >> tick;
    core::FrameView view;
    view.tick = tick;
    view.at(core::Level::kFull).foam = core::FoamView{{32, 32}, 16.0, 16.0, words};
    const EncodedFrame encoded =
        encoder.encode({v1::LAYER_FOAM, v1::PACKING_PACKED}, view, core::Level::kFull, tick == 1);
    const core::SharedBytes& bytes = encoded.delta ? encoded.delta : encoded.keyframe;
    packed_bytes += bytes->size();
    const auto packed = decoder.decode(frameOf(bytes));
    ASSERT_TRUE(packed) << packed.error().message;
    const auto plain = decodeFoam(frameOf(encoder.encode(v1::LAYER_FOAM, view)));
    ASSERT_TRUE(plain);
    EXPECT_EQ(packed->foam, plain->foam) << "tick " << tick;
    EXPECT_EQ(packed->length_m, 16.0);
  }
  EXPECT_LT(packed_bytes, 11u * 32 * 32 / 2);
  PackedFoamDecoder late;
  core::FrameView view;
  const std::vector<std::uint32_t> words(32 * 32 / 4, 0u);
  view.at(core::Level::kFull).foam = core::FoamView{{32, 32}, 16.0, 16.0, words};
  const auto missing =
      late.decode(frameOf(encoder.encode({v1::LAYER_FOAM, v1::PACKING_PACKED}, view, core::Level::kFull, false).delta));
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, core::ErrorCode::kUnavailable);
}

TEST(SurfacePredicted, RefusesDamagedFrames) {
  FrameEncoder encoder;
  const v1::LayerFrame good = frameOf(encoder.encode(kPacked, waves(32, 1).view(1), core::Level::kFull, true).keyframe);
  static const double nan = std::numeric_limits<double>::quiet_NaN();
  expectRefusals(
      good,
      {
          {"layer", [](v1::LayerFrame& f) { f.set_layer(v1::LAYER_FOAM); }, "LAYER_SURFACE"},
          {"codec", [](v1::LayerFrame& f) { f.mutable_foam_fixed8(); }, "codec"},
          {"time", [](v1::LayerFrame& f) { f.set_time_s(nan); }, "time_s"},
          {"resolution 0", [](v1::LayerFrame& f) { f.mutable_surface_predicted()->set_resolution_count(0); }, "4096"},
          {"resolution max", [](v1::LayerFrame& f) { f.mutable_surface_predicted()->set_resolution_count(~0u); },
           "4096"},
          {"resolution 33", [](v1::LayerFrame& f) { f.mutable_surface_predicted()->set_resolution_count(33); },
           "payload"},
          {"side", [](v1::LayerFrame& f) { f.mutable_surface_predicted()->set_side_m(nan); }, "side_m"},
          {"quantum", [](v1::LayerFrame& f) { f.mutable_surface_predicted()->set_quantum_m(0); }, "quantum_m"},
          {"weights", [](v1::LayerFrame& f) { f.mutable_surface_predicted()->add_weights(1); }, "weights"},
          {"no weights", [](v1::LayerFrame& f) { f.mutable_surface_predicted()->clear_earlier_weights(); },
           "earlier_weights"},
          {"empty", [](v1::LayerFrame& f) { f.clear_payload(); }, "payload"},
          {"cut", [](v1::LayerFrame& f) { f.mutable_payload()->resize(f.payload().size() / 2); }, "payload"},
          {"longer", [](v1::LayerFrame& f) { f.mutable_payload()->push_back(1); }, "payload"},
          {"altered", [](v1::LayerFrame& f) { (*f.mutable_payload())[3] ^= 0x7F; }, "payload"},
          {"flipped", [](v1::LayerFrame& f) { (*f.mutable_payload())[40] ^= 1; }, "crc32c", false},
      },
      [](const v1::LayerFrame& frame) { return PackedSurfaceDecoder().decode(frame); });
}

TEST(SurfacePredicted, ReadsAnyBytesWithoutHarm) {
  FrameEncoder encoder;
  const v1::LayerFrame good = frameOf(encoder.encode(kPacked, waves(32, 1).view(1), core::Level::kFull, true).keyframe);
  std::mt19937 random(7);
  int accepted_count = 0;
  for (int k = 0; k < 3000; ++k) {
    const v1::LayerFrame frame = scrambled(good, random, [&](v1::LayerFrame& f) {
      f.mutable_surface_predicted()->set_weights(3, static_cast<std::int32_t>(random()));
    });
    PackedSurfaceDecoder decoder;
    accepted_count += decoder.decode(frame) ? 1 : 0;
  }
  EXPECT_LT(accepted_count, 300) << "most damage leaves the stream at a wrong end or with another sum";
}

}  // namespace
}  // namespace spindrift::codec
