// Reads packed frames with tests/wire/packed_reader.py, which was written from the text of proto/README.md alone: it
// must read what the encoder writes, to the same values as the decoder here.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <random>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <spindrift/codec/frame_decoder.h>
#include <spindrift/codec/frame_encoder.h>

#include "temporary_folder.h"

namespace spindrift::codec {
namespace {

/// A folder of cases like tests/golden.
class Cases {
 public:
  /// `follows`: the file of the previous frame, or empty.
  std::string add(const core::Bytes& message, const std::string& follows, const std::string& values) {
    std::string file = std::to_string(count_++) + ".bin";
    folder_.write(file, std::string(message.begin(), message.end()));
    json_ += (json_.empty() ? "[\n" : ",\n") + std::string("{\"file\": \"") + file +
             "\", \"verdict\": \"ok\", \"kind\": \"frame\", \"follows\": \"" + follows + "\", " + values + "}";
    return file;
  }
  /// Returns the exit status of the reader over all cases; its messages go to standard output.
  int readOutside() {
    folder_.write("golden.json", json_ + "]\n");
    const std::string command =
        "python3 -B '" SPINDRIFT_SOURCE_DIR "/tests/wire/packed_reader.py' '" + folder_.path().string() + "'";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  test::TemporaryFolder folder_;
  std::string json_;
  int count_ = 0;
};

template <typename Values>
std::string list(const std::string& name, const Values& values) {
  std::string text = "\"" + name + "\": [";
  for (const auto value : values) {
    std::array<char, 40> number{};
    std::snprintf(number.data(), number.size(), "%s%.9g", text.back() == '[' ? "" : ", ", static_cast<double>(value));
    text += number.data();
  }
  return text + "]";
}

v1::LayerFrame frameOf(const core::Bytes& bytes) {
  return parseServerMessage(bytes)->frame();
}

TEST(OutsideReader, ReadsPlanesOfEverySizeOfResidual) {
  Cases cases;
  std::mt19937 random(1);
  // From a plane at rest to noise over all 16 bits; sides that are multiples of 8 and others.
  for (const int noise_bits : {0, 1, 2, 3, 5, 7, 9, 11, 13, 15, 16}) {
    const std::uint32_t n = noise_bits % 2 == 0 ? 24 : 18;
    FrameEncoder encoder;
    PackedSurfaceDecoder decoder;
    std::string follows;
    for (std::uint32_t step = 0; step < 4; ++step) {
      std::vector<std::uint32_t> words(n * n / 2);
      for (std::uint32_t i = 0; i < n * n; ++i) {
        const auto noise = static_cast<std::int32_t>(random() & ((1u << noise_bits) - 1)) - (1 << noise_bits) / 2;
        const auto value = static_cast<std::int16_t>(noise + static_cast<std::int32_t>(i % n * step));
        words[i / 2] |= static_cast<std::uint32_t>(static_cast<std::uint16_t>(value)) << (16 * (i % 2));
      }
      core::FrameView view;
      view.tick = 10 + step;
      view.at(core::Level::kFull).surface = core::SurfaceView{{n, n}, 8.0, 8.0, 0.0009765625, words};
      const EncodedFrame encoded =
          encoder.encode({v1::LAYER_SURFACE, v1::PACKING_PACKED}, view, core::Level::kFull, false);
      const core::Bytes& bytes = encoded.delta ? *encoded.delta : *encoded.keyframe;
      const auto samples = decoder.decode(frameOf(bytes));
      ASSERT_TRUE(samples) << samples.error().message;
      follows = cases.add(bytes, follows, list("elevation_m", samples->elevation_m));
    }
  }
  EXPECT_EQ(cases.readOutside(), 0);
}

TEST(OutsideReader, ReadsParticlesInCellsOfEverySize) {
  Cases cases;
  std::mt19937 random(2);
  struct Shape {
    std::uint32_t count;
    double length_m;  ///< along x; 4 m along the others
    double radius_m;
    std::uint32_t spread;  ///< of the 65536 positions along each axis
  };
  // Empty; one; a block of 64 and one more; crowded into one eighth; spread wide; so long that cells have fewer bits;
  // too many cells for any bits.
  std::vector<bool> seen_offset_bits(9);
  for (const Shape& shape :
       {Shape{0, 8, 0.1, 1}, Shape{1, 8, 0.1, 65536}, Shape{65, 8, 0.1, 3000}, Shape{700, 8, 0.1, 2},
        Shape{900, 8, 0.05, 65536}, Shape{400, 500, 0.05, 65536}, Shape{400, 900, 0.05, 65536},
        Shape{300, 1800, 0.05, 65536}, Shape{300, 90000, 0.05, 65536}}) {
    std::vector<std::uint32_t> words;
    for (std::uint32_t i = 0; i < shape.count; ++i) {
      const auto place = [&] { return static_cast<std::uint32_t>(random() % shape.spread); };
      const std::uint32_t x = place(), y = place(), z = place();
      words.push_back(x | z << 16);
      words.push_back(y | static_cast<std::uint32_t>(random() & 0xFFFFu) << 16);
      words.push_back(static_cast<std::uint32_t>(random() & 0xFFFFFFu));
    }
    core::ParticleView particles;
    particles.count = shape.count;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      particles.max_m[axis] = axis == 0 ? shape.length_m / 2 : 2;
      particles.min_m[axis] = -particles.max_m[axis];
    }
    particles.max_speed_mps = 12.0;
    particles.radius_m = shape.radius_m;
    particles.words = words;
    core::FrameView view;
    view.tick = 7;
    view.at(core::Level::kFull).particles = particles;
    const core::Bytes bytes =
        *FrameEncoder().encode({v1::LAYER_PARTICLES, v1::PACKING_PACKED}, view, core::Level::kFull, true).keyframe;
    const v1::LayerFrame frame = frameOf(bytes);
    seen_offset_bits[frame.particles_by_cell().offset_bits()] = true;
    const auto samples = decodePackedParticles(frame);
    ASSERT_TRUE(samples) << samples.error().message;
    (void)cases.add(bytes, "",
                    list("position_m", samples->position_m) + ", " + list("velocity_mps", samples->velocity_mps) +
                        ", " + list("tint", samples->tint) + ", " + list("foam", samples->foam));
  }
  EXPECT_EQ(cases.readOutside(), 0);
  EXPECT_GE(std::ranges::count(seen_offset_bits, true), 4) << "cells of several sizes were made";
}

TEST(OutsideReader, ReadsObjectsThatMoveComeAndGo) {
  Cases cases;
  std::mt19937 random(3);
  // From objects at rest to ones that are anywhere in each frame; 65 of them are a group and one more.
  for (const std::int32_t spread_mm : {0, 1, 30, 3000, 900'000}) {
    FrameEncoder encoder;
    PackedFloaterDecoder decoder;
    std::string follows;
    std::vector<std::uint32_t> words;
    std::uint32_t next_id = 1;
    for (std::uint64_t step = 0; step < 6; ++step) {
      if (step > 2) words.erase(words.begin() + 14, words.begin() + 21);
      while (words.size() < 7 * (step == 0 ? 65 : 70)) {
        words.insert(words.end(), {next_id, 5000u, 0u, 0u, 0u, 0x7FFF'0000u, 40u | (1 + next_id % 8) << 16});
        next_id += next_id % 9 == 0 ? 100'000 : 1;
      }
      for (std::size_t at = 0; at < words.size(); at += 7) {
        const auto shift = [&] {
          return static_cast<std::uint32_t>(static_cast<std::int32_t>(random() & 0x7FFFFFFFu) % (spread_mm + 1) -
                                            spread_mm / 2);
        };
        for (std::size_t axis = 1; axis <= 3; ++axis) words[at + axis] += shift();
        if (spread_mm == 0) continue;
        const auto parts = static_cast<std::uint32_t>(random());
        words[at + 4] = spread_mm > 1000 ? parts : 0x0100'0200u + (parts & 0x003F'003Fu);
        words[at + 6] ^= random() % 9 == 0 ? 1u << 24 : 0u;
      }
      core::FrameView view;
      view.tick = 10 + step;
      view.floaters = core::FloatersView{static_cast<std::uint32_t>(words.size() / 7), words};
      const core::Level level = spread_mm == 30 ? core::Level::kCoarse : core::Level::kFull;
      const EncodedFrame encoded = encoder.encode({v1::LAYER_FLOATERS, v1::PACKING_PACKED}, view, level, step == 4);
      const core::Bytes& bytes = encoded.delta && step != 4 ? *encoded.delta : *encoded.keyframe;
      const auto samples = decoder.decode(frameOf(bytes));
      ASSERT_TRUE(samples) << samples.error().message;
      std::string values = "\"floaters\": [";
      for (const FloaterSample& one : *samples) {
        values += (values.back() == '[' ? "{" : ", {") + ("\"floater_id\": " + std::to_string(one.floater_id)) + ", " +
                  list("position_m", one.position_m) + ", " + list("rotation", one.rotation) + ", \"kind\": \"" +
                  v1::FloaterKind_Name(one.kind) + "\", \"is_held\": " + (one.is_held ? "true" : "false") + "}";
      }
      follows = cases.add(bytes, encoded.delta && step != 4 ? follows : "", values + "]");
    }
  }
  EXPECT_EQ(cases.readOutside(), 0);
}

TEST(OutsideReader, ReportsDifferentValues) {
  Cases cases;
  const std::vector<std::uint32_t> words(2 * 2 / 2);
  core::FrameView view;
  view.at(core::Level::kFull).surface = core::SurfaceView{{2, 2}, 8.0, 8.0, 0.0009765625, words};
  const core::Bytes bytes =
      *FrameEncoder().encode({v1::LAYER_SURFACE, v1::PACKING_PACKED}, view, core::Level::kFull, true).keyframe;
  (void)cases.add(bytes, "", "\"elevation_m\": [0, 0, 0, 0.001]");
  EXPECT_EQ(cases.readOutside(), 1);
}

}  // namespace
}  // namespace spindrift::codec
