// Packed objects in the water: what is kept of them, what they cost, and what is refused.
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/codec/frame_decoder.h>
#include <spindrift/codec/frame_encoder.h>
#include <spindrift/core/scene.h>

#include "damaged_frames.h"

namespace spindrift::codec {
namespace {

using testing::HasSubstr;

constexpr Stream kPacked{v1::LAYER_FLOATERS, v1::PACKING_PACKED};
constexpr double kFrame_s = 1.0 / 30.0;

/// An object as the device packs it.
struct Object {
  std::uint32_t id = 1;
  std::array<double, 3> at_m{};
  std::array<double, 4> turn{0, 0, 0, 1};
  std::uint32_t size_cm = 30;
  std::uint32_t kind = 1;
  bool is_held = false;
};

std::vector<std::uint32_t> wordsOf(const std::vector<Object>& objects) {
  std::vector<std::uint32_t> words;
  const auto part = [](double value) {
    return static_cast<std::uint32_t>(
        static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(32767 * value))));
  };
  for (const Object& one : objects) {
    words.push_back(one.id);
    for (const double at_m : one.at_m) words.push_back(static_cast<std::uint32_t>(std::lround(1000 * at_m)));
    words.push_back(part(one.turn[0]) | part(one.turn[1]) << 16);
    words.push_back(part(one.turn[2]) | part(one.turn[3]) << 16);
    words.push_back(one.size_cm | one.kind << 16 | (one.is_held ? 1u << 24 : 0u));
  }
  return words;
}

/// Encodes frames of one room and reads them as a client that gets all of them.
class Chain {
 public:
  explicit Chain(core::Level level = core::Level::kFull) : level_(level) {}

  EncodedFrame encode(const std::vector<Object>& objects, bool wants_keyframe = false) {
    words_ = wordsOf(objects);
    core::FrameView view;
    view.tick = 100 + 2 * frame_count_;
    view.time_s = static_cast<double>(frame_count_) * kFrame_s;
    view.floaters = core::FloatersView{static_cast<std::uint32_t>(objects.size()), words_};
    ++frame_count_;
    plain_bytes_ = encoder_.encode(v1::LAYER_FLOATERS, view)->size();
    return encoder_.encode(kPacked, view, level_, wants_keyframe);
  }
  /// Bytes of the plain form of the newest frame.
  [[nodiscard]] std::size_t plainBytes() const { return plain_bytes_; }

 private:
  core::Level level_;
  FrameEncoder encoder_;
  std::vector<std::uint32_t> words_;
  std::uint64_t frame_count_ = 0;
  std::size_t plain_bytes_ = 0;
};

std::vector<FloaterSample> read(PackedFloaterDecoder& decoder, const core::SharedBytes& bytes) {
  const auto out = decoder.decode(frameOf(bytes));
  EXPECT_TRUE(out) << out.error().message;
  return out ? *out : std::vector<FloaterSample>();
}

/// Angle between two rotations. [rad]
double angleBetween(const std::array<double, 4>& a, const double (&b)[4]) {
  double product = 0.0, square = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    product += a[k] * b[k];
    square += a[k] * a[k];
  }
  return 2.0 * std::acos(std::min(1.0, std::abs(product) / std::sqrt(square)));
}

/// The decoded objects are the given ones, to half a quantum and this angle.
void expectLike(const std::vector<FloaterSample>& samples, const std::vector<Object>& objects, double quantum_m,
                double angle_rad) {
  ASSERT_EQ(samples.size(), objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Object& object = objects[i];
    const FloaterSample& sample = samples[i];
    ASSERT_EQ(sample.floater_id, object.id) << i;
    EXPECT_DOUBLE_EQ(sample.size_m, object.size_cm / 100.0);
    EXPECT_EQ(static_cast<std::uint32_t>(sample.kind), object.kind);
    EXPECT_EQ(sample.is_held, object.is_held);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double plain_m = std::round(1000 * object.at_m[axis]) / 1000.0;
      EXPECT_NEAR(sample.position_m[axis], plain_m, quantum_m / 2 + 1e-9) << "object " << i << ", axis " << axis;
    }
    EXPECT_LE(angleBetween(object.turn, sample.rotation), angle_rad) << "object " << i;
  }
}

std::array<double, 4> turnAbout(std::size_t axis, double angle_rad) {
  std::array<double, 4> out{0, 0, 0, std::cos(angle_rad / 2)};
  out[axis] = std::sin(angle_rad / 2);
  return out;
}

/// Objects in rows, in a swell of 0.3 m: they heave, drift and roll.
std::vector<Object> swell(std::size_t count, std::size_t frame) {
  std::vector<Object> out(count);
  const double t_s = static_cast<double>(frame) * kFrame_s;
  for (std::size_t i = 0; i < count; ++i) {
    const double x_m = 0.7 * static_cast<double>(i % 32) - 11, z_m = 0.7 * static_cast<double>(i / 32) - 11;
    const double phase = 1.3 * x_m + 0.2 * z_m - 2.4 * t_s + 0.1 * static_cast<double>(i % 7);
    out[i].id = static_cast<std::uint32_t>(i + 1);
    out[i].kind = static_cast<std::uint32_t>(i % 8 + 1);
    out[i].at_m = {x_m + 0.2 * std::sin(phase), 0.15 * std::cos(phase), z_m + 0.05 * t_s};
    out[i].turn = turnAbout(i % 3, 0.2 * std::sin(phase) + 0.4 * static_cast<double>(i % 5));
  }
  return out;
}

class EveryLevel : public testing::TestWithParam<core::Level> {
 protected:
  /// Returns the quantum of the level.
  static double quantum_m(const v1::LayerFrame& frame) { return frame.floaters_predicted().quantum_m(); }
};

TEST_P(EveryLevel, KeepsPosesToItsQuantum) {
  Chain chain(GetParam());
  PackedFloaterDecoder decoder;
  for (std::size_t frame = 0; frame < 30; ++frame) {
    const std::vector<Object> objects = swell(150, frame);
    const EncodedFrame encoded = chain.encode(objects);
    const v1::LayerFrame message = frameOf(encoded.delta ? encoded.delta : encoded.keyframe);
    EXPECT_EQ(message.keyframe(), frame == 0);
    EXPECT_EQ(message.level(), toWire(GetParam()));
    const double bound_rad = 8.0 / (1 << message.floaters_predicted().rotation_bits());
    expectLike(read(decoder, encoded.delta ? encoded.delta : encoded.keyframe), objects, quantum_m(message), bound_rad);
  }
}

TEST_P(EveryLevel, LateClientContinuesFromAKeyframeWithTheSamePoses) {
  Chain chain(GetParam());
  PackedFloaterDecoder early, late;
  for (std::size_t frame = 0; frame < 12; ++frame) {
    const EncodedFrame encoded = chain.encode(swell(100, frame), frame == 5);
    const auto samples = read(early, encoded.delta ? encoded.delta : encoded.keyframe);
    if (frame < 5) continue;
    const auto of_late = read(late, frame == 5 ? encoded.keyframe : encoded.delta);
    ASSERT_EQ(of_late.size(), samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
      EXPECT_THAT(of_late[i].position_m, testing::ElementsAreArray(samples[i].position_m));
      EXPECT_THAT(of_late[i].rotation, testing::ElementsAreArray(samples[i].rotation));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(PackedFloaters, EveryLevel, testing::ValuesIn(core::kLevels),
                         [](const auto& of) { return nameOf(of.param); });

TEST(PackedFloaters, LowerLevelsTakeFewerBytes) {
  std::size_t finer_bytes = 0;
  for (std::size_t k = core::kLevelCount; k-- > 0;) {
    Chain chain(core::kLevels[k]);
    std::size_t bytes = 0;
    for (std::size_t frame = 0; frame < 10; ++frame) {
      const EncodedFrame encoded = chain.encode(swell(512, frame));
      if (encoded.delta) bytes += encoded.delta->size();
    }
    EXPECT_TRUE(finer_bytes == 0 || bytes < finer_bytes) << nameOf(core::kLevels[k]);
    finer_bytes = bytes;
  }
}

TEST(PackedFloaters, TakeATenthOfThePlainBytesInSwell) {
  Chain chain;
  for (std::size_t frame = 0; frame < 5; ++frame) {
    const EncodedFrame encoded = chain.encode(swell(512, frame));
    if (frame < 2) continue;  // the first delta knows no motion yet
    EXPECT_LT(10 * encoded.delta->size(), chain.plainBytes());
  }
}

TEST(PackedFloaters, AtRestCostNothingButTheHeader) {
  Chain chain;
  (void)chain.encode(swell(1024, 0));
  const EncodedFrame encoded = chain.encode(swell(1024, 0));
  ASSERT_TRUE(encoded.delta);
  EXPECT_LE(frameOf(encoded.delta).payload().size(), 25u);
}

TEST(PackedFloaters, ComeAndGoExactly) {
  Chain chain;
  PackedFloaterDecoder decoder;
  std::mt19937 random(5);
  std::vector<Object> objects;
  std::uint32_t next_id = 1;
  for (std::size_t frame = 0; frame < 300; ++frame) {
    // Some go, some come in their slots or behind the last, some are held, some are thrown far.
    for (int k = static_cast<int>(random() % 4); k > 0; --k) {
      Object fresh{.id = next_id,
                   .size_cm = 5 + static_cast<std::uint32_t>(random() % 300),
                   .kind = 1 + static_cast<std::uint32_t>(random() % 8)};
      next_id += 1 + static_cast<std::uint32_t>(random() % 3 == 0 ? random() % 100'000 : 0);
      for (double& at_m : fresh.at_m) at_m = (static_cast<double>(random() % 1'000'001) - 500'000) / 1000.0;
      const std::size_t slot = random() % (objects.size() + 1);
      if (slot < objects.size() && random() % 2 == 0)
        objects[slot] = fresh;
      else if (objects.size() < core::kMaxFloaters)
        objects.insert(objects.begin() + static_cast<std::ptrdiff_t>(slot), fresh);
    }
    for (int k = static_cast<int>(random() % 3); k > 0 && !objects.empty(); --k)
      objects.erase(objects.begin() + static_cast<std::ptrdiff_t>(random() % objects.size()));
    if (frame == 150) objects.clear();
    for (Object& one : objects) {
      if (random() % 16 == 0) one.is_held = !one.is_held;
      if (random() % 64 == 0) one.at_m[0] = -one.at_m[0];
      one.turn = turnAbout(random() % 3, static_cast<double>(random() % 6283) / 1000.0);
      one.at_m[1] += static_cast<double>(random() % 200) / 1000.0 - 0.1;
    }
    const EncodedFrame encoded = chain.encode(objects, frame % 50 == 7);
    expectLike(read(decoder, encoded.delta ? encoded.delta : encoded.keyframe), objects, 0.001, 0.004);
    if (encoded.keyframe) {
      PackedFloaterDecoder fresh;
      expectLike(read(fresh, encoded.keyframe), objects, 0.001, 0.004);
    }
  }
}

TEST(PackedFloaters, IdsThatStandForOthersAfterAResetAreNew) {
  Chain chain;
  PackedFloaterDecoder decoder;
  const std::vector<Object> before = {{.id = 1, .kind = 2}, {.id = 2, .at_m = {3, 0, 0}}, {.id = 3, .size_cm = 80}};
  const std::vector<Object> after = {{.id = 3, .at_m = {1, 0, 0}, .size_cm = 40}, {.id = 1, .kind = 5}, {.id = 2}};
  (void)read(decoder, chain.encode(before).keyframe);
  expectLike(read(decoder, chain.encode(after).delta), after, 0.001, 0.004);
}

TEST(PackedFloaters, ADeltaNeedsItsFrame) {
  Chain chain;
  PackedFloaterDecoder decoder;
  const EncodedFrame first = chain.encode(swell(10, 0));
  (void)chain.encode(swell(10, 1));
  const EncodedFrame third = chain.encode(swell(10, 2), true);
  (void)read(decoder, first.keyframe);
  const auto lost = decoder.decode(frameOf(third.delta));
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().code, core::ErrorCode::kUnavailable);
  EXPECT_THAT(lost.error().message, HasSubstr("base_tick"));
  (void)read(decoder, third.keyframe);
  v1::LayerFrame other_level = frameOf(chain.encode(swell(10, 3)).delta);
  other_level.set_level(v1::LEVEL_COARSE);
  EXPECT_FALSE(decoder.decode(other_level));
}

TEST(PackedFloaters, RefuseWhatNoServerSends) {
  Chain chain;
  const v1::LayerFrame good = frameOf(chain.encode(swell(70, 0)).keyframe);
  const auto header = [](v1::LayerFrame& frame) -> v1::FloatersPredicted& {
    return *frame.mutable_floaters_predicted();
  };
  expectRefusals(good,
                 {
                     {"layer", [](v1::LayerFrame& f) { f.set_layer(v1::LAYER_BODIES); }, "LAYER_FLOATERS"},
                     {"codec", [](v1::LayerFrame& f) { f.mutable_floaters_fixed28()->set_count(70); }, "codec"},
                     {"time", [](v1::LayerFrame& f) { f.set_time_s(std::nan("")); }, "time_s"},
                     {"count", [&](v1::LayerFrame& f) { header(f).set_count(1025); }, "1024"},
                     {"one more", [&](v1::LayerFrame& f) { header(f).set_count(71); }, "71 objects"},
                     {"quantum 0", [&](v1::LayerFrame& f) { header(f).set_quantum_m(0); }, "quantum_m"},
                     {"quantum", [&](v1::LayerFrame& f) { header(f).set_quantum_m(0.06); }, "quantum_m"},
                     {"quantum nan", [&](v1::LayerFrame& f) { header(f).set_quantum_m(std::nan("")); }, "quantum_m"},
                     {"few bits", [&](v1::LayerFrame& f) { header(f).set_rotation_bits(5); }, "rotation_bits"},
                     {"many bits", [&](v1::LayerFrame& f) { header(f).set_rotation_bits(14); }, "rotation_bits"},
                     {"too long a quaternion", [&](v1::LayerFrame& f) { header(f).set_rotation_bits(8); }, "payload"},
                     {"weight", [&](v1::LayerFrame& f) { header(f).set_motion_weight(513); }, "motion_weight"},
                     {"cut", [](v1::LayerFrame& f) { f.mutable_payload()->resize(f.payload().size() - 3); }, "payload"},
                     {"longer", [](v1::LayerFrame& f) { f.mutable_payload()->push_back(0); }, "payload"},
                     {"none", [](v1::LayerFrame& f) { f.clear_payload(); }, "payload"},
                     {"flipped", [](v1::LayerFrame& f) { (*f.mutable_payload())[9] ^= 4; }, "crc32c", false},
                 },
                 [](const v1::LayerFrame& frame) { return PackedFloaterDecoder().decode(frame); });
}

TEST(PackedFloaters, FarAndBrokenObjectsStayInBounds) {
  Chain chain;
  PackedFloaterDecoder decoder;
  // Beyond the bound of coordinates, and without a rotation, as after a fault that the watchdog has not mended yet.
  const std::vector<Object> objects = {{.id = 0xFFFF'FFFFu, .at_m = {2e6, -2e6, 0}, .turn = {0, 0, 0, 0}},
                                       {.id = 7, .at_m = {499.999, 20, -499.999}, .turn = turnAbout(1, 3.1)}};
  for (int frame = 0; frame < 3; ++frame) {
    const EncodedFrame encoded = chain.encode(objects);
    const auto samples = read(decoder, encoded.delta ? encoded.delta : encoded.keyframe);
    ASSERT_EQ(samples.size(), 2u);
    EXPECT_NEAR(samples[0].position_m[0], (1 << 24) * 0.001, 1e-6);
    EXPECT_EQ(samples[0].rotation[3], 1.0);
    EXPECT_NEAR(samples[1].position_m[2], -499.999, 1e-9);
  }
}

}  // namespace
}  // namespace spindrift::codec
