#include <gtest/gtest.h>

#include <spindrift/service/metrics.h>

namespace spindrift::service {
namespace {

TEST(MetricLabel, PlainValuesStayAsTheyAre) {
  EXPECT_EQ(metricLabel("room", "quay-2"), R"(room="quay-2")");
  EXPECT_EQ(metricLabel("room", "Länd (copy)"), "room=\"Länd (copy)\"");
}

TEST(MetricLabel, QuotesBackslashesAndLineBreaksAreEscaped) {
  EXPECT_EQ(metricLabel("room", "q\"} 1"), "room=\"q\\\"} 1\"");
  EXPECT_EQ(metricLabel("room", "two\nlines\\"), "room=\"two\\nlines\\\\\"");
}

TEST(MetricLabel, InvalidUtf8IsReplaced) {
  EXPECT_EQ(metricLabel("room",
                        "a\xff"
                        "b"),
            "room=\"a\xEF\xBF\xBD"
            "b\"");
}

}  // namespace
}  // namespace spindrift::service
