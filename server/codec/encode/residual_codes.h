// Writers for the fixed codes of residuals.
#pragma once

#include <vector>

#include "format/residual_format.h"
#include "prefix_code.h"

namespace spindrift::codec {

/// The writers of all fixed codes.
struct ResidualWriters {
  std::vector<PrefixWriter> of_class;       ///< [c - 5], c = 5..17
  std::vector<PrefixWriter> of_class_step;  ///< one per code of the class step: three
  [[nodiscard]] const PrefixWriter& ofClass(std::uint32_t c) const { return of_class[c - kLastSparseClass - 1]; }
};
const ResidualWriters& residualWriters();

}  // namespace spindrift::codec
