// One line of a study's table: a measured number beside the expected one.
#pragma once

#include <string>

namespace spindrift::study {

/// Meaning of the tolerance between `expected` and the measured value.
enum class Tolerance {
  kRelative,  ///< |measured - expected| <= tolerance * |expected|
  kAbsolute,  ///< |measured - expected| <= tolerance
  kAtMost,    ///< measured <= expected; tolerance is not used
  kAtLeast,   ///< measured >= expected; tolerance is not used
  kNone,      ///< reported only
};

struct Row {
  std::string name;  ///< the measured quantity and the choices of this row
  std::string unit;  ///< of measured and expected; empty for ratios
  double measured = 0.0;
  double expected = 0.0;
  Tolerance kind = Tolerance::kRelative;
  double tolerance = 0.0;
  std::string source;  ///< source of `expected`

  /// Returns the error in the unit of the tolerance: relative, absolute, or the measured value itself.
  [[nodiscard]] double error() const;
  [[nodiscard]] bool passes() const;
};

}  // namespace spindrift::study
