#include "rate_limit.h"

#include <gtest/gtest.h>

namespace spindrift::net {
namespace {

using std::chrono::duration;
using std::chrono::milliseconds;

Clock::time_point at(double time_s) {
  return Clock::time_point(std::chrono::duration_cast<Clock::duration>(duration<double>(100.0 + time_s)));
}

/// Number of frames that pass out of `count` frames at `rate_hz`, every second one late by `jitter_s`.
int passed(RateGate gate, int count, double rate_hz, double jitter_s = 0.0) {
  int out = 0;
  for (int k = 0; k < count; ++k) out += gate.pass(at(k / rate_hz + (k % 2) * jitter_s));
  return out;
}

TEST(RateGate, PassesAStreamAtItsOwnRateWhole) {
  EXPECT_EQ(passed(RateGate(30.0), 300, 30.0), 300);
}

TEST(RateGate, PassesAJitteryStreamAtItsOwnRateWhole) {
  EXPECT_EQ(passed(RateGate(30.0), 300, 30.0, 0.010), 300);
}

TEST(RateGate, PassesAStreamThatIsNinePercentFasterWhole) {
  EXPECT_EQ(passed(RateGate(30.0), 300, 32.7), 300);
}

TEST(RateGate, TakesEverySecondFrameOfADoubledRate) {
  RateGate gate(30.0);
  for (int k = 0; k < 100; ++k) EXPECT_EQ(gate.pass(at(k / 60.0)), k % 2 == 0) << "frame " << k;
}

TEST(RateGate, KeepsAFastStreamWithinTenPercentOfTheRate) {
  const int ten_seconds = passed(RateGate(20.0), 10'000, 1000.0);
  EXPECT_LE(ten_seconds, 221);
  EXPECT_GE(ten_seconds, 200);
}

TEST(RateGate, SavesNothingUpDuringAPause) {
  RateGate gate(10.0);
  EXPECT_TRUE(gate.pass(at(0.0)));
  EXPECT_TRUE(gate.pass(at(60.0)));
  EXPECT_FALSE(gate.pass(at(60.01)));
}

TEST(TokenBucket, AllowsTheBurstAndThenTheRate) {
  TokenBucket bucket(10.0, 5.0, at(0.0));
  for (int k = 0; k < 5; ++k) EXPECT_TRUE(bucket.take(at(0.0)));
  EXPECT_FALSE(bucket.take(at(0.0)));
  EXPECT_FALSE(bucket.take(at(0.09)));
  EXPECT_TRUE(bucket.take(at(0.11)));
  EXPECT_FALSE(bucket.take(at(0.12)));
}

TEST(TokenBucket, HoldsNoMoreThanTheBurst) {
  TokenBucket bucket(10.0, 3.0, at(0.0));
  int taken = 0;
  while (bucket.take(at(3600.0))) ++taken;
  EXPECT_EQ(taken, 3);
}

}  // namespace
}  // namespace spindrift::net
