// The text of a chart.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/study_suites/chart.h>

namespace spindrift::study_suites {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::size_t countOf(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(Chart, NamesItsAxesSeriesAndPoints) {
  Chart chart;
  chart.title = "cost & error";
  chart.x = {"cost [ms]", true};
  chart.y = {"error [%]", false};
  chart.series = {{"levels", {{10, 1, "draft"}, {1000, 0.5, "<fine>"}}, Chart::Mark::kLineAndDots}};
  chart.vertical_line = {{100, "real time"}};
  const std::string svg = drawChart(chart);
  for (const char* part :
       {"cost &amp; error", "cost [ms]", "error [%]", "levels", "draft", "&lt;fine&gt;", "real time", ">100<"})
    EXPECT_THAT(svg, HasSubstr(part));
  EXPECT_EQ(countOf(svg, "<circle"), 2u);
}

TEST(Chart, LeavesOutWhatItCannotPlace) {
  Chart chart;
  chart.x = {"x", true};
  chart.y = {"y", true};
  chart.series = {{"s", {{0, 1, "zero"}, {1, NAN, "nan"}, {-1, 1, "negative"}, {2, 3, "here"}}, Chart::Mark::kDot}};
  const std::string svg = drawChart(chart);
  EXPECT_EQ(countOf(svg, "<circle"), 1u);
  EXPECT_THAT(svg, HasSubstr("here"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
}

TEST(Chart, IsDrawnWithoutPointsToo) {
  Chart chart;
  chart.title = "nothing";
  EXPECT_THAT(drawChart(chart), HasSubstr("</svg>"));
}

}  // namespace
}  // namespace spindrift::study_suites
