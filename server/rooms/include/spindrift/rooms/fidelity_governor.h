// Decides when a room's fidelity falls by a level because the machine cannot keep up, and when it rises again. A pure
// function of what it is told, so that tests need no clock.
#pragma once

#include <functional>

namespace spindrift::rooms {

/// It falls soon and rises late, and each rise that did not hold makes the next one wait twice as long, so a room at
/// the limit of its machine does not change to and fro.
class FidelityGovernor {
 public:
  enum class Step { kNone, kDown, kUp };

  /// Time runs at less than this share of the wanted speed: the machine cannot keep up.
  static constexpr double kSlowPace = 0.9;
  /// It falls after this time. [s]
  static constexpr double kSlowPatience_s = 5.0;
  /// Pace from which on the room counts as keeping up.
  static constexpr double kFullPace = 0.95;
  /// It rises at the earliest after this time at full pace; doubled for each rise that did not hold. [s]
  static constexpr double kCalmPatience_s = 30.0;
  static constexpr double kCalmPatienceMax_s = 960.0;
  /// Largest share of the thread's time that it may be busy at the level above, by prediction.
  static constexpr double kLoadMax = 0.7;
  /// A rise has held if the level did not fall within this time. [s]
  static constexpr double kHolds_s = 120.0;
  /// After a change, and after other water was built, nothing is decided for this time. [s]
  static constexpr double kSettle_s = 5.0;

  struct Observation {
    double now_s = 0.0;     ///< wall time, monotonic
    double pace = 0.0;      ///< simulated seconds per wall second over the wanted ones; 0: not known (paused, started)
    bool can_fall = false;  ///< there is a coarser level
    bool can_rise = false;  ///< there is a finer level, and it is allowed
    bool is_building = false;  ///< water is being built on this machine
  };
  /// Returns what to do now; call changed() or failed() when it is done. `load_above` predicts how busy the thread
  /// would be at the level above (1: all of its time); it is called only if everything else speaks for a rise.
  Step note(const Observation& seen, const std::function<double()>& load_above);
  /// The level has changed by this step; kNone: by a person, or with the scene.
  void changed(double now_s, Step step);
  /// The step could not be made: nothing is decided for calmPatience_s(), which is doubled.
  void failed(double now_s);

  /// Time at full pace after which it may rise. [s]
  [[nodiscard]] double calmPatience_s() const { return calm_patience_s_; }

 private:
  void settle(double from_s);

  double settled_s_ = 0.0;
  double slow_since_s_ = -1.0;  ///< negative: not slow
  double calm_since_s_ = -1.0;  ///< negative: not calm
  double rose_s_ = -1.0;        ///< time of the last rise; negative: none, or it has held
  double calm_patience_s_ = kCalmPatience_s;
};

}  // namespace spindrift::rooms
