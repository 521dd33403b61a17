#include "text.h"

#include <cstdint>
#include <cstdio>

namespace spindrift::stream {

std::string formatNumber(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.10g", value);
  return buffer;
}

std::string formatQuantity(double value, std::string_view unit) {
  std::string text = formatNumber(value);
  if (!unit.empty()) text.append(" ").append(unit);
  return text;
}

std::size_t utf8SequenceLength(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t lead = byte(at);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || length > text.size() - at) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(at + i) & 0xC0) != 0x80) return 0;
  }
  // Overlong forms, surrogates and code points above U+10FFFF show in the second byte.
  const std::uint8_t second = byte(at + 1);
  if ((lead == 0xE0 && second < 0xA0) || (lead == 0xED && second > 0x9F)) return 0;
  if ((lead == 0xF0 && second < 0x90) || (lead == 0xF4 && second > 0x8F)) return 0;
  return length;
}

std::string cleanText(std::string_view text, std::size_t max_bytes) {
  std::string clean;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8SequenceLength(text, at);
    if (length == 0) {
      ++at;
      continue;
    }
    if (clean.size() + length > max_bytes) break;
    const auto lead = static_cast<std::uint8_t>(text[at]);
    // U+0080..U+009F are control characters as well: C2 80..C2 9F.
    const bool control =
        lead < 0x20 || lead == 0x7F || (lead == 0xC2 && static_cast<std::uint8_t>(text[at + 1]) < 0xA0);
    if (!control) clean.append(text.substr(at, length));
    at += length;
  }
  return clean;
}

}  // namespace spindrift::stream
