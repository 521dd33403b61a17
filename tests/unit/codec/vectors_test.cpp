// The encoder's loops exist twice, plain and with vectors: both must write the same bytes for all frames.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <spindrift/codec/frame_encoder.h>

#include "encode/processor.h"

namespace spindrift::codec {
namespace {

/// Uses plain loops until its destruction.
class PlainLoops {
 public:
  PlainLoops() { useVectors(false); }
  PlainLoops(const PlainLoops&) = delete;
  PlainLoops& operator=(const PlainLoops&) = delete;
  ~PlainLoops() { useVectors(true); }
};

struct Frames {
  std::vector<std::vector<std::uint32_t>> words;
  std::vector<core::FrameView> views;
};

std::vector<core::Bytes> encoded(const Frames& frames, v1::Layer layer) {
  FrameEncoder encoder;
  std::vector<core::Bytes> out;
  for (const core::FrameView& view : frames.views) {
    const EncodedFrame frame =
        encoder.encode({layer, v1::PACKING_PACKED}, view, core::Level::kFull, view.tick % 3 == 0);
    for (const core::SharedBytes& bytes : {frame.keyframe, frame.delta}) out.push_back(bytes ? *bytes : core::Bytes());
  }
  return out;
}

void expectSameBytes(const Frames& frames, v1::Layer layer) {
  useVectors(true);
  if (!usesVectors()) GTEST_SKIP() << "this processor has no AVX2";
  const std::vector<core::Bytes> with_vectors = encoded(frames, layer);
  const PlainLoops plain;
  ASSERT_FALSE(usesVectors());
  EXPECT_EQ(encoded(frames, layer), with_vectors);
}

/// Waves of a given amplitude with noise. Beyond 8191 quanta, sums of four samples exceed 16 bits.
Frames surfaces(std::uint32_t n, double amplitude, int noise) {
  Frames out;
  std::mt19937 random(n);
  for (std::uint64_t tick = 1; tick <= 5; ++tick) {
    auto& words = out.words.emplace_back(n * n / 2);
    for (std::uint32_t i = 0; i < n * n; ++i) {
      const double wave =
          amplitude * std::sin(0.2 * (i % n) + 0.1 * static_cast<double>(tick)) * std::cos(0.15 * (i / n));
      const long shaken =
          std::lround(wave) + static_cast<long>(random() % (2 * static_cast<unsigned>(noise) + 1)) - noise;
      words[i / 2] |= static_cast<std::uint32_t>(static_cast<std::uint16_t>(std::clamp(shaken, -32768l, 32767l)))
                      << (16 * (i % 2));
    }
  }
  for (std::uint64_t tick = 1; tick <= 5; ++tick) {
    auto& view = out.views.emplace_back();
    view.tick = tick;
    view.at(core::Level::kFull).surface = core::SurfaceView{{n, n}, 16.0, 16.0, 0.001, out.words[tick - 1]};
  }
  return out;
}

/// Frames with `counts` particles each, `crowded` of them in one spot.
Frames clouds(std::initializer_list<std::uint32_t> counts, double side_m, std::uint32_t crowded, std::uint32_t speeds) {
  Frames out;
  std::mt19937 random(5);
  for (const std::uint32_t count : counts) {
    auto& words = out.words.emplace_back();
    for (std::uint32_t i = 0; i < count; ++i) {
      const bool is_crowded = i < crowded;
      const auto velocity = [&] { return static_cast<std::uint32_t>(random() % (2 * speeds + 1) - speeds) & 0xffu; };
      words.push_back(is_crowded ? 0x12341234u : static_cast<std::uint32_t>(random()));
      words.push_back((is_crowded ? 0x1234u : static_cast<std::uint32_t>(random() & 0xffffu)) | velocity() << 16 |
                      velocity() << 24);
      words.push_back(velocity() | static_cast<std::uint32_t>(random() & 0xffffu) << 8);
    }
  }
  for (std::size_t k = 0; k < out.words.size(); ++k) {
    auto& view = out.views.emplace_back();
    view.tick = k + 1;
    view.at(core::Level::kFull).particles =
        core::ParticleView{.count = static_cast<std::uint32_t>(out.words[k].size() / 3),
                           .min_m = {0, 0, 0},
                           .max_m = {side_m, side_m / 2, side_m},
                           .max_speed_mps = 8.0,
                           .radius_m = 0.05,
                           .words = out.words[k]};
  }
  return out;
}

TEST(PlainLoopsAndVectors, WriteTheSameSurfaces) {
  for (const std::uint32_t n : {2u, 16u, 18u, 46u, 64u}) {
    SCOPED_TRACE(n);
    for (const double amplitude : {0.0, 3.0, 400.0, 8180.0, 9000.0, 40000.0}) {
      for (const int noise : {0, 1, 5, 300}) expectSameBytes(surfaces(n, amplitude, noise), v1::LAYER_SURFACE);
    }
  }
}

TEST(PlainLoopsAndVectors, WriteTheSameParticles) {
  for (const double side_m : {1.0, 4.0, 30.0}) {
    for (const std::uint32_t speeds : {0u, 2u, 20u, 127u}) {
      SCOPED_TRACE(testing::Message() << side_m << " m, speeds " << speeds);
      expectSameBytes(clouds({1, 7, 64, 65, 1000, 4099, 3}, side_m, 0, speeds), v1::LAYER_PARTICLES);
      expectSameBytes(clouds({500, 5000, 5000}, side_m, 200, speeds), v1::LAYER_PARTICLES);
    }
  }
}

TEST(PackedParticles, AreTheSameAfterAFrameThatOverfilledACell) {
  const Frames one = clouds({5000, 5000}, 4.0, 0, 9);
  Frames two = clouds({5000, 5000}, 4.0, 0, 9);
  Frames crowded = clouds({5000}, 4.0, 700, 9), spread = clouds({5000}, 4.0, 250, 9);
  // The spot is one eighth of a cell. In one frame it alone exceeds a byte's count, in another only with its
  // neighbours.
  for (Frames* full : {&crowded, &spread}) two.views.insert(two.views.begin() + 1, full->views.front());
  two.views.back().tick = one.views.back().tick;
  EXPECT_EQ(encoded(two, v1::LAYER_PARTICLES).end()[-2], encoded(one, v1::LAYER_PARTICLES).end()[-2]);
}

}  // namespace
}  // namespace spindrift::codec
