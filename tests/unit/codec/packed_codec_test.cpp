// The parts of the packed codecs: codes, groups, order, prediction.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <spindrift/bitstream/decode/plane_reader.h>
#include <spindrift/bitstream/decode/residual_reader.h>
#include <spindrift/bitstream/encode/particle_order.h>
#include <spindrift/bitstream/encode/surface_predictor.h>
#include <spindrift/codec/frame_encoder.h>

#include "decode/prefix_slots.h"
#include "encode/group_writer.h"
#include "encode/prefix_code.h"
#include "packed_payload.h"

namespace spindrift::codec {
namespace {

/// Reads 32 bits at a time.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  std::uint32_t operator()() { return static_cast<std::uint32_t>(engine_()); }

 private:
  std::mt19937 engine_;
};

TEST(PrefixCode, FitsAnyCountsAndReadsThemBack) {
  Random random(1);
  for (int round = 0; round < 200; ++round) {
    std::vector<std::uint32_t> counts(2 + random() % 255);
    for (std::uint32_t& count : counts) count = random() % 3 == 0 ? 0 : 1 + (random() >> (random() % 32));
    std::vector<std::size_t> symbols = {0, 1};
    for (std::size_t s = 0; s < counts.size(); ++s) {
      if (counts[s] > 0) symbols.push_back(s);
    }
    BitWriter out;
    const PrefixWriter writer = putFittedCode(counts, out);
    BitCursor cursor = out.begin(4 * symbols.size());
    for (const std::size_t s : symbols) {
      writer.put(s, cursor);
      cursor.flush();
    }
    out.end(cursor);
    core::Bytes bytes;
    out.finish(bytes);
    const PackedPayload payload(bytes);
    BitSource in(payload.data(), payload.size());
    PrefixSlots slots;
    ASSERT_TRUE(slots.read(counts.size(), in));
    for (const std::size_t s : symbols) {
      in.prepare();
      ASSERT_EQ(slots.get(in), s);
    }
    EXPECT_TRUE(in.isAtEnd());
  }
}

TEST(PrefixCode, RefusesIncompleteLengths) {
  PrefixSlots slots;
  EXPECT_TRUE(slots.assign(std::vector<std::uint8_t>{1, 2, 2}));
  EXPECT_FALSE(slots.assign(std::vector<std::uint8_t>{1, 2, 3}));
  EXPECT_FALSE(slots.assign(std::vector<std::uint8_t>{1, 1, 2}));
  EXPECT_FALSE(slots.assign(std::vector<std::uint8_t>{1, 2, 2, 12}));
  EXPECT_FALSE(slots.assign(std::vector<std::uint8_t>{0, 0}));
}

TEST(Residuals, RoundTripAtEverySize) {
  Random random(2);
  ResidualEncoder out;
  struct Group {
    ResidualGroup residuals;
    std::size_t count;
    std::uint32_t left, above, group_class;
  };
  std::vector<Group> groups;
  for (int bits = 0; bits <= 16; ++bits) {
    for (int k = 0; k < 50; ++k) {
      Group group{{}, 1 + random() % kGroupMaxCount, random() % kResidualClassCount, random() % 3, 0};
      for (std::size_t i = 0; i < group.count; ++i) {
        const int value = static_cast<int>(random() & 0xffffu) - 32768;
        group.residuals.of[i] = static_cast<std::int16_t>(random() % 97 == 0 ? value : value / (1 << (16 - bits)));
        if (k % 3 == 0 && random() % 8 != 0) group.residuals.of[i] = 0;
      }
      GroupWriter writer = out.begin(1);
      group.group_class = writer.putGroup(GroupRows(group.residuals.of.data()), group.count, group.left, group.above);
      out.end(writer);
      groups.push_back(group);
    }
  }
  core::Bytes bytes;
  out.finish(bytes);
  const PackedPayload payload(bytes);
  ResidualReader in(payload.data(), payload.size());
  for (const Group& group : groups) {
    ResidualGroup read;
    ASSERT_EQ(in.group(read, group.count, group.left, group.above), group.group_class);
    for (std::size_t i = 0; i < group.count; ++i) ASSERT_EQ(read.of[i], group.residuals.of[i]);
  }
  EXPECT_TRUE(in.isAtEnd());
}

TEST(ParticleOrder, IsTheSameByCountingAndByDigits) {
  Random random(3);
  for (const std::uint32_t in_one_place : {0u, 20u, 200u, 300u}) {
    std::vector<std::uint32_t> keys(in_one_place, 8 * 40 + 5);
    for (int i = 0; i < 1000; ++i) keys.push_back(random() % (8 * 500));
    std::vector<std::uint64_t> items;
    for (std::size_t i = 0; i < keys.size(); ++i) items.push_back(std::uint64_t{keys[i]} << 32 | i);
    ParticleOrder counted, sorted;
    counted.sort(keys, items, 500);
    sorted.sort(keys, items, 1 << 24);
    EXPECT_TRUE(std::ranges::is_sorted(counted.items()));
    EXPECT_TRUE(std::ranges::equal(counted.items(), sorted.items()));
    EXPECT_TRUE(std::ranges::equal(counted.extras(), sorted.extras()));
    EXPECT_TRUE(std::ranges::equal(counted.cells(), sorted.cells(), [](const OccupiedCell& a, const OccupiedCell& b) {
      return a.gap == b.gap && a.halves == b.halves;
    })) << in_one_place;
  }
}

SurfacePlane planeOf(core::CellCounts n, auto sample_at) {
  std::vector<std::int16_t> samples;
  for (std::size_t i = 0; i < n.total(); ++i) samples.push_back(static_cast<std::int16_t>(sample_at(i % n.x, i / n.x)));
  SurfacePlane plane;
  plane.resize(n);
  plane.assign(std::span<const std::int16_t>(samples));
  return plane;
}

/// Prediction of one sample from the previous frames, rounding included, times 4096.
std::int32_t fromHistoryAt(const SurfaceHistory& history, const SurfaceWeights& weights, std::size_t x, std::size_t z) {
  using W = SurfaceWeights;
  std::uint32_t sum = 1u << (kWeightBits - 1);
  const auto add = [&](const SurfacePlane* plane, std::int32_t weight,
                       std::initializer_list<std::pair<int, int>> places) {
    for (const auto& [dx, dz] : places) {
      if (plane == nullptr) continue;
      const std::int16_t sample = plane->row(static_cast<std::ptrdiff_t>(z) + dz)[static_cast<std::ptrdiff_t>(x) + dx];
      sum += static_cast<std::uint32_t>(weight) * static_cast<std::uint32_t>(sample);
    }
  };
  const auto nearest = {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)};
  const auto diagonal = {std::pair(1, 1), std::pair(-1, 1), std::pair(1, -1), std::pair(-1, -1)};
  add(history.before, weights.of[W::kBefore], {{0, 0}});
  add(history.before, weights.of[W::kBeforeNearest], nearest);
  add(history.before, weights.of[W::kBeforeDiagonal], diagonal);
  add(history.before, weights.of[W::kBeforeFar], {{2, 0}, {-2, 0}, {0, 2}, {0, -2}});
  add(history.earlier, weights.of[W::kEarlier], {{0, 0}});
  add(history.earlier, weights.of[W::kEarlierNearest], nearest);
  add(history.earlier, weights.of[W::kEarlierDiagonal], diagonal);
  return static_cast<std::int32_t>(sum);
}

TEST(Prediction, RowEqualsItsSamples) {
  Random random(4);
  const auto noise = [&](std::size_t, std::size_t) { return random(); };
  for (const std::uint32_t n : {2u, 16u, 17u, 18u, 33u, 64u}) {
    const core::CellCounts size{n, n / 2 + 1};
    const SurfacePlane now = planeOf(size, noise), before = planeOf(size, noise), earlier = planeOf(size, noise);
    for (const std::int32_t largest : {4096, 32767, 1 << 20}) {
      SurfaceWeights weights;
      for (std::int32_t& w : weights.of) w = static_cast<std::int32_t>(random() % (2u * largest + 1)) - largest;
      for (const SurfaceHistory& history :
           {SurfaceHistory{}, SurfaceHistory{&before, nullptr}, SurfaceHistory{&before, &earlier}}) {
        std::vector<std::int32_t> sums(n);
        std::vector<std::int16_t> residuals(n);
        for (std::size_t z = 0; z < size.z; ++z) {
          residualsOfRow(now, history, weights, z, sums, residuals);
          const std::int16_t* here = now.row(static_cast<std::ptrdiff_t>(z));
          const std::int16_t* above = now.row(static_cast<std::ptrdiff_t>(z) - 1);
          for (std::size_t x = 0; x < n; ++x) {
            const std::int32_t west = x > 0 ? here[x - 1] : z > 0 ? above[0] : 0;
            const KnownSamples known =
                z > 0 && x > 0 ? KnownSamples{west, above[x], above[x - 1]} : KnownSamples{west, west, west};
            const auto wanted = static_cast<std::int16_t>(
                here[x] - predictionOf(fromHistoryAt(history, weights, x, z), known, weights));
            ASSERT_EQ(residuals[x], wanted) << n << " a side, " << x << ", " << z << ", weights to " << largest;
          }
        }
      }
    }
  }
}

core::Bytes payloadOf(const SurfacePlane& plane, const SurfaceHistory& history, const SurfaceWeights& weights,
                      const SurfacePlane* second, const SurfaceWeights& second_weights) {
  ResidualEncoder residuals;
  encodePlane(plane, history, weights, residuals);
  if (second != nullptr) encodePlane(*second, {&plane, nullptr}, second_weights, residuals);
  core::Bytes bytes;
  residuals.finish(bytes);
  return bytes;
}

TEST(Prediction, FitsCalmWaterBesideAKnownBreaker) {
  constexpr std::size_t kSide = 128;
  Random random(6);
  // Two waves that travel, and a breaker in a corner that no frame predicts.
  const auto frame = [&](double t) {
    return planeOf({kSide, kSide}, [&](std::size_t x, std::size_t z) {
      const auto along = static_cast<double>(x), across = static_cast<double>(z);
      const double waves = 60 * std::sin(0.3 * along - 0.5 * t) + 40 * std::sin(0.4 * (along + across) - 0.9 * t);
      const double breaker = x < 32 && z < 32 ? static_cast<double>(random() % 1200) - 600 : 0.0;
      return std::lround(waves + breaker);
    });
  };
  const SurfacePlane first = frame(0), second = frame(1), third = frame(2), fourth = frame(3);
  const SurfaceWeights guess = fitWeights(third, {&second, &first}, nullptr);
  const SurfaceHistory history{&third, &second};
  const std::size_t plain = payloadOf(fourth, history, fitWeights(fourth, history, nullptr), nullptr, {}).size();
  const std::size_t weighted = payloadOf(fourth, history, fitWeights(fourth, history, &guess), nullptr, {}).size();
  EXPECT_LT(weighted, 0.8 * static_cast<double>(plain)) << "of " << plain << " bytes";
}

void expectSame(const PlaneRow& read, const SurfacePlane& plane, const std::string& which) {
  ASSERT_TRUE(read.hasRow()) << which;
  for (std::size_t z = 0; z < plane.count().z; ++z) {
    const std::int16_t* row = plane.row(static_cast<std::ptrdiff_t>(z));
    ASSERT_TRUE(std::equal(row, row + plane.count().x, read.row(z))) << which << ", row " << z;
  }
}

TEST(Planes, RoundTripAtAnySizeAndWeights) {
  Random random(5);
  const auto noise = [&](std::size_t, std::size_t) { return random(); };
  for (const core::CellCounts n : {core::CellCounts{1, 1},
                                   {2, 2},
                                   {7, 7},
                                   {8, 8},
                                   {9, 9},
                                   {16, 16},
                                   {17, 17},
                                   {23, 23},
                                   {33, 33},
                                   {64, 64},
                                   {1, 40},
                                   {40, 1},
                                   {37, 113},
                                   {113, 37},
                                   {8, 65},
                                   {25, 3}}) {
    for (const std::int32_t largest : {4096, 32767, 1 << 20}) {
      const SurfacePlane earlier = planeOf(n, noise), before = planeOf(n, noise), now = planeOf(n, noise);
      SurfaceWeights weights[3];
      for (SurfaceWeights& set : weights) {
        for (std::int32_t& w : set.of) w = static_cast<std::int32_t>(random() % (2u * largest + 1)) - largest;
      }
      const std::string which =
          std::to_string(n.x) + " x " + std::to_string(n.z) + ", weights to " + std::to_string(largest);
      PlaneMemory memory;
      memory.resize(n);
      PlaneRow& row = memory.row();
      const PackedPayload whole(payloadOf(before, {}, weights[0], &earlier, weights[1]));
      ASSERT_TRUE(row.readKeyframe(whole.data(), whole.size(), weights[0], weights[1])) << which;
      expectSame(row, before, which);
      const PackedPayload next(payloadOf(now, {&before, &earlier}, weights[2], nullptr, {}));
      ASSERT_TRUE(row.readDelta(next.data(), next.size(), weights[2])) << which;
      expectSame(row, now, which);
      ASSERT_FALSE(row.readDelta(whole.data(), whole.size(), weights[2])) << which;
      EXPECT_FALSE(row.hasRow()) << "damage ends the row";
      EXPECT_FALSE(row.readDelta(next.data(), next.size(), weights[2])) << which;
    }
  }
}

/// Water that obeys the wave equation in double precision: a drop, walls around, a little damping.
class Water {
 public:
  explicit Water(std::size_t n) : n_(n), now_(n * n), before_(n * n) {
    for (std::size_t i = 0; i < n * n; ++i) {
      const double x = static_cast<double>(i % n) - 0.4 * static_cast<double>(n);
      const double z = static_cast<double>(i / n) - 0.55 * static_cast<double>(n);
      const double q = (x * x + z * z) / 40;
      now_[i] = before_[i] = 900 * (1 - q) * std::exp(-q);
    }
  }
  void step() {
    std::vector<double> next(n_ * n_);
    for (std::size_t z = 0; z < n_; ++z) {
      for (std::size_t x = 0; x < n_; ++x) {
        const double here = at(x, z);
        const double around = at(x > 0 ? x - 1 : x, z) + at(std::min(x + 1, n_ - 1), z) + at(x, z > 0 ? z - 1 : z) +
                              at(x, std::min(z + 1, n_ - 1));
        next[z * n_ + x] = here + 0.995 * (here - before_[z * n_ + x]) + 0.3 * (around - 4 * here);
      }
    }
    before_ = std::exchange(now_, std::move(next));
  }
  [[nodiscard]] std::vector<std::uint32_t> words() const {
    std::vector<std::uint32_t> words(n_ * n_ / 2);
    for (std::size_t i = 0; i < n_ * n_; ++i) {
      const auto sample = static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(now_[i])));
      words[i / 2] |= static_cast<std::uint32_t>(sample) << (16 * (i % 2));
    }
    return words;
  }

 private:
  [[nodiscard]] double at(std::size_t x, std::size_t z) const { return now_[z * n_ + x]; }
  std::size_t n_;
  std::vector<double> now_, before_;
};

TEST(SurfacePredicted, TakesAtMost2Point3BitsPerSample) {
  constexpr std::uint32_t kSide = 128;
  Water water(kSide);
  FrameEncoder encoder;
  std::size_t bytes = 0, frame_count = 0;
  for (std::uint64_t tick = 0; tick < 120; tick += 2) {
    const std::vector<std::uint32_t> words = water.words();
    core::FrameView view;
    view.tick = tick;
    view.at(core::Level::kFull).surface = core::SurfaceView{{kSide, kSide}, 16.0, 16.0, 0.001, words};
    const EncodedFrame encoded =
        encoder.encode({v1::LAYER_SURFACE, v1::PACKING_PACKED}, view, core::Level::kFull, false);
    if (encoded.delta) {
      bytes += encoded.delta->size();
      ++frame_count;
    }
    water.step();
    water.step();
  }
  const double bits = 8.0 * static_cast<double>(bytes) / static_cast<double>(frame_count * kSide * kSide);
  RecordProperty("bits_a_sample", std::to_string(bits));
  EXPECT_LT(bits, 2.3);
}

}  // namespace
}  // namespace spindrift::codec
