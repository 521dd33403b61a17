// Numbers of 16 bits: the values that binary16 has, and their bits.
#include <cmath>

#include <gtest/gtest.h>

#include <spindrift/core/half.h>

namespace spindrift::core {
namespace {

TEST(Halves, HaveTheBitsOfBinary16) {
  EXPECT_EQ(packHalves(1.0, -2.0), 0xc000'3c00u);
  EXPECT_EQ(packHalves(0.0, 65504.0), 0x7bff'0000u);
  EXPECT_EQ(packHalves(std::ldexp(1.0, -24), std::ldexp(1.0, -14)),
            0x0400'0001u);  // the least of all, the least normal one
  EXPECT_EQ(packHalves(0.333251953125, 0.5), 0x3800'3555u);
}

TEST(Halves, RoundToTheNearestWithTiesToEven) {
  EXPECT_EQ(roundToHalf(1.0 + 1.0 / 2048), 1.0);
  EXPECT_EQ(roundToHalf(1.0 + 3.0 / 2048), 1.0 + 2.0 / 1024);
  EXPECT_EQ(roundToHalf(-1.0 / 3.0), -0.333251953125);
  EXPECT_EQ(roundToHalf(1.99999), 2.0);
  EXPECT_EQ(packHalves(1.99999, 0.0), 0x4000u);
  EXPECT_EQ(roundToHalf(1e-9), 0.0);
}

TEST(Halves, StayFinite) {
  EXPECT_EQ(roundToHalf(1e9), kLargestHalf);
  EXPECT_EQ(roundToHalf(-65519.0), -kLargestHalf);
  EXPECT_EQ(packHalves(1e300, -1e300), 0xfbff'7bffu);
}

}  // namespace
}  // namespace spindrift::core
