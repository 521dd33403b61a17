// Lists in header fields (RFC 9110 section 5.6.1): entries between commas, with optional spaces and tabs around them.
#pragma once

#include <algorithm>
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

}  // namespace spindrift::net
