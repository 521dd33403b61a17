#include <gmock/gmock.h>

#include <spindrift/script/junit.h>

namespace spindrift::script {
namespace {

using testing::HasSubstr;
using testing::Not;

ScriptReport threeSteps() {
  ScriptReport report;
  report.step_count = 3;
  report.steps.push_back({.index = 0,
                          .client = "ada",
                          .what = "command splash",
                          .note = "",
                          .passed = true,
                          .detail = "",
                          .took_s = 0.25});
  report.steps.push_back({.index = 1,
                          .client = "<ada>",
                          .what = "surface",
                          .note = "\"5\" < 6 & more",
                          .passed = false,
                          .detail = "elevation 0.1 m;\nwanted > 0.2\x01\xff",
                          .took_s = 0.5});
  return report;
}

TEST(Junit, CountsWhatPassedFailedAndWasSkipped) {
  const std::string xml = toJunit(threeSteps(), "pier");
  EXPECT_THAT(xml, testing::StartsWith("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites tests=\"3\""));
  EXPECT_THAT(xml, HasSubstr("<testsuite name=\"pier\" tests=\"3\" failures=\"1\" errors=\"0\" skipped=\"1\" "
                             "time=\"0.750\">"));
  EXPECT_THAT(xml, HasSubstr("<testcase classname=\"pier\" name=\"0 command splash\" time=\"0.250\"/>"));
  EXPECT_THAT(xml, HasSubstr("name=\"2\"><skipped message=\"an earlier step failed\"/></testcase>"));
  EXPECT_THAT(xml, Not(HasSubstr("<properties>"))) << "no clock was held";
}

TEST(Junit, TextIsEscapedForXml) {
  const std::string xml = toJunit(threeSteps(), "a \"b\" <c>");
  EXPECT_THAT(xml, HasSubstr("name=\"a &quot;b&quot; &lt;c&gt;\""));
  EXPECT_THAT(xml, HasSubstr("name=\"1 surface: &quot;5&quot; &lt; 6 &amp; more\""));
  EXPECT_THAT(xml, HasSubstr("<failure message=\"&lt;ada&gt;: elevation 0.1 m; wanted &gt; 0.2?"));
  for (const char c : xml) EXPECT_TRUE(static_cast<unsigned char>(c) >= 0x20 || c == '\n') << static_cast<int>(c);
  EXPECT_EQ(xml.find('\xff'), std::string::npos) << "it is UTF-8";
}

TEST(Junit, HasTheHashOfAHeldScript) {
  ScriptReport report = threeSteps();
  report.held = HeldReport{
      .seed = 7, .tick_count = 300, .made_s = 5.0, .state_hash = 0x0123456789abcdefull, .recovered_count = 0};
  const std::string xml = toJunit(report, "pier");
  EXPECT_THAT(xml, HasSubstr("<property name=\"state_hash\" value=\"0x0123456789abcdef\"/>"));
  EXPECT_THAT(xml, HasSubstr("<property name=\"seed\" value=\"7\"/>"));
  EXPECT_THAT(xml, HasSubstr("<property name=\"ticks\" value=\"300\"/>"));
}

}  // namespace
}  // namespace spindrift::script
