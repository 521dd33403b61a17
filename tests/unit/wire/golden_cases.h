// The messages whose bytes are frozen in tests/golden, and how a client must read each.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include <spindrift/core/bytes.h>

namespace spindrift::wire {

/// How a client must read the bytes.
enum class GoldenVerdict {
  kOk,          ///< parses and, being a frame, decodes to the values expected
  kBadFrame,    ///< parses as a ServerMessage, but its frame must be refused
  kBadMessage,  ///< must not be taken for a ServerMessage
};

struct GoldenCase {
  std::string file;  ///< name below tests/golden
  GoldenVerdict verdict = GoldenVerdict::kOk;
  std::string expected_json;  ///< members of the case's JSON object besides file and verdict
  core::Bytes bytes;
};

/// A JSON list of numbers.
template <typename Values>
std::string numbersOf(const Values& values) {
  std::string text = "[";
  for (const auto value : values) {
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, "%s%.9g", text.size() > 1 ? ", " : "", static_cast<double>(value));
    text += buffer;
  }
  return text + "]";
}

/// Every case, in a fixed order.
std::vector<GoldenCase> goldenCases();

/// The text of tests/golden/golden.json.
std::string goldenJson(const std::vector<GoldenCase>& cases);

}  // namespace spindrift::wire
