// Curves and fields of a case, beside its table; tests/study/draw_charts.py draws them.
#pragma once

#include <cstddef>
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

/// Fields on the same cells, drawn side by side in the same colours.
struct FieldFigure {
  struct Panel {
    std::string name;
    std::vector<double> values;  ///< x fastest
  };

  std::string name;  ///< one word with dashes
  std::string title;
  std::string unit;
  std::size_t columns_count = 0;
  double cell_m = 0.0;
  double first_x_m = 0.0, first_z_m = 0.0;  ///< corner of the part that is shown
  std::vector<Panel> panels;
};

}  // namespace spindrift::study
