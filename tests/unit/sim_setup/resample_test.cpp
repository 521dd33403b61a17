// Fields moved between grids: what stays the same, and how close they come back.
#include <cmath>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include <spindrift/core/random.h>
#include <spindrift/sim_setup/resample.h>

namespace spindrift::sim {
namespace {

constexpr SampleAxis kPeriodic{.is_periodic = true};
constexpr SampleAxis kSides{};

Field allWet(std::uint32_t n, const auto& value) {
  Field out{std::vector<double>(std::size_t{n} * n), std::vector<double>(std::size_t{n} * n, 1.0)};
  for (std::uint32_t z = 0; z < n; ++z)
    for (std::uint32_t x = 0; x < n; ++x) out.mean[x + std::size_t{n} * z] = value((x + 0.5) / n, (z + 0.5) / n);
  return out;
}

/// Over a square of side 1.
double integral(const Field& field) {
  double sum = 0.0;
  for (std::size_t i = 0; i < field.mean.size(); ++i) sum += field.mean[i] * field.share[i];
  return sum / static_cast<double>(field.mean.size());
}

/// Rough values, a dry block and a dry wall of one cell.
Field roughWithWalls(std::uint32_t n) {
  core::SplitMix64 random(7);
  Field out = allWet(n, [&](double, double) { return random.symmetric(); });
  for (std::uint32_t z = 0; z < n; ++z) {
    for (std::uint32_t x = 0; x < n; ++x) {
      const bool is_dry = (x > n / 5 && x < n / 3 && z > n / 2) || x == n / 2;
      if (is_dry) out.mean[x + std::size_t{n} * z] = out.share[x + std::size_t{n} * z] = 0.0;
    }
  }
  return out;
}

TEST(Resample, KeepsTheIntegralOverTheWetArea) {
  for (const auto& [from_count, to_count] : {std::pair{64u, 32u}, {32u, 80u}, {48u, 112u}, {160u, 96u}, {33u, 64u}}) {
    const Field from = roughWithWalls(from_count);
    for (const SampleAxis axis : {kPeriodic, kSides}) {
      const Field to = resample(from, {from_count, from_count}, {to_count, to_count}, axis, kSides);
      EXPECT_NEAR(integral(to), integral(from), 1e-12) << from_count << " to " << to_count;
      const auto [low, high] = std::ranges::minmax(from.mean);
      for (std::size_t i = 0; i < to.mean.size(); ++i) {
        ASSERT_GE(to.mean[i], low - 1e-12);
        ASSERT_LE(to.mean[i], high + 1e-12);
        ASSERT_GE(to.share[i], 0.0);
        ASSERT_LE(to.share[i], 1.0);
      }
    }
  }
}

TEST(Resample, LeavesAnEvenFieldEvenBesideWalls) {
  Field from = roughWithWalls(60);
  for (std::size_t i = 0; i < from.mean.size(); ++i) from.mean[i] = from.share[i] > 0 ? 0.125 : 0.0;
  const Field to = resample(from, {60, 60}, {144, 144}, kSides, kPeriodic);
  for (std::size_t i = 0; i < to.mean.size(); ++i) {
    if (to.share[i] > 0) {
      ASSERT_NEAR(to.mean[i], 0.125, 1e-13);
    }
  }
}

TEST(Resample, BringsLongWavesBack) {
  // Root mean square of what is missing after finer -> coarser -> finer, over that of the wave.
  const auto lossOf = [](double length_coarse_cells) {
    constexpr std::uint32_t kFine = 192, kCoarse = 128;
    const double k = 2 * std::numbers::pi * std::round(kCoarse / length_coarse_cells);
    const Field wave = allWet(kFine, [k](double x, double z) { return std::cos(k * x) + std::cos(k * z + 0.4); });
    const Field back = resample(resample(wave, {kFine, kFine}, {kCoarse, kCoarse}, kPeriodic, kPeriodic),
                                {kCoarse, kCoarse}, {kFine, kFine}, kPeriodic, kPeriodic);
    double missing = 0.0, held = 0.0;
    for (std::size_t i = 0; i < wave.mean.size(); ++i) {
      missing += std::pow(back.mean[i] - wave.mean[i], 2);
      held += std::pow(wave.mean[i], 2);
    }
    return std::sqrt(missing / held);
  };
  EXPECT_LT(lossOf(64), 0.002);
  EXPECT_LT(lossOf(32), 0.005);
  EXPECT_LT(lossOf(16), 0.02);
  EXPECT_LT(lossOf(8), 0.08);
}

TEST(Resample, MovesTheFieldsOfFacesByHalfACell) {
  // x faces lie at (i + 1)/n. A straight line inside, far from where it wraps.
  constexpr std::uint32_t kFrom = 96, kTo = 64;
  const SampleAxis faces{.shift_cells = 0.5};
  Field from = allWet(kFrom, [](double x, double z) { return 3 * (x + 0.5 / kFrom) + z; });
  const Field to = resample(from, {kFrom, kFrom}, {kTo, kTo}, faces, kSides);
  for (std::uint32_t z = 4; z < kTo - 4; ++z)
    for (std::uint32_t x = 4; x < kTo - 4; ++x)
      ASSERT_NEAR(to.mean[x + std::size_t{kTo} * z], 3 * (x + 1.0) / kTo + (z + 0.5) / kTo, 1e-12);
}

TEST(Resample, CellsThatWereDryGetTheWaterBesideThem) {
  Field field{{1.0, 2.0, 0.0, 0.0}, {1.0, 1.0, 0.0, 0.3}};
  const std::vector<char> wet = {1, 1, 1, 0};
  settleOn(wet, {2, 2}, false, false, field);
  EXPECT_EQ(field.mean, (std::vector<double>{1.0, 2.0, 1.0, 0.0}));
  EXPECT_EQ(field.share, (std::vector<double>{1.0, 1.0, 1.0, 0.0}));
}

TEST(Resample, PoolsThatNoWaterReachesAreLevel) {
  Field field{std::vector<double>(16, 0.0), std::vector<double>(16, 0.0)};
  const std::vector<char> wet(16, 1);
  settleOn(wet, {4, 4}, true, true, field);
  EXPECT_EQ(field.mean, std::vector<double>(16, 0.0));
}

TEST(Resample, WholeNumbersKeepTheirSum) {
  core::SplitMix64 random(3);
  std::vector<double> values(1000);
  std::vector<char> wet(1000);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = 1e7 * random.symmetric();
    wet[i] = i % 7 != 0 ? 1 : 0;
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) sum += wet[i] ? values[i] : 0.0;
  for (const std::int64_t change : {0, 1, -12345}) {
    const std::int64_t total = std::llround(sum) + change;
    const auto whole = wholeWithTotal(values, wet, total);
    EXPECT_EQ(std::accumulate(whole.begin(), whole.end(), std::int64_t{0}), total);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double wanted = wet[i] ? values[i] + static_cast<double>(change) / 857 : 0.0;
      EXPECT_NEAR(static_cast<double>(whole[i]), wanted, wet[i] ? 2.0 : 0.0);
    }
  }
}

TEST(Resample, ALevelStaysLevelToTheUnit) {
  const std::vector<double> values(5000, 12.25);
  const std::vector<char> wet(5000, 1);
  for (const std::int64_t units : wholeWithTotal(values, wet, 61'250)) {
    EXPECT_GE(units, 12);
    EXPECT_LE(units, 13);
  }
  for (const std::int64_t units : wholeWithTotal(std::vector<double>(5000, 0.0), wet, 0)) EXPECT_EQ(units, 0);
}

}  // namespace
}  // namespace spindrift::sim
