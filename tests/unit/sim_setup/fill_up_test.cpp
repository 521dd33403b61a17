
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include <spindrift/sim_setup/fill_up.h>

namespace spindrift::sim {
namespace {

std::int64_t sumOf(const std::vector<std::int32_t>& units) {
  return std::accumulate(units.begin(), units.end(), std::int64_t{0});
}

TEST(FillUp, DoesNotChangeWaterAboveItsBed) {
  const std::vector<std::int64_t> bed = {100, 100, 0};
  std::vector<std::int32_t> eta = {-100, 7, -5};  // empty, full, dry ground
  const std::vector<std::int32_t> before = eta;
  EXPECT_FALSE(fillUp(bed, eta, Lack::kComesFromOutside).is_changed);
  EXPECT_EQ(eta, before);
}

TEST(FillUp, RaisesCellsToTheirBedAndKeepsTheVolume) {
  std::vector<std::int64_t> bed(1000, 1'000'003);
  std::vector<std::int32_t> eta(1000);
  for (std::size_t i = 0; i < eta.size(); ++i) eta[i] = static_cast<std::int32_t>(i * 7919 % 4'000'000) - 2'000'000;
  const std::int64_t before = sumOf(eta);
  const FillUp filled = fillUp(bed, eta, Lack::kComesFromOutside);
  EXPECT_TRUE(filled.is_changed);
  EXPECT_EQ(filled.from_outside_units, 0);
  EXPECT_EQ(sumOf(eta), before);
  for (const std::int32_t units : eta) EXPECT_GE(units, -1'000'003);
}

TEST(FillUp, TakesMissingWaterFromOutside) {
  const std::vector<std::int64_t> bed = {100, 100};
  std::vector<std::int32_t> eta = {-350, -20};  // 250 missing, 80 available
  std::vector<std::int32_t> closed = eta;
  const FillUp filled = fillUp(bed, eta, Lack::kComesFromOutside);
  EXPECT_EQ(filled.from_outside_units, 170);
  EXPECT_EQ(eta, (std::vector<std::int32_t>{-100, -100}));
  EXPECT_FALSE(fillUp(bed, closed, Lack::kStays).is_changed);
  EXPECT_EQ(closed, (std::vector<std::int32_t>{-350, -20}));
}

TEST(FillUp, BedsOfAHundredMetresFitTheirUnits) {
  EXPECT_EQ(bedUnits(100.0), 1'677'721'600);
  EXPECT_EQ(bedUnits(0.0), 0);
  std::vector<std::int32_t> eta = {-2'147'483'647, 2'147'483'647};
  const std::vector<std::int64_t> bed = {bedUnits(100.0), bedUnits(100.0)};
  EXPECT_EQ(fillUp(bed, eta, Lack::kStays).from_outside_units, 0);
  EXPECT_EQ(sumOf(eta), 0);
  EXPECT_EQ(eta[0], -1'677'721'600);
}

}  // namespace
}  // namespace spindrift::sim
