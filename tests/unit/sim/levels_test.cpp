// Levels of detail of a frame: planes with fewer samples, subsets of the particles.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

using core::Level;

class Levels : public OnDevice {
 protected:
  core::FrameView frame(WaterSim& sim, const FrameRequest& request) {
    EXPECT_TRUE(sim.requestFrame(request));
    ctx_->finish();
    auto frames = sim.takeFrames();
    EXPECT_EQ(frames.size(), 1u);
    return frames.empty() ? core::FrameView{} : std::move(frames.front());
  }
};

FrameRequest everyLevel() {
  FrameRequest request;
  request.levels.fill({.surface = true, .particles = true});
  return request;
}

std::vector<int> samplesOf(const core::SurfaceView& surface) {
  std::vector<int> out;
  for (const std::uint32_t word : surface.words) {
    out.push_back(static_cast<std::int16_t>(word & 0xffff));
    out.push_back(static_cast<std::int16_t>(word >> 16));
  }
  return out;
}

using Words = std::array<std::uint32_t, 3>;
std::set<Words> particlesOf(const core::ParticleView& particles) {
  std::set<Words> out;
  for (std::size_t i = 0; i < particles.count; ++i)
    out.insert({particles.words[3 * i], particles.words[3 * i + 1], particles.words[3 * i + 2]});
  return out;
}

/// Reduces n x n values to m x m means over the area that each covers.
std::vector<double> means(const std::vector<double>& values, std::size_t n, std::size_t m) {
  const double width = static_cast<double>(n) / static_cast<double>(m);
  const auto share = [width](std::size_t cell, std::size_t sample) {
    const double from = static_cast<double>(cell), low = static_cast<double>(sample) * width;
    return std::max(std::min(from + 1.0, low + width) - std::max(from, low), 0.0);
  };
  std::vector<double> out;
  for (std::size_t k = 0; k < m; ++k) {
    for (std::size_t i = 0; i < m; ++i) {
      double sum = 0.0;
      for (std::size_t c = k * n / m; c < n && c <= (k + 1) * n / m; ++c) {
        for (std::size_t a = i * n / m; a < n && a <= (i + 1) * n / m; ++a)
          sum += share(a, i) * share(c, k) * values[c * n + a];
      }
      out.push_back(sum / (width * width));
    }
  }
  return out;
}

/// A different wave in each direction, so that no mean is zero by symmetry.
void ripple(WaterSim& sim, std::size_t n) {
  StateCopy state = sim.copyState();
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      const double x = static_cast<double>(i) / static_cast<double>(n),
                   z = static_cast<double>(k) / static_cast<double>(n);
      state.elevation_m[k * n + i] = 0.3 * std::sin(9.0 * x + 4.0 * z) + 0.2 * x - 0.1 * z * z;
    }
  }
  sim.setState(state);
}

TEST_F(Levels, AReducedSurfaceSampleIsTheMeanOfItsArea) {
  // 192 cells into 128 samples: a sample covers one cell and a half.
  constexpr std::size_t kN = 192;
  core::Scene scene = smallScene();
  scene.particles.reset();
  scene.coupling.reset();
  scene.foam.reset();
  scene.wave->resolution_count = kN;
  WaterSim& sim = make(scene);
  ripple(sim, kN);
  const core::FrameView view = frame(sim, everyLevel());
  ASSERT_EQ(view.reduced_counts.planes, 1u);
  ASSERT_EQ(view.reduced_counts.particles, 0u);
  const core::LevelView& full = view.at(Level::kFull);
  ASSERT_TRUE(full.surface);
  EXPECT_EQ(full.surface->count.x, kN);
  const core::LevelView& coarse = view.at(Level::kCoarse);
  ASSERT_TRUE(coarse.surface);
  EXPECT_FALSE(coarse.particles);
  EXPECT_FALSE(view.at(Level::kMedium).surface) << "the scene is smaller than the level";
  const std::size_t m = coarse.surface->count.x;
  ASSERT_EQ(m, 128u);
  EXPECT_EQ(coarse.surface->length_m, full.surface->length_m);
  const std::vector<int> reduced = samplesOf(*coarse.surface);
  ASSERT_EQ(reduced.size(), m * m);

  const std::vector<double> expected_m = means(sim.copyState().elevation_m, kN, m);
  double worst = 0.0;
  for (std::size_t i = 0; i < m * m; ++i)
    worst = std::max(worst, std::abs(expected_m[i] - reduced[i] * coarse.surface->quantum_m));
  EXPECT_LE(worst, 0.502 * coarse.surface->quantum_m);
  EXPECT_GT(*std::ranges::max_element(reduced) - *std::ranges::min_element(reduced), 100) << "the surface is not flat";
}

TEST_F(Levels, AReducedFoamSampleIsTheMeanOfItsArea) {
  core::Scene scene = smallScene();
  scene.particles.reset();
  scene.coupling.reset();
  scene.wave->resolution_count = 192;
  scene.foam->surface = true;
  WaterSim& sim = make(scene);
  ASSERT_TRUE(sim.start(core::Splash{0.5, 0.5, 1.0, 1.0, 0.1}));
  for (int tick = 0; tick < 30; ++tick) sim.step();
  FrameRequest request;
  request.at(Level::kFull).foam = request.at(Level::kCoarse).foam = true;
  const core::FrameView view = frame(sim, request);
  const auto& full = view.at(Level::kFull).foam;
  const auto& reduced = view.at(Level::kCoarse).foam;
  ASSERT_TRUE(full && reduced);
  ASSERT_EQ(full->count.x, 96u);
  ASSERT_EQ(reduced->count.x, 64u);
  const auto bytesOf = [](const core::FoamView& foam) {
    const auto bytes = std::as_bytes(foam.words);
    std::vector<double> out;
    for (const std::byte byte : bytes) out.push_back(std::to_integer<int>(byte));
    return out;
  };
  const std::vector<double> expected = means(bytesOf(*full), 96, 64);
  const std::vector<double> got = bytesOf(*reduced);
  ASSERT_EQ(got.size(), expected.size());
  EXPECT_GT(*std::ranges::max_element(got), 50.0) << "there is foam";
  // Both values are rounded.
  for (std::size_t i = 0; i < got.size(); ++i) ASSERT_NEAR(got[i], expected[i], 1.01) << i;
}

TEST_F(Levels, AFullSurfaceIsTheSameBesideReducedOnes) {
  core::Scene scene = smallScene();
  scene.wave->resolution_count = 192;
  WaterSim& sim = make(scene);
  ripple(sim, 192);
  const auto samples = [&](const FrameRequest& request) {
    return samplesOf(*frame(sim, request).at(Level::kFull).surface);
  };
  const std::vector<int> beside = samples(everyLevel());
  const std::vector<int> alone = samples(FrameRequest::full({.surface = true}));
  EXPECT_EQ(beside, alone);
}

TEST_F(Levels, UnwatchedLevelsAreNotPacked) {
  core::Scene scene = smallScene();
  scene.wave->resolution_count = 192;
  WaterSim& sim = make(scene);
  FrameRequest request;
  request.at(Level::kCoarse).surface = true;
  const core::FrameView view = frame(sim, request);
  const core::LevelView& full = view.at(Level::kFull);
  EXPECT_FALSE(full.surface || full.particles || full.foam || view.bodies);
  ASSERT_TRUE(view.at(Level::kCoarse).surface);
  EXPECT_EQ(view.at(Level::kCoarse).surface->count.x, 128u);
  EXPECT_FALSE(sim.requestFrame({})) << "nothing was asked for";
}

TEST_F(Levels, ALowerLevelHasASubsetOfTheParticlesTheSameInEveryFrame) {
  core::Scene scene = smallScene(40'000);
  scene.wave->side_m = 40.0;
  WaterSim& sim = make(scene);
  const core::FrameView view = frame(sim, everyLevel());
  const auto& full = view.at(Level::kFull).particles;
  ASSERT_TRUE(full);
  ASSERT_GT(full->count, 33'000u);
  ASSERT_EQ(view.reduced_counts.particles, 2u);
  const std::set<Words> all = particlesOf(*full);
  std::set<Words> within = all;
  for (const Level level : {Level::kMedium, Level::kCoarse}) {
    const auto& part = view.at(level).particles;
    ASSERT_TRUE(part);
    const std::uint32_t budget = core::budgetOf(level).particle_count;
    EXPECT_LE(part->count, budget);
    EXPECT_GT(part->count, budget * 9 / 10);
    // The drawn volume stays the same.
    EXPECT_NEAR(std::pow(part->radius_m / full->radius_m, 3) * part->count, full->count, 1.0);
    const std::set<Words> words = particlesOf(*part);
    EXPECT_EQ(words.size(), part->count) << "each of them once";
    EXPECT_TRUE(std::ranges::includes(within, words)) << "level " << indexOf(level);
    within = words;
  }

  // Full frames are in the order of the state, which has the ids.
  const auto idsOf = [&](const core::FrameView& of) {
    const std::vector<float> position = sim.copyState().position;
    const std::set<Words> chosen = particlesOf(*of.at(Level::kCoarse).particles);
    const core::ParticleView& particles = *of.at(Level::kFull).particles;
    std::set<float> ids;
    for (std::size_t i = 0; i < particles.count; ++i) {
      if (chosen.contains({particles.words[3 * i], particles.words[3 * i + 1], particles.words[3 * i + 2]}))
        ids.insert(position[4 * i + 3]);
    }
    return ids;
  };
  const std::set<float> before = idsOf(view);
  for (int tick = 0; tick < 3; ++tick) sim.step();
  EXPECT_EQ(idsOf(frame(sim, everyLevel())), before);
}

}  // namespace
}  // namespace spindrift::sim
