// The fixed codes of residuals to write with.
#pragma once

#include <vector>

#include "format/residual_format.h"
#include "prefix_code.h"

namespace spindrift::codec {

/// Writer of every code.
struct ResidualWriters {
  std::vector<PrefixWriter> of_class;       ///< [c - 5], c = 5..17
  std::vector<PrefixWriter> of_class_step;  ///< three
  [[nodiscard]] const PrefixWriter& ofClass(std::uint32_t c) const { return of_class[c - kLastSparseClass - 1]; }
};
const ResidualWriters& residualWriters();

}  // namespace spindrift::codec
