// Every log line is one JSON object, whatever the message holds.
#include <chrono>
#include <string>

#include <boost/json/parse.hpp>
#include <gtest/gtest.h>
#include <spdlog/details/log_msg.h>

#include "logging.h"

namespace spindrift::test {
namespace {

using std::chrono::milliseconds;

std::string lineOf(const std::string& message, spdlog::level::level_enum level = spdlog::level::info,
                   milliseconds since_1970 = milliseconds(0)) {
  const spdlog::log_clock::time_point time(since_1970);
  spdlog::memory_buf_t line;
  cli::JsonLogFormatter().format(spdlog::details::log_msg(time, {}, "spindrift", level, message), line);
  return {line.data(), line.size()};
}

/// Parses the line strictly; the parser refuses invalid UTF-8.
boost::json::object parsed(const std::string& line) {
  EXPECT_EQ(line.find('\n'), line.size() - 1) << "one line: " << line;
  boost::system::error_code error;
  const boost::json::value value = boost::json::parse(line, error);
  EXPECT_FALSE(error) << line;
  return value.is_object() ? value.as_object() : boost::json::object{};
}

std::string messageOf(const std::string& message) {
  return std::string(parsed(lineOf(message)).at("message").as_string());
}

TEST(JsonLog, LineHasTimeLevelThreadAndMessage) {
  const std::string line = lineOf("room main: fine", spdlog::level::warn, milliseconds(1'769'860'800'007));
  EXPECT_TRUE(line.starts_with("{\"time\":\"2026-01-31T12:00:00.007Z\",\"level\":\"warning\",\"thread\":")) << line;
  EXPECT_TRUE(line.ends_with(",\"message\":\"room main: fine\"}\n")) << line;
  EXPECT_TRUE(parsed(line).at("thread").is_number());
}

TEST(JsonLog, TimesAreUtcWithMilliseconds) {
  const auto time = [](long long ms) {
    return std::string(parsed(lineOf("", spdlog::level::info, milliseconds(ms))).at("time").as_string());
  };
  EXPECT_EQ(time(0), "1970-01-01T00:00:00.000Z");
  EXPECT_EQ(time(-1), "1969-12-31T23:59:59.999Z");
  EXPECT_EQ(time(951'782'400'000 - 1), "2000-02-28T23:59:59.999Z");
  EXPECT_EQ(time(951'782'400'000), "2000-02-29T00:00:00.000Z");
}

TEST(JsonLog, QuotesAndControlCharactersRoundTrip) {
  const std::string hostile = "\"}\n{\"level\":\"error\"\\ \t\r\b\f \x01\x1F\x7F";
  EXPECT_EQ(messageOf(hostile), hostile);
  EXPECT_EQ(messageOf(std::string("a\0b", 3)), std::string("a\0b", 3));
}

TEST(JsonLog, UnicodeComesBackAsItWas) {
  const std::string text = "\xC3\xA4 \xE2\x80\xA8 \xF0\x9F\x8C\x8A \xEF\xBF\xBF \xF4\x8F\xBF\xBF";
  EXPECT_EQ(messageOf(text), text);
}

TEST(JsonLog, EveryByteGivesValidJson) {
  for (int byte = 0; byte < 256; ++byte) {
    const std::string text = std::string("a") + static_cast<char>(byte) + "b";
    EXPECT_EQ(messageOf(text), byte < 0x80 ? text
                                           : "a\xEF\xBF\xBD"
                                             "b")
        << byte;
  }
}

TEST(JsonLog, BytesThatAreNoUtf8AreReplaced) {
  const std::string bad = "\xEF\xBF\xBD";
  EXPECT_EQ(messageOf("\xC0\xAF"), bad + bad) << "overlong";
  EXPECT_EQ(messageOf("\xED\xA0\x80"), bad + bad + bad) << "surrogate";
  EXPECT_EQ(messageOf("\xF4\x90\x80\x80"), bad + bad + bad + bad) << "above U+10FFFF";
  EXPECT_EQ(messageOf("end \xF0\x9F\x8C"), "end " + bad + bad + bad) << "cut off";
}

TEST(JsonLog, LongMessagesAreWhole) {
  const std::string text(1 << 20, '"');
  EXPECT_EQ(messageOf(text), text);
}

}  // namespace
}  // namespace spindrift::test
