#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include <spindrift/study_suites/chart.h>

namespace spindrift::study_suites {
namespace {

constexpr double kWidth = 720.0;
constexpr double kHeight = 460.0;
constexpr double kLeft = 70.0;
constexpr double kRight = 20.0;
constexpr double kTop = 44.0;
constexpr double kBottom = 56.0;
/// Dark enough for print, and distinguishable for readers with red-green colour blindness (Okabe & Ito 2008).
constexpr std::array<const char*, 6> kColors = {"#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#7a5c00"};

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

/// One axis: values to a place on the page.
class Scale {
 public:
  Scale(const Chart::Axis& axis, double low, double high, double from, double to)
      : is_logarithmic_(axis.is_logarithmic), from_(from), to_(to) {
    low_ = transformed(low);
    high_ = transformed(high);
    if (high_ - low_ < 1e-9) {
      low_ -= 0.5;
      high_ += 0.5;
    }
    const double margin = 0.06 * (high_ - low_);
    low_ -= margin;
    high_ += margin;
  }

  [[nodiscard]] bool has(double value) const { return std::isfinite(value) && (!is_logarithmic_ || value > 0); }
  [[nodiscard]] double place(double value) const {
    return from_ + (to_ - from_) * (transformed(value) - low_) / (high_ - low_);
  }
  [[nodiscard]] bool contains(double value) const {
    return has(value) && transformed(value) >= low_ && transformed(value) <= high_;
  }

  /// Round values inside: 1, 2, 5 times powers of ten.
  [[nodiscard]] std::vector<double> ticks() const {
    std::vector<double> out;
    if (is_logarithmic_) {
      for (int power = static_cast<int>(std::floor(low_)); power <= static_cast<int>(std::ceil(high_)); ++power) {
        for (const double digit : {1.0, 2.0, 5.0}) {
          const double value = digit * std::pow(10.0, power);
          if (contains(value)) out.push_back(value);
        }
      }
      return out;
    }
    const double raw = (high_ - low_) / 6;
    const double power = std::pow(10.0, std::floor(std::log10(raw)));
    const double step = power * (raw / power < 1.5 ? 1 : raw / power < 3.5 ? 2 : raw / power < 7.5 ? 5 : 10);
    for (double value = std::ceil(low_ / step) * step; value <= high_ + 1e-9 * step; value += step)
      out.push_back(std::abs(value) < 1e-9 * step ? 0.0 : value);
    return out;
  }

 private:
  [[nodiscard]] double transformed(double value) const { return is_logarithmic_ ? std::log10(value) : value; }

  bool is_logarithmic_;
  double from_, to_;
  double low_ = 0.0, high_ = 1.0;
};

Scale scaleOf(const Chart& chart, bool along_x, double from, double to) {
  const Chart::Axis& axis = along_x ? chart.x : chart.y;
  double low = HUGE_VAL;
  double high = -HUGE_VAL;
  for (const Chart::Series& series : chart.series) {
    for (const Chart::Point& point : series.points) {
      const double value = along_x ? point.x : point.y;
      if (!std::isfinite(value) || (axis.is_logarithmic && value <= 0)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  if (low > high) low = high = 1.0;
  return {axis, low, high, from, to};
}

void drawFrame(const Chart& chart, const Scale& x, const Scale& y, std::string& svg) {
  for (const double tick : x.ticks()) {
    svg += fmt::format(
        "<path d='M{0:.1f} {1:.1f}V{2:.1f}' stroke='#ddd'/><text x='{0:.1f}' y='{3:.1f}' "
        "text-anchor='middle'>{4:g}</text>\n",
        x.place(tick), kTop, kHeight - kBottom, kHeight - kBottom + 16, tick);
  }
  for (const double tick : y.ticks()) {
    svg += fmt::format(
        "<path d='M{0:.1f} {1:.1f}H{2:.1f}' stroke='#ddd'/><text x='{3:.1f}' y='{4:.1f}' "
        "text-anchor='end'>{5:g}</text>\n",
        kLeft, y.place(tick), kWidth - kRight, kLeft - 6, y.place(tick) + 4, tick);
  }
  svg += fmt::format("<rect x='{}' y='{}' width='{}' height='{}' fill='none' stroke='#333'/>\n", kLeft, kTop,
                     kWidth - kLeft - kRight, kHeight - kTop - kBottom);
  svg += fmt::format("<text x='{}' y='20' text-anchor='middle' font-size='15'>{}</text>\n", kWidth / 2,
                     escaped(chart.title));
  svg += fmt::format("<text x='{}' y='{}' text-anchor='middle'>{}</text>\n", (kLeft + kWidth - kRight) / 2,
                     kHeight - 16, escaped(chart.x.label));
  svg += fmt::format("<text transform='translate(16 {}) rotate(-90)' text-anchor='middle'>{}</text>\n",
                     (kTop + kHeight - kBottom) / 2, escaped(chart.y.label));
  if (chart.vertical_line && x.contains(chart.vertical_line->at)) {
    const double at = x.place(chart.vertical_line->at);
    svg += fmt::format(
        "<path d='M{0:.1f} {1}V{2}' stroke='#333' stroke-dasharray='5 4'/><text x='{3:.1f}' y='{4}'>{5}</text>\n", at,
        kTop, kHeight - kBottom, at + 4, kHeight - kBottom - 6, escaped(chart.vertical_line->label));
  }
}

void drawSeries(const Chart::Series& series, const Scale& x, const Scale& y, const char* color, std::string& svg) {
  using Mark = Chart::Mark;
  std::string path, dots, labels;
  for (const Chart::Point& point : series.points) {
    if (!x.has(point.x) || !y.has(point.y)) continue;
    const double px = x.place(point.x);
    const double py = y.place(point.y);
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", px, py);
    if (series.mark != Mark::kLine)
      dots += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='{}'/>", px, py, series.mark == Mark::kLargeDot ? 5 : 3);
    if (point.label.empty()) continue;
    const bool at_right = px > kWidth - kRight - 7.0 * static_cast<double>(point.label.size());
    labels += fmt::format("<text x='{:.1f}' y='{:.1f}' font-size='11' text-anchor='{}'>{}</text>",
                          px + (at_right ? -7 : 7), py - 6, at_right ? "end" : "start", escaped(point.label));
  }
  const bool has_line = series.mark == Mark::kLine || series.mark == Mark::kLineAndDots;
  if (has_line && !path.empty())
    svg += fmt::format("<path d='{}' fill='none' stroke='{}' stroke-width='1.5'/>\n", path, color);
  svg += fmt::format("<g fill='{0}'>{1}{2}</g>\n", color, dots, labels);
}

void drawLegend(const Chart& chart, std::string& svg) {
  double at = kLeft;
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    const char* color = kColors[i % kColors.size()];
    svg += fmt::format(
        "<rect x='{0:.1f}' y='{1}' width='12' height='4' fill='{2}'/><text x='{3:.1f}' y='{4}'>{5}</text>\n", at,
        kTop - 14, color, at + 16, kTop - 8, escaped(chart.series[i].name));
    at += 32 + 7.0 * static_cast<double>(chart.series[i].name.size());
  }
}

}  // namespace

std::string drawChart(const Chart& chart) {
  const Scale x = scaleOf(chart, true, kLeft, kWidth - kRight);
  const Scale y = scaleOf(chart, false, kHeight - kBottom, kTop);
  std::string svg = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0} {1}' width='{0}' height='{1}' font-family='sans-serif' "
      "font-size='12' fill='#222'>\n<rect width='{0}' height='{1}' fill='#fff'/>\n",
      kWidth, kHeight);
  drawFrame(chart, x, y, svg);
  for (std::size_t i = 0; i < chart.series.size(); ++i)
    drawSeries(chart.series[i], x, y, kColors[i % kColors.size()], svg);
  drawLegend(chart, svg);
  return svg + "</svg>\n";
}

core::Result<void> writeChart(const std::string& folder, const std::string& file, const Chart& chart) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  const std::filesystem::path path = std::filesystem::path(folder) / file;
  std::ofstream out(path);
  out << drawChart(chart);
  if (!out.flush())
    return core::Error{core::ErrorCode::kUnavailable,
                       "--plot '" + path.string() + "': cannot be written: choose another folder"};
  return {};
}

}  // namespace spindrift::study_suites
