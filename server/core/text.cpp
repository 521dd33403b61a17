#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <ctime>

#include <spindrift/core/text.h>

namespace spindrift::core {

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

std::string rfc3339(std::chrono::system_clock::time_point time) {
  const auto second = std::chrono::floor<std::chrono::seconds>(time);
  const std::time_t since_1970_s = std::chrono::system_clock::to_time_t(second);
  std::tm utc{};
  ::gmtime_r(&since_1970_s, &utc);
  char date[40];
  std::strftime(date, sizeof date, "%FT%T", &utc);
  char milliseconds[16];
  std::snprintf(milliseconds, sizeof milliseconds, ".%03dZ",
                static_cast<int>(std::chrono::floor<std::chrono::milliseconds>(time - second).count()));
  return std::string(date) + milliseconds;
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
  // The second byte tells overlong forms, surrogates and code points above U+10FFFF.
  const std::uint8_t second = byte(at + 1);
  if ((lead == 0xE0 && second < 0xA0) || (lead == 0xED && second > 0x9F)) return 0;
  if ((lead == 0xF0 && second < 0x90) || (lead == 0xF4 && second > 0x8F)) return 0;
  return length;
}

namespace {

/// First and last code point.
struct Range {
  char32_t first, last;
};
template <std::size_t kCount>
bool isIn(const Range (&ranges)[kCount], char32_t c) {
  return std::ranges::any_of(ranges, [c](const Range& range) { return c >= range.first && c <= range.last; });
}

/// C0 and C1 control characters; Arabic letter mark; zero width space; direction marks; line and paragraph separators,
/// direction embeddings and overrides; invisible operators, direction isolates, deprecated format characters; byte
/// order mark; interlinear annotation. The zero width joiners (200C, 200D) stay: scripts and emoji need them.
constexpr Range kUnwanted[] = {{0x00, 0x1F},     {0x7F, 0x9F},     {0x061C, 0x061C}, {0x200B, 0x200B}, {0x200E, 0x200F},
                               {0x2028, 0x202E}, {0x2060, 0x206F}, {0xFEFF, 0xFEFF}, {0xFFF9, 0xFFFB}};
/// Unicode's White_Space, Hangul fillers, Braille blank.
constexpr Range kSpace[] = {{0x20, 0x20},     {0xA0, 0xA0},     {0x115F, 0x1160}, {0x1680, 0x1680},
                            {0x2000, 0x200A}, {0x202F, 0x202F}, {0x205F, 0x205F}, {0x2800, 0x2800},
                            {0x3000, 0x3000}, {0x3164, 0x3164}, {0xFFA0, 0xFFA0}};
/// Invisible alone, but may modify the character before: soft hyphen, grapheme joiner, variation selectors, zero width
/// joiners, tags.
constexpr Range kAttached[] = {{0xAD, 0xAD},     {0x034F, 0x034F}, {0x180B, 0x180F},
                               {0x200C, 0x200D}, {0xFE00, 0xFE0F}, {0xE0000, 0xE0FFF}};

/// The code point of the valid sequence of `length` bytes at `text[at]`.
char32_t codePoint(std::string_view text, std::size_t at, std::size_t length) {
  constexpr std::uint8_t kLeadBits[] = {0, 0x7F, 0x1F, 0x0F, 0x07};
  char32_t c = static_cast<std::uint8_t>(text[at]) & kLeadBits[length];
  for (std::size_t i = 1; i < length; ++i) c = c << 6 | (static_cast<std::uint8_t>(text[at + i]) & 0x3F);
  return c;
}

}  // namespace

std::string toValidUtf8(std::string_view text) {
  std::string valid;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8SequenceLength(text, at);
    valid += length == 0 ? "\xEF\xBF\xBD" : text.substr(at, length);
    at += std::max<std::size_t>(length, 1);
  }
  return valid;
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
    if (!isIn(kUnwanted, codePoint(text, at, length))) clean.append(text.substr(at, length));
    at += length;
  }
  return clean;
}

std::string cleanName(std::string_view text, std::size_t max_bytes) {
  std::string name = cleanText(text, text.size());
  const auto firstThat = [](std::string_view where, auto accepts) {
    std::size_t at = 0;
    while (at < where.size()) {
      const std::size_t length = utf8SequenceLength(where, at);
      if (accepts(codePoint(where, at, length))) break;
      at += length;
    }
    return at;
  };
  name.erase(0, firstThat(name, [](char32_t c) { return !isIn(kSpace, c) && !isIn(kAttached, c); }));
  name = cleanText(name, max_bytes);
  std::size_t end = 0;  // end of the last character that is not a space
  (void)firstThat(name, [&, at = std::size_t{0}](char32_t c) mutable {
    at += utf8SequenceLength(name, at);
    if (!isIn(kSpace, c)) end = at;
    return false;
  });
  name.resize(end);
  return name;
}

namespace {

std::string escapeOf(char32_t c) {
  if (c == '\t') return "\\t";
  if (c == '\r') return "\\r";
  if (c == '\n') return "\\n";
  char buffer[16];
  std::snprintf(buffer, sizeof buffer, "\\u{%02X}", static_cast<unsigned>(c));
  return buffer;
}

}  // namespace

std::string quoteText(std::string_view text, std::size_t max_bytes) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8SequenceLength(text, at);
    std::string shown(text.substr(at, std::max<std::size_t>(length, 1)));
    if (length == 0) {
      char buffer[8];
      std::snprintf(buffer, sizeof buffer, "\\x%02X", static_cast<unsigned>(static_cast<std::uint8_t>(text[at])));
      shown = buffer;
    } else if (const char32_t c = codePoint(text, at, length);
               isIn(kUnwanted, c) || isIn(kAttached, c) || (c != ' ' && isIn(kSpace, c))) {
      shown = escapeOf(c);
    }
    if (out.size() + shown.size() > max_bytes) break;
    out += shown;
    at += std::max<std::size_t>(length, 1);
  }
  return out;
}

std::string firstLine(const std::string& text) {
  const std::size_t end = text.find('\n');
  return end == std::string::npos ? text : text.substr(0, end) + " (and more)";
}

}  // namespace spindrift::core
