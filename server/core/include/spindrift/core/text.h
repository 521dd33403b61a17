// Text for people: formatted numbers, and untrusted text made safe to show.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

namespace spindrift::core {

/// Formats with at most 10 significant digits, no trailing zeros: "0.05", "1e-12", "nan".
std::string formatNumber(double value);

/// Formats as formatNumber() does, followed by the unit, if there is one: "0.05 m".
std::string formatQuantity(double value, std::string_view unit);

/// Formats a length: "0.05 m".
inline std::string metres(double value_m) {
  return formatQuantity(value_m, "m");
}

/// Formats in UTC with milliseconds (RFC 3339): "2026-01-31T12:00:00.123Z".
std::string rfc3339(std::chrono::system_clock::time_point time);

/// Returns the length in bytes of the UTF-8 sequence that starts at `text[at]`; 0 where none is valid.
std::size_t utf8SequenceLength(std::string_view text, std::size_t at);

/// Returns `text` with U+FFFD in place of each byte that belongs to no UTF-8 sequence.
std::string toValidUtf8(std::string_view text);

/// Returns `text` without invalid UTF-8 and without characters that change how surrounding text looks: control
/// characters, line separators, and direction controls (Unicode TR 36, section 2.2). Cut at a character boundary to at
/// most `max_bytes`.
std::string cleanText(std::string_view text, std::size_t max_bytes);

/// Returns cleanText() without invisible characters at the start and spaces (of any width) at the end. Empty for a name
/// without visible characters.
std::string cleanName(std::string_view text, std::size_t max_bytes);

/// Returns `text` for a quotation in a message, with everything invisible as an escape: \t, \r, \n, \xFF for a byte
/// that is not UTF-8, \u{FEFF} for characters that cleanName() removes and for spaces other than the plain one. Cut
/// before the first character that would exceed `max_bytes`.
std::string quoteText(std::string_view text, std::size_t max_bytes);

/// Returns the first line of an error that has one line per field.
std::string firstLine(const std::string& text);

}  // namespace spindrift::core
