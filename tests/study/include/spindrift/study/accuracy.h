// Cases with a known result (ARCHITECTURE, "Study"): theory, experiment, or conservation.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/gpu/context.h>
#include <spindrift/study/figure.h>
#include <spindrift/study/row.h>

namespace spindrift::study {

struct CaseResult {
  std::vector<Row> rows;
  std::vector<Figure> figures;
  std::vector<FieldFigure> fields = {};
};

struct Case {
  std::string name;     ///< one word with dashes, as for --case
  std::string purpose;  ///< one line
  /// `quick`: shorter runs and coarser water, for a table within minutes; the tolerances are the same.
  std::function<core::Result<CaseResult>(gpu::Context& ctx, bool quick)> run;
};

/// Returns all cases in the order of the table.
const std::vector<Case>& accuracyCases();

}  // namespace spindrift::study
