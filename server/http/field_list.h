// Parts of texts: lists in header fields (RFC 9110 section 5.6.1), which are entries between commas with optional
// spaces and tabs around them, and whole numbers.
#pragma once

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

namespace spindrift::net {

/// Returns the text without the spaces and tabs around it.
inline std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

/// Removes the first entry from the list and returns it trimmed.
inline std::string_view takeEntry(std::string_view& list) {
  const std::string_view entry = list.substr(0, list.find(','));
  list.remove_prefix(std::min(entry.size() + 1, list.size()));
  return trimmed(entry);
}

inline constexpr unsigned kPortMax = 65535;

/// Returns nullopt for anything but digits with a value up to `max`.
inline std::optional<unsigned> wholeNumber(std::string_view text, unsigned max) {
  unsigned value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value > max) return std::nullopt;
  return value;
}

}  // namespace spindrift::net
