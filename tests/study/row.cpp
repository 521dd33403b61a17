#include <cmath>

#include <spindrift/study/row.h>

namespace spindrift::study {

double Row::error() const {
  switch (kind) {
    case Tolerance::kRelative:
      return (measured - expected) / std::abs(expected);
    case Tolerance::kAbsolute:
      return measured - expected;
    case Tolerance::kAtMost:
    case Tolerance::kAtLeast:
    case Tolerance::kNone:
      break;
  }
  return measured;
}

bool Row::passes() const {
  if (!std::isfinite(measured)) return false;
  if (kind == Tolerance::kNone) return true;
  if (kind == Tolerance::kAtMost) return measured <= expected;
  if (kind == Tolerance::kAtLeast) return measured >= expected;
  return std::abs(error()) <= tolerance;
}

}  // namespace spindrift::study
