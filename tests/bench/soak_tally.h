// What the clients of the soak count.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>

#include <spindrift/v1/wire.pb.h>

namespace spindrift::bench {

/// Delays from 0.01 ms to 10^5 ms in buckets that are 2 % wide: its size does not depend on their number.
class DelayHistogram {
 public:
  void note(double delay_ms) {
    const double bucket = std::log(std::max(delay_ms, kLeast_ms) / kLeast_ms) / std::log(kRatio);
    ++counts_[std::min(counts_.size() - 1, static_cast<std::size_t>(bucket))];
    ++count_;
    most_ms_ = std::max(most_ms_, delay_ms);
  }
  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] double most_ms() const { return most_ms_; }
  /// Upper bound of the bucket of the quantile; 0 without delays.
  [[nodiscard]] double quantile_ms(double ratio) const {
    const auto rank = static_cast<std::uint64_t>(ratio * static_cast<double>(count_));
    std::uint64_t below = 0;
    for (std::size_t k = 0; k < counts_.size(); ++k) {
      below += counts_[k];
      if (below > rank) return std::min(most_ms_, kLeast_ms * std::pow(kRatio, static_cast<double>(k + 1)));
    }
    return most_ms_;
  }

 private:
  static constexpr double kLeast_ms = 0.01;
  static constexpr double kRatio = 1.02;
  std::array<std::uint64_t, 815> counts_{};
  std::uint64_t count_ = 0;
  double most_ms_ = 0.0;
};

struct SoakTally {
  DelayHistogram answers;        ///< from command to Ack: strokes and steering
  DelayHistogram heavy_answers;  ///< of boats that come and go, which may wait for the room's budget of time
  std::uint64_t sent_count = 0;
  std::uint64_t unanswered_count = 0;  ///< not answered within kAnswerPatience on an open connection
  std::uint64_t cut_count = 0;         ///< not answered when the connection ended
  std::map<v1::RejectReason, std::uint64_t> rejected;
  std::uint64_t reconnect_count = 0;   ///< connections that clients ended
  std::uint64_t resumed_count = 0;     ///< people who were the same again
  std::map<int, std::uint64_t> ended;  ///< by the other side, by close code; 0: broken
  std::uint64_t refused_count = 0;     ///< connections that never opened
  std::uint64_t bytes_count = 0;
  std::uint64_t frame_count = 0;
  double longest_gap_ms = 0.0;                 ///< between two frames of a client, of any layer
  std::uint64_t decoded_count = 0;             ///< frames
  std::uint64_t undecodable_count = 0;         ///< frames that were wrong
  std::uint64_t nonfinite_count = 0;           ///< numbers in them and in diagnostics
  std::uint64_t watchdog_nonfinite_count = 0;  ///< largest that a diagnostics message had
};

}  // namespace spindrift::bench
