// Packed particles: equal to the plain ones within half a quantum, and near the size bound for unordered points.
#include <algorithm>
#include <array>
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

constexpr Stream kPacked{v1::LAYER_PARTICLES, v1::PACKING_PACKED};

/// Particles anywhere in a box, as the GPU packs them.
struct Cloud {
  std::vector<std::uint32_t> words;
  core::ParticleView view;

  Cloud(std::array<double, 3> min_m, std::array<double, 3> max_m, double spacing_m) {
    std::ranges::copy(min_m, view.min_m);
    std::ranges::copy(max_m, view.max_m);
    view.max_speed_mps = 8.0;
    view.radius_m = spacing_m / 2;
  }
  void add(std::array<double, 3> place_m, std::array<int, 3> velocity, std::uint32_t tint, std::uint32_t foam) {
    const auto part = [&](std::size_t axis) {
      const double u = (place_m[axis] - view.min_m[axis]) / (view.max_m[axis] - view.min_m[axis]);
      return static_cast<std::uint32_t>(std::lround(std::clamp(u, 0.0, 1.0) * 65535));
    };
    const auto byte = [](int value) { return static_cast<std::uint32_t>(value) & 0xffu; };
    words.push_back(part(0) | part(2) << 16);
    words.push_back(part(1) | byte(velocity[0]) << 16 | byte(velocity[1]) << 24);
    words.push_back(byte(velocity[2]) | tint << 8 | foam << 16);
    view.count = static_cast<std::uint32_t>(words.size() / 3);
    view.words = words;
  }
  [[nodiscard]] core::FrameView frame() const {
    core::FrameView frame;
    frame.tick = 7;
    frame.time_s = 1.5;
    frame.at(core::Level::kFull).particles = view;
    return frame;
  }
};

/// Water at rest: a lattice, shaken by a fifth of its spacing.
Cloud water(int side, double spacing_m) {
  Cloud cloud({-1, -1, -1}, {side * spacing_m - 1, 3, side * spacing_m - 1}, spacing_m);
  std::mt19937 random(3);
  const auto shaken = [&] { return (std::generate_canonical<double, 32>(random) - 0.5) * 0.4 * spacing_m; };
  for (int x = 0; x < side; ++x) {
    for (int z = 0; z < side; ++z) {
      for (int y = 0; y < 6; ++y)
        cloud.add({-1 + (x + 0.5) * spacing_m + shaken(), -1 + (y + 0.5) * spacing_m + shaken(),
                   -1 + (z + 0.5) * spacing_m + shaken()},
                  {static_cast<int>(random() % 5) - 2, -3, 1}, static_cast<std::uint32_t>(205 + random() % 20), 0);
    }
  }
  return cloud;
}

v1::LayerFrame packed(const Cloud& cloud) {
  const EncodedFrame encoded = FrameEncoder().encode(kPacked, cloud.frame(), core::Level::kFull, false);
  EXPECT_EQ(encoded.delta, nullptr);
  return frameOf(encoded.keyframe);
}

struct Row {
  std::array<double, 3> place_m, velocity_mps;
  int tint, foam;
};
std::vector<Row> rowsOf(const ParticleSamples& samples) {
  std::vector<Row> rows;
  for (std::size_t i = 0; i < samples.count; ++i) {
    rows.push_back({{samples.position_m[3 * i], samples.position_m[3 * i + 1], samples.position_m[3 * i + 2]},
                    {samples.velocity_mps[3 * i], samples.velocity_mps[3 * i + 1], samples.velocity_mps[3 * i + 2]},
                    samples.tint[i],
                    samples.foam[i]});
  }
  return rows;
}

/// Matches packed and plain particles one to one, because their orders differ.
void expectSame(const Cloud& cloud) {
  const v1::LayerFrame frame = packed(cloud);
  const auto samples = decodePackedParticles(frame);
  ASSERT_TRUE(samples) << samples.error().message;
  const auto plain = decodeParticles(frameOf(FrameEncoder().encode(v1::LAYER_PARTICLES, cloud.frame())));
  ASSERT_TRUE(plain);
  ASSERT_EQ(samples->count, plain->count);
  const v1::ParticlesByCell& header = frame.particles_by_cell();
  const double quantum_m = header.cell_m() / (1 << header.offset_bits());
  const double step_m = (cloud.view.max_m[0] - cloud.view.min_m[0]) / 65535;
  std::vector<Row> rest = rowsOf(*plain);
  for (const Row& row : rowsOf(*samples)) {
    const auto fits = [&](const Row& other) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (std::abs(row.place_m[axis] - other.place_m[axis]) > 0.5 * quantum_m + step_m) return false;
        if (std::abs(row.velocity_mps[axis] - other.velocity_mps[axis]) > 0.5001 * header.velocity_quantum_mps())
          return false;
      }
      return std::abs(row.tint - other.tint) <= 19 && std::abs(row.foam - other.foam) <= 43;
    };
    const auto found = std::ranges::find_if(rest, fits);
    ASSERT_NE(found, rest.end()) << "at " << row.place_m[0] << ", " << row.place_m[1] << ", " << row.place_m[2];
    *found = rest.back();
    rest.pop_back();
  }
}

TEST(ParticlesByCell, AreThePlainParticlesToHalfAQuantum) {
  expectSame(water(9, 0.2));
}

TEST(ParticlesByCell, RoundTripsNoneOneOrManyAtOnePosition) {
  Cloud cloud({-4, -1, -4}, {4, 3, 4}, 0.1);
  EXPECT_EQ(packed(cloud).particles_by_cell().count(), 0u);
  expectSame(cloud);
  cloud.add({-4, -1, -4}, {127, -127, 0}, 0, 255);
  expectSame(cloud);
  for (int k = 0; k < 200; ++k) cloud.add({4, 3, 4}, {k % 100, 0, -k % 50}, 255, static_cast<std::uint32_t>(k));
  for (int k = 0; k < 9; ++k) cloud.add({0.001, 0.001 * k, 0}, {0, 0, 0}, 100, 0);
  expectSame(cloud);
}

TEST(ParticlesByCell, FitAWorldThatIsLargeForItsParticles) {
  Cloud cloud({-400, -5, -400}, {400, 60, 400}, 0.05);
  std::mt19937 random(5);
  for (int k = 0; k < 300; ++k)
    cloud.add({-400 + 800 * std::generate_canonical<double, 32>(random), -5 + 65.0 * k / 300,
               -400 + 800 * std::generate_canonical<double, 32>(random)},
              {0, 0, 0}, 212, 0);
  expectSame(cloud);
}

TEST(ParticlesByCell, ManyCellsDoNotMakePositionsCoarser) {
  Cloud cloud({-12, -1.5, -12}, {12, 5, 12}, 0.02);  // 600 x 163 x 600 cells, more than there can be
  for (int k = 0; k < 300; ++k) cloud.add({-12 + 0.08 * k, -1.5 + 0.02 * k, 12 - 0.08 * k}, {k % 9, 0, -1}, 212, 0);
  const v1::LayerFrame frame = packed(cloud);
  const v1::ParticlesByCell& header = frame.particles_by_cell();
  EXPECT_DOUBLE_EQ(header.cell_m() / (1 << header.offset_bits()), 0.02 / 16) << "a sixteenth of a spacing, as always";
  expectSame(cloud);
}

TEST(ParticlesByCell, AreAsManyAsASceneCanHave) {
  constexpr std::uint32_t kCount = 4'194'240;
  Cloud cloud({-12, -1.5, -12}, {12, 5, 12}, 0.02);
  cloud.words.reserve(3 * kCount);
  std::mt19937 random(11);
  for (std::uint32_t k = 0; k < kCount; ++k) {
    cloud.words.push_back(static_cast<std::uint32_t>(random()));
    cloud.words.push_back(static_cast<std::uint32_t>(random() & 0x1fffu));  // near the ground
    cloud.words.push_back(212u << 8);
  }
  cloud.view.count = kCount;
  cloud.view.words = cloud.words;
  const auto samples = decodePackedParticles(packed(cloud));
  ASSERT_TRUE(samples) << samples.error().message;
  ASSERT_EQ(samples->count, kCount);
  // Positions are random: their sum tells whether they are the same.
  double sum_m = 0.0, plain_sum_m = 0.0;
  for (std::size_t i = 0; i < kCount; ++i) {
    sum_m += samples->position_m[3 * i];
    plain_sum_m += -12 + 24.0 * (cloud.words[3 * i] & 0xffffu) / 65535;
  }
  EXPECT_NEAR(sum_m, plain_sum_m, 1e-5 * kCount);
}

TEST(ParticlesByCell, PositionsTakeHardlyMoreThanTheBound) {
  const Cloud cloud = water(40, 0.2);
  Cloud still = cloud;
  for (std::size_t i = 0; i < still.words.size(); i += 3) {
    still.words[i + 1] &= 0xffffu;
    still.words[i + 2] = 212u << 8;
  }
  still.view.words = still.words;
  const double bits = 8.0 * static_cast<double>(packed(still).payload().size()) / still.view.count;
  const double bound = 3 * std::log2(16.0) + 1.44;
  EXPECT_LE(bits, bound + 1) << "the bound for unordered particles with a quantum of a sixteenth of their spacing";
  EXPECT_GE(bits, bound - 2) << "or something was lost";
}

TEST(ParticlesByCell, RefuseDamagedFrames) {
  const v1::LayerFrame good = packed(water(5, 0.2));
  static const double nan = std::numeric_limits<double>::quiet_NaN();
  expectRefusals(
      good,
      {
          {"layer", [](v1::LayerFrame& f) { f.set_layer(v1::LAYER_FOAM); }, "LAYER_PARTICLES"},
          {"codec", [](v1::LayerFrame& f) { f.mutable_foam_fixed8(); }, "codec"},
          {"not whole", [](v1::LayerFrame& f) { f.set_keyframe(false); }, "keyframe"},
          {"time", [](v1::LayerFrame& f) { f.set_time_s(nan); }, "time_s"},
          {"count", [](v1::LayerFrame& f) { f.mutable_particles_by_cell()->set_count(kParticleMaxCount + 1); },
           "4194304"},
          {"one more", [](v1::LayerFrame& f) { f.mutable_particles_by_cell()->set_count(151); }, "payload"},
          {"one less", [](v1::LayerFrame& f) { f.mutable_particles_by_cell()->set_count(149); }, "payload"},
          {"min", [](v1::LayerFrame& f) { f.mutable_particles_by_cell()->set_min_y_m(nan); }, "min_m"},
          {"cell", [](v1::LayerFrame& f) { f.mutable_particles_by_cell()->set_cell_m(0); }, "cell_m"},
          {"no cells", [](v1::LayerFrame& f) { f.mutable_particles_by_cell()->set_cells_y_count(0); }, "cells"},
          {"many cells", [](v1::LayerFrame& f) { f.mutable_particles_by_cell()->set_cells_x_count(~0u); }, "cells"},
          {"too many cells",
           [](v1::LayerFrame& f) {
             f.mutable_particles_by_cell()->set_cells_x_count(2048);
             f.mutable_particles_by_cell()->set_cells_y_count(2048);
             f.mutable_particles_by_cell()->set_cells_z_count(2048);
           },
           "16777216"},
          {"bits", [](v1::LayerFrame& f) { f.mutable_particles_by_cell()->set_offset_bits(9); }, "offset_bits"},
          {"no bits", [](v1::LayerFrame& f) { f.mutable_particles_by_cell()->set_offset_bits(0); }, "offset_bits"},
          {"speed", [](v1::LayerFrame& f) { f.mutable_particles_by_cell()->set_velocity_quantum_mps(-1); },
           "velocity_quantum_mps"},
          {"radius", [](v1::LayerFrame& f) { f.mutable_particles_by_cell()->set_radius_m(nan); }, "radius_m"},
          {"empty", [](v1::LayerFrame& f) { f.clear_payload(); }, "payload"},
          {"cut", [](v1::LayerFrame& f) { f.mutable_payload()->resize(f.payload().size() - 2); }, "payload"},
          {"longer", [](v1::LayerFrame& f) { f.mutable_payload()->push_back(1); }, "payload"},
          {"flipped", [](v1::LayerFrame& f) { (*f.mutable_payload())[30] ^= 1; }, "crc32c", false},
      },
      [](const v1::LayerFrame& frame) { return decodePackedParticles(frame); });
}

TEST(ParticlesByCell, ReadAnyBytesWithoutHarm) {
  const v1::LayerFrame good = packed(water(6, 0.2));
  std::mt19937 random(11);
  int accepted_count = 0;
  for (int k = 0; k < 3000; ++k) {
    const v1::LayerFrame frame = scrambled(good, random, [&](v1::LayerFrame& f) {
      f.mutable_particles_by_cell()->set_count(static_cast<std::uint32_t>(random() % 100000));
    });
    if (const auto samples = decodePackedParticles(frame)) {
      ++accepted_count;
      for (const float x : samples->position_m) ASSERT_TRUE(std::isfinite(x));
    }
  }
  EXPECT_LT(accepted_count, 2500) << "raw bits may be anything, coded ones may not";
}

}  // namespace
}  // namespace spindrift::codec
