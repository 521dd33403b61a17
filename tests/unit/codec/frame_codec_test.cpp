#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/codec/frame_decoder.h>
#include <spindrift/codec/frame_encoder.h>

#include "damaged_frames.h"

namespace spindrift::codec {
namespace {

using testing::HasSubstr;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A frame with an 8 x 8 surface, two particles and diagnostics, together with its words.
struct TestFrame {
  std::vector<std::uint32_t> surface_words;
  std::vector<std::uint32_t> particle_words;
  core::FrameView view;

  TestFrame() {
    for (std::int32_t i = 0; i < 64; i += 2) surface_words.push_back(pack(sample(i), sample(i + 1)));
    particle_words = {0xFFFF'0000u, 0x817F'8000u, 0x00FF'0740u, 0x0000'FFFFu, 0x0000'0000u, 0x0000'FF00u};
    view.tick = 600;
    view.time_s = 10.0;
    view.at(core::Level::kFull).surface = core::SurfaceView{{8, 8}, 16.0, 16.0, 0.001, surface_words};
    core::ParticleView particles;
    particles.count = 2;
    for (int axis = 0; axis < 3; ++axis) {
      particles.min_m[axis] = -1.0 - axis;
      particles.max_m[axis] = 2.0 + axis;
    }
    particles.max_speed_mps = 9.0;
    particles.radius_m = 0.05;
    particles.words = particle_words;
    view.at(core::Level::kFull).particles = particles;
    core::DiagnosticsView diagnostics;
    diagnostics.step_ms = 6.5;
    diagnostics.passes = {{"grid", 1.5}, {"sph", 5.0}};
    view.diagnostics = diagnostics;
  }
  TestFrame(const TestFrame&) = delete;
  TestFrame& operator=(const TestFrame&) = delete;

  /// Both signs and both ends of int16.
  static std::int16_t sample(std::int32_t i) {
    return static_cast<std::int16_t>(i == 0 ? -32768 : i == 1 ? 32767 : (i - 32) * 100);
  }
  static std::uint32_t pack(std::int16_t low, std::int16_t high) {
    return static_cast<std::uint16_t>(low) | static_cast<std::uint32_t>(static_cast<std::uint16_t>(high)) << 16;
  }
};

std::string textOf(const core::SharedBytes& bytes) {
  return {bytes->begin(), bytes->end()};
}

v1::LayerFrame surfaceFrame() {
  return frameOf(FrameEncoder().encode(v1::LAYER_SURFACE, TestFrame().view));
}
v1::LayerFrame particleFrame() {
  return frameOf(FrameEncoder().encode(v1::LAYER_PARTICLES, TestFrame().view));
}

TEST(FrameEncoding, RoundTripsTheSurfaceExactlyToTheQuantum) {
  const v1::LayerFrame frame = surfaceFrame();
  EXPECT_EQ(frame.layer(), v1::LAYER_SURFACE);
  EXPECT_EQ(frame.tick(), 600u);
  EXPECT_EQ(frame.time_s(), 10.0);
  EXPECT_TRUE(frame.keyframe());
  const auto samples = decodeSurface(frame);
  ASSERT_TRUE(samples) << samples.error().message;
  EXPECT_EQ(samples->count.x, 8u);
  EXPECT_EQ(samples->length_m, 16.0);
  EXPECT_EQ(samples->quantum_m, 0.001);
  ASSERT_EQ(samples->elevation_m.size(), 64u);
  for (int i = 0; i < 64; ++i) {
    EXPECT_EQ(samples->elevation_m[static_cast<std::size_t>(i)], static_cast<float>(TestFrame::sample(i) * 0.001));
  }
}

TEST(FrameEncoding, RoundTripsParticles) {
  const auto samples = decodeParticles(particleFrame());
  ASSERT_TRUE(samples) << samples.error().message;
  EXPECT_EQ(samples->count, 2u);
  EXPECT_EQ(samples->radius_m, 0.05);
  // Particle 0: x at its minimum, z at its maximum, y half-way (0x8000 of 65535); velocity +127, -127, +64.
  EXPECT_FLOAT_EQ(samples->position_m[0], -1.0f);
  EXPECT_FLOAT_EQ(samples->position_m[1], static_cast<float>(-2.0 + 32768.0 / 65535.0 * 5.0));
  EXPECT_FLOAT_EQ(samples->position_m[2], 4.0f);
  EXPECT_FLOAT_EQ(samples->velocity_mps[0], 9.0f);
  EXPECT_FLOAT_EQ(samples->velocity_mps[1], -9.0f);
  EXPECT_FLOAT_EQ(samples->velocity_mps[2], static_cast<float>(64.0 / 127.0 * 9.0));
  EXPECT_EQ(samples->tint[0], 7);
  EXPECT_EQ(samples->foam[0], 255);
  // Particle 1: x at its maximum, the rest at the minimum, at rest.
  EXPECT_FLOAT_EQ(samples->position_m[3], 2.0f);
  EXPECT_FLOAT_EQ(samples->position_m[4], -2.0f);
  EXPECT_FLOAT_EQ(samples->position_m[5], -3.0f);
  EXPECT_EQ(samples->velocity_mps[3], 0.0f);
  EXPECT_EQ(samples->tint[1], 255);
  EXPECT_EQ(samples->foam[1], 0);
}

TEST(FrameEncoding, WritesTheBytesThatProtobufWouldWrite) {
  const TestFrame test;
  v1::ServerMessage expected;
  v1::LayerFrame& frame = *expected.mutable_frame();
  frame.set_layer(v1::LAYER_SURFACE);
  frame.set_tick(600);
  frame.set_time_s(10.0);
  frame.set_keyframe(true);
  frame.mutable_surface_fixed16()->set_resolution_count(8);
  frame.mutable_surface_fixed16()->set_side_m(16.0);
  frame.mutable_surface_fixed16()->set_quantum_m(0.001);
  frame.set_payload(test.surface_words.data(), test.surface_words.size() * sizeof(std::uint32_t));
  seal(frame);
  EXPECT_EQ(textOf(FrameEncoder().encode(v1::LAYER_SURFACE, test.view)), expected.SerializeAsString());
}

TEST(FrameEncoding, HandlesAFrameWithoutParticles) {
  TestFrame test;
  test.view.at(core::Level::kFull).particles->count = 0;
  test.view.at(core::Level::kFull).particles->words = {};
  const auto samples = decodeParticles(frameOf(FrameEncoder().encode(v1::LAYER_PARTICLES, test.view)));
  ASSERT_TRUE(samples) << samples.error().message;
  EXPECT_EQ(samples->count, 0u);
  EXPECT_TRUE(samples->position_m.empty());
}

TEST(FrameEncoding, HandlesAFrameOfTheLargestScene) {
  TestFrame test;
  test.surface_words.assign(1024 * 1024 / 2, 0x1234'5678u);
  test.view.at(core::Level::kFull).surface = core::SurfaceView{{1024, 1024}, 16.0, 16.0, 0.001, test.surface_words};
  const auto samples = decodeSurface(frameOf(FrameEncoder().encode(v1::LAYER_SURFACE, test.view)));
  ASSERT_TRUE(samples) << samples.error().message;
  EXPECT_EQ(samples->elevation_m.size(), 1024u * 1024u);
  EXPECT_EQ(samples->elevation_m.back(), static_cast<float>(0x1234 * 0.001));
}

TEST(FrameEncoding, KeepsNoReferenceToTheFramesMemory) {
  TestFrame test;
  const core::SharedBytes bytes = FrameEncoder().encode(v1::LAYER_PARTICLES, test.view);
  const std::string before = textOf(bytes);
  test.particle_words.assign(test.particle_words.size(), 0u);
  EXPECT_EQ(textOf(bytes), before);
  EXPECT_TRUE(decodeParticles(frameOf(bytes)));
}

TEST(FrameEncoding, CarriesDiagnostics) {
  const auto message = parseServerMessage(*FrameEncoder().encode(v1::LAYER_DIAGNOSTICS, TestFrame().view));
  ASSERT_TRUE(message) << message.error().message;
  EXPECT_EQ(message->diagnostics().tick(), 600u);
  EXPECT_EQ(message->diagnostics().step_ms(), 6.5);
  ASSERT_EQ(message->diagnostics().passes_size(), 2);
  EXPECT_EQ(message->diagnostics().passes(1).name(), "sph");
}

TEST(FrameEncoding, MissingLayerGivesNull) {
  FrameEncoder encoder;
  const core::FrameView empty;
  for (const v1::Layer layer : {v1::LAYER_SURFACE, v1::LAYER_PARTICLES, v1::LAYER_DIAGNOSTICS, v1::LAYER_BODIES})
    EXPECT_EQ(encoder.encode(layer, empty), nullptr);
  EXPECT_EQ(encoder.encode(v1::LAYER_FOAM, TestFrame().view), nullptr) << "the frame has none";
  EXPECT_EQ(encoder.encode(v1::LAYER_UNSPECIFIED, TestFrame().view), nullptr) << "no codec for it";
}

TEST(FrameEncoding, EachLevelIsEncodedSeparatelyWithItsLevel) {
  const TestFrame test;
  constexpr Stream kPacked{v1::LAYER_SURFACE, v1::PACKING_PACKED};
  const std::vector<std::uint32_t> small(32, 0x00010002U);
  FrameEncoder encoder;
  PackedSurfaceDecoder full_reader, coarse_reader;
  for (std::uint64_t tick = 1; tick <= 6; ++tick) {
    core::FrameView frame = test.view;
    frame.tick = tick;
    frame.reduced_counts.planes = 1;
    frame.at(core::Level::kCoarse).surface = core::SurfaceView{{8, 8}, 2.0, 2.0, 0.001, small};
    const EncodedFrame full = encoder.encode(kPacked, frame, core::Level::kFull, tick == 1);
    ASSERT_TRUE(full.keyframe || full.delta);
    const v1::LayerFrame sent = frameOf(tick == 1 ? full.keyframe : full.delta);
    EXPECT_EQ(sent.level(), v1::LEVEL_FULL);
    const auto samples = full_reader.decode(sent);
    ASSERT_TRUE(samples) << samples.error().message;
    EXPECT_EQ(samples->count.x, test.view.at(core::Level::kFull).surface->count.x);
    if (tick % 3 == 2) continue;  // sometimes the frame has a coarse level
    const EncodedFrame coarse = encoder.encode(kPacked, frame, core::Level::kCoarse, tick == 1);
    const v1::LayerFrame sent_coarse = frameOf(tick == 1 ? coarse.keyframe : coarse.delta);
    EXPECT_EQ(sent_coarse.level(), v1::LEVEL_COARSE);
    const auto coarse_samples = coarse_reader.decode(sent_coarse);
    ASSERT_TRUE(coarse_samples) << coarse_samples.error().message;
    EXPECT_EQ(coarse_samples->count.x, 8u);
  }
  EXPECT_FALSE(encoder.encode(kPacked, test.view, core::Level::kMedium, true).keyframe) << "not in the frame";
}

TEST(FrameEncoding, LayerWithoutLevelsIsEncodedAtFullOnly) {
  TestFrame test;
  const std::vector<std::uint32_t> boat(7);
  test.view.bodies = core::BodiesView{1, boat};
  FrameEncoder encoder;
  for (const v1::Layer layer : {v1::LAYER_BODIES, v1::LAYER_DIAGNOSTICS}) {
    for (const core::Level level : core::kLevels) {
      EXPECT_EQ(encoder.encode({layer}, test.view, level, true).keyframe != nullptr, level == core::Level::kFull)
          << v1::Layer_Name(layer) << " at " << nameOf(level);
    }
  }
}

TEST(FrameDecoding, RefusesDamagedSurfaces) {
  expectRefusals(
      surfaceFrame(),
      {
          {"layer", [](v1::LayerFrame& f) { f.set_layer(v1::LAYER_FOAM); }, "LAYER_SURFACE"},
          {"codec", [](v1::LayerFrame& f) { f.mutable_particles_fixed12(); }, "codec"},
          {"no codec", [](v1::LayerFrame& f) { f.clear_codec(); }, "codec"},
          {"not whole", [](v1::LayerFrame& f) { f.set_keyframe(false); }, "keyframe"},
          {"time", [](v1::LayerFrame& f) { f.set_time_s(kNaN); }, "time_s"},
          {"resolution 0", [](v1::LayerFrame& f) { f.mutable_surface_fixed16()->set_resolution_count(0); },
           "resolution_count"},
          {"resolution 4097", [](v1::LayerFrame& f) { f.mutable_surface_fixed16()->set_resolution_count(4097); },
           "4096"},
          {"resolution max", [](v1::LayerFrame& f) { f.mutable_surface_fixed16()->set_resolution_count(~0u); }, "4096"},
          {"resolution 9", [](v1::LayerFrame& f) { f.mutable_surface_fixed16()->set_resolution_count(9); }, "payload"},
          {"side", [](v1::LayerFrame& f) { f.mutable_surface_fixed16()->set_side_m(-16); }, "side_m"},
          {"side NaN", [](v1::LayerFrame& f) { f.mutable_surface_fixed16()->set_side_m(kNaN); }, "side_m"},
          {"quantum 0", [](v1::LayerFrame& f) { f.mutable_surface_fixed16()->set_quantum_m(0); }, "quantum_m"},
          {"quantum huge", [](v1::LayerFrame& f) { f.mutable_surface_fixed16()->set_quantum_m(1e300); }, "quantum_m"},
          {"payload short", [](v1::LayerFrame& f) { f.mutable_payload()->pop_back(); }, "127 bytes"},
          {"payload long", [](v1::LayerFrame& f) { f.mutable_payload()->push_back(0); }, "129 bytes"},
          {"payload flipped", [](v1::LayerFrame& f) { (*f.mutable_payload())[40] ^= 1; }, "crc32c", false},
          {"checksum", [](v1::LayerFrame& f) { f.set_crc32c(f.crc32c() + 1); }, "crc32c", false},
      },
      [](const v1::LayerFrame& frame) { return decodeSurface(frame); });
}

TEST(FrameDecoding, RefusesDamagedParticles) {
  expectRefusals(
      particleFrame(),
      {
          {"layer", [](v1::LayerFrame& f) { f.set_layer(v1::LAYER_SURFACE); }, "LAYER_PARTICLES"},
          {"codec", [](v1::LayerFrame& f) { f.mutable_surface_fixed16(); }, "codec"},
          {"not whole", [](v1::LayerFrame& f) { f.set_keyframe(false); }, "keyframe"},
          {"count 3", [](v1::LayerFrame& f) { f.mutable_particles_fixed12()->set_count(3); }, "calls for 36"},
          {"count over", [](v1::LayerFrame& f) { f.mutable_particles_fixed12()->set_count(kParticleMaxCount + 1); },
           "4194304"},
          // 12 * count would wrap to the payload's 24 bytes in 32 bits.
          {"count wraps", [](v1::LayerFrame& f) { f.mutable_particles_fixed12()->set_count(0x4000'0002u); }, "count"},
          {"min NaN", [](v1::LayerFrame& f) { f.mutable_particles_fixed12()->set_min_y_m(kNaN); }, "min_y_m"},
          {"max below min", [](v1::LayerFrame& f) { f.mutable_particles_fixed12()->set_max_z_m(-5); }, "max_z_m"},
          {"max huge", [](v1::LayerFrame& f) { f.mutable_particles_fixed12()->set_max_x_m(1e308); }, "max_x_m"},
          {"speed", [](v1::LayerFrame& f) { f.mutable_particles_fixed12()->set_max_speed_mps(-1); }, "max_speed_mps"},
          {"radius", [](v1::LayerFrame& f) { f.mutable_particles_fixed12()->set_radius_m(kNaN); }, "radius_m"},
          {"payload short", [](v1::LayerFrame& f) { f.mutable_payload()->resize(23); }, "23 bytes"},
          {"payload flipped", [](v1::LayerFrame& f) { (*f.mutable_payload())[7] ^= 4; }, "crc32c", false},
      },
      [](const v1::LayerFrame& frame) { return decodeParticles(frame); });
}

TEST(FrameDecoding, RefusesBytesThatAreNoServerMessage) {
  EXPECT_FALSE(parseServerMessage({}));
  const core::Bytes cut = [] {
    core::Bytes bytes = *FrameEncoder().encode(v1::LAYER_SURFACE, TestFrame().view);
    bytes.resize(bytes.size() - 1);
    return bytes;
  }();
  EXPECT_FALSE(parseServerMessage(cut));
}

}  // namespace
}  // namespace spindrift::codec
