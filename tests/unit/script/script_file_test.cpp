#include <gmock/gmock.h>

#include <spindrift/script/script.h>

namespace spindrift::script {
namespace {

using testing::HasSubstr;

std::string errorOf(const std::string& text) {
  const auto script = parseScript(text, "test");
  return script ? "(accepted)" : script.error().message;
}

TEST(ScriptFile, ClockAndItsStepsAreRead) {
  const auto script = parseScript(R"(
    hold_clock: true
    seed: 18446744073709551615
    clients { name: "ada" }
    clients { name: "bob" }
    steps { at_s: 0.5 hash { save: "a" } }
    steps { client: "bob" command { command { step {} } rejected: REJECT_REASON_CLOCK_HELD } }
    steps { client: "bob" disconnect {} }
    steps { hash { is: 0x0123456789abcdef same_as: "a" } }
  )",
                                  "test");
  ASSERT_TRUE(script) << script.error().message;
  EXPECT_EQ(script->seed(), ~0ull);
  EXPECT_EQ(script->steps(3).hash().is(), 0x0123456789abcdefull);
}

TEST(ScriptFile, WhatTheClockDoesNotAllowIsRefused) {
  EXPECT_THAT(errorOf("seed: 1 steps { wait {} }"), HasSubstr("seed goes with hold_clock"));
  EXPECT_THAT(errorOf("steps { hash {} }"), HasSubstr("steps[0]: hash goes with hold_clock"));
  EXPECT_THAT(errorOf("hold_clock: true steps { hash { same_as: \"a\" } }"), HasSubstr("no step before saves"));
  EXPECT_THAT(errorOf("hold_clock: true steps { command { command { step {} } } }"), HasSubstr("use at_s or wait"));
  EXPECT_THAT(errorOf("hold_clock: true steps { command { command { release_clock {} } } }"), HasSubstr("at_s"));
  EXPECT_THAT(errorOf("hold_clock: true steps { disconnect {} }"), HasSubstr("another client"));
  EXPECT_THAT(errorOf("hold_clock: true clients { name: \"a\" room: \"x\" } clients { name: \"b\" room: \"y\" } "
                      "steps { wait {} }"),
              HasSubstr("rooms \"x\" and \"y\""));
}

TEST(ScriptFile, MistakesAreNamedWithTheirPlaces) {
  const std::string error = errorOf("steps { at_s: 1\n  later_s: 2\n  subscribe { level: LEVEL_BEST }\n}\n");
  EXPECT_THAT(error, HasSubstr("test:2:3: "));
  EXPECT_THAT(error, HasSubstr("later_s"));
  EXPECT_THAT(errorOf(std::string(300'000, '{')), HasSubstr("nest deeper than 32"));
}

TEST(ScriptFile, TimesAreBounded) {
  for (const char* bad : {"-1", "nan", "inf"}) {
    EXPECT_THAT(errorOf(std::string("steps { at_s: ") + bad + " wait {} }"), HasSubstr("at_s has to be 0 or more"));
    EXPECT_THAT(errorOf(std::string("steps { wait { duration_s: ") + bad + " } }"), HasSubstr("wait.duration_s"));
  }
  EXPECT_THAT(errorOf("steps { at_s: 86401 wait {} }"), HasSubstr("86401 s are more than 86400 s"));
  EXPECT_EQ(errorOf("steps { at_s: 86400 wait { duration_s: 0 } }"), "(accepted)");
}

}  // namespace
}  // namespace spindrift::script
