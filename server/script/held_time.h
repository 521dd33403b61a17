// The simulated time of a script that holds the clock of its room.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "script_client.h"

namespace spindrift::script {

/// Result of a step; empty: success.
struct Outcome {
  bool passed = false;
  std::string detail;
};

/// Makes the room's ticks through the client that holds its clock. A failure is the end of the script's time.
class HeldTime {
 public:
  /// Sends a command and returns its answer, or the outcome of the failure.
  using Ask = std::function<const v1::ServerMessage*(ScriptClient&, v1::Command, double patience_s, Outcome&)>;

  /// `holder` outlives it.
  HeldTime(ScriptClient& holder, std::uint64_t seed, Ask ask) : holder_(holder), seed_(seed), ask_(std::move(ask)) {}

  /// Takes the clock and starts the scene again. The holder is connected.
  Outcome begin();
  /// Makes the ticks up to this time since begin(); none if it has passed.
  Outcome advanceTo(double at_s);
  Outcome advanceBy(double duration_s);
  /// Makes a tick if a command has changed the water since the last one.
  Outcome settle();
  /// An answer to a command of any client: the water is not that of the last tick any more.
  void commandApplied(std::uint64_t tick);

  /// Returns the tick of the room after the newest tick or command.
  [[nodiscard]] std::uint64_t tick() const { return tick_; }
  [[nodiscard]] std::uint64_t madeCount() const { return made_count_; }
  [[nodiscard]] double made_s() const { return made_s_; }
  /// Returns the hash after the newest tick; nullopt before the first.
  [[nodiscard]] std::optional<std::uint64_t> hash() const { return hash_; }

 private:
  Outcome make(std::uint64_t tick_count);
  [[nodiscard]] double tick_s() const { return 1.0 / holder_.received.tick_rate_hz; }

  ScriptClient& holder_;
  const std::uint64_t seed_;
  const Ask ask_;
  std::uint64_t tick_ = 0;
  std::uint64_t made_count_ = 0;
  double made_s_ = 0.0;
  std::optional<std::uint64_t> hash_;
  bool has_changed_ = false;  ///< since the last tick
};

}  // namespace spindrift::script
