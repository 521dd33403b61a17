// A chart of points and lines as SVG, black and a few colours that stay apart in print.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <spindrift/core/result.h>

namespace spindrift::study_suites {

struct Chart {
  struct Axis {
    std::string label;  ///< with the unit
    bool is_logarithmic = false;
  };
  struct Point {
    double x = 0.0;
    double y = 0.0;
    std::string label;  ///< written beside it; empty: none
  };
  enum class Mark { kLine, kDot, kLargeDot, kLineAndDots };
  struct Series {
    std::string name;
    std::vector<Point> points;
    Mark mark = Mark::kLineAndDots;
  };
  struct Line {
    double at = 0.0;
    std::string label;
  };

  std::string title;
  Axis x, y;
  std::vector<Series> series;
  std::optional<Line> vertical_line;
};

/// The SVG's text. Points that are not finite, or not positive on a logarithmic axis, are left out.
std::string drawChart(const Chart& chart);

/// Writes it to `file` in `folder`, which is made where it is missing. kUnavailable where that fails.
core::Result<void> writeChart(const std::string& folder, const std::string& file, const Chart& chart);

}  // namespace spindrift::study_suites
