// Curves of a case, beside its table; server/study/draw_charts.py draws them.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace spindrift::study {

struct Figure {
  struct Curve {
    std::string name;
    std::vector<std::pair<double, double>> points;
    bool is_measured = false;  ///< points of an experiment; otherwise a computed line
  };

  std::string name;  ///< one word with dashes
  std::string title;
  std::string x_label, y_label;  ///< with units
  bool is_logarithmic = false;   ///< both axes
  std::vector<Curve> curves;
};

}  // namespace spindrift::study
