// Text that goes to people: numbers as they would write them, and foreign text made harmless.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace spindrift::core {

/// At most 10 significant digits, no trailing zeros: "0.05", "1e-12", "nan".
std::string formatNumber(double value);

/// formatNumber with the unit behind it, if there is one: "0.05 m".
std::string formatQuantity(double value, std::string_view unit);

/// Bytes of the UTF-8 sequence that starts at `text[at]`; 0 where there is no valid one.
std::size_t utf8SequenceLength(std::string_view text, std::size_t at);

/// `text` without invalid UTF-8 and without characters that change how the text around them looks: control characters,
/// line separators, and those that set the direction of writing (Unicode TR 36, section 2.2). Cut at a character's
/// boundary to at most `max_bytes`.
std::string cleanText(std::string_view text, std::size_t max_bytes);

/// cleanText() that begins with a character that shows and does not end with a space (of any width): empty for a name
/// that shows nothing.
std::string cleanName(std::string_view text, std::size_t max_bytes);

}  // namespace spindrift::core
