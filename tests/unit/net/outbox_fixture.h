// What the tests of an outbox share.
#pragma once

#include <chrono>
#include <string>

#include <gtest/gtest.h>

#include "outbox.h"
#include "test_application.h"

namespace spindrift::net {

inline constexpr double kAnyRate_hz = 1e9;

/// Returns a time one second after the last call, so that no rate limit applies.
inline Clock::time_point later() {
  static Clock::time_point now{};
  return now += std::chrono::seconds(1);
}

inline Outbox::Kind kind(Outbox& outbox) {
  return outbox.next().kind;
}

inline std::string textOf(const core::SharedBytes& bytes) {
  return bytes ? std::string(bytes->begin(), bytes->end()) : "nothing";
}

inline std::string sentText(Outbox& outbox) {
  return textOf(outbox.next().message);
}

class OutboxTest : public testing::Test {
 protected:
  void watch(StreamIndex stream) { outbox.setWatch(stream, Watch{.max_rate_hz = kAnyRate_hz}); }

  Outbox outbox{8};
};

}  // namespace spindrift::net
