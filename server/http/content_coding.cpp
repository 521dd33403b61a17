#include <algorithm>
#include <cctype>
#include <charconv>

#include <spindrift/http/content_coding.h>

#include "field_list.h"

namespace spindrift::net {
namespace {

bool equalIgnoringCase(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  return std::ranges::equal(a, b, {}, lower, lower);
}

/// Returns the value of "q=0.5"; 0 if it is malformed.
double weightOf(std::string_view parameter) {
  parameter = trimmed(parameter);
  if (!parameter.starts_with("q=") && !parameter.starts_with("Q=")) return 0.0;
  parameter.remove_prefix(2);
  double weight = 0.0;
  const auto [end, error] = std::from_chars(parameter.data(), parameter.data() + parameter.size(), weight);
  const bool is_weight =
      error == std::errc() && end == parameter.data() + parameter.size() && weight >= 0 && weight <= 1;
  return is_weight ? weight : 0.0;
}

}  // namespace

double codingWeight(std::string_view accept_encoding, std::string_view coding) {
  double of_others = 0.0;
  while (!accept_encoding.empty()) {
    const std::string_view entry = takeEntry(accept_encoding);
    const std::size_t semicolon = entry.find(';');
    const std::string_view name = trimmed(entry.substr(0, semicolon));
    const double weight = semicolon == std::string_view::npos ? 1.0 : weightOf(entry.substr(semicolon + 1));
    if (equalIgnoringCase(name, coding)) return weight;
    if (name == "*") of_others = weight;
  }
  return of_others;
}

}  // namespace spindrift::net
