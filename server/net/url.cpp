#include "url.h"

#include <algorithm>
#include <charconv>

namespace spindrift::net {
namespace {

/// Returns the byte of the escape "%XX" at `text[at]`; nullopt if it is broken.
std::optional<unsigned char> escapedByte(std::string_view text, std::size_t at) {
  if (at + 2 >= text.size()) return std::nullopt;
  unsigned char byte = 0;
  const char* const first = text.data() + at + 1;
  const auto [end, error] = std::from_chars(first, first + 2, byte, 16);
  if (error != std::errc() || end != first + 2) return std::nullopt;
  return byte;
}

}  // namespace

std::optional<RequestTarget> parseTarget(std::string_view target) {
  if (!target.starts_with('/')) return std::nullopt;
  RequestTarget out;
  const std::size_t mark = target.find('?');
  if (mark != std::string_view::npos) {
    out.query = target.substr(mark + 1);
    target = target.substr(0, mark);
  }
  for (std::size_t k = 0; k < target.size(); ++k) {
    unsigned char byte = static_cast<unsigned char>(target[k]);
    if (byte == '%') {
      const auto escaped = escapedByte(target, k);
      if (!escaped) return std::nullopt;
      byte = *escaped;
      k += 2;
    }
    if (byte < 0x20 || byte == 0x7f || byte == '\\') return std::nullopt;
    out.path.push_back(static_cast<char>(byte));
  }
  return out;
}

std::optional<std::vector<std::string>> queryValues(std::string_view query, std::string_view name) {
  std::vector<std::string> out;
  while (!query.empty()) {
    const std::string_view parameter = query.substr(0, query.find('&'));
    query.remove_prefix(std::min(query.size(), parameter.size() + 1));
    const std::size_t equals = std::min(parameter.find('='), parameter.size());
    if (parameter.substr(0, equals) != name) continue;
    const std::string_view text = parameter.substr(std::min(parameter.size(), equals + 1));
    std::string& value = out.emplace_back();
    for (std::size_t k = 0; k < text.size(); ++k) {
      unsigned char byte = text[k] == '+' ? ' ' : static_cast<unsigned char>(text[k]);
      if (byte == '%') {
        const auto escaped = escapedByte(text, k);
        if (!escaped) return std::nullopt;
        byte = *escaped;
        k += 2;
      }
      if (byte < 0x20 || byte == 0x7f) return std::nullopt;
      value.push_back(static_cast<char>(byte));
    }
  }
  return out;
}

std::string printable(std::string_view text) {
  constexpr std::size_t kMaxBytes = 200;
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (out.size() + 3 > kMaxBytes) return out + "...";
    if (byte > 0x20 && byte < 0x7f) {
      out.push_back(c);
    } else {
      out.append({'%', kDigits[byte >> 4], kDigits[byte & 0xf]});
    }
  }
  return out;
}

std::optional<std::string> roomOfPath(std::string_view path) {
  if (path == "/ws") return std::string();
  constexpr std::string_view kPrefix = "/ws/";
  if (path.starts_with(kPrefix)) return std::string(path.substr(kPrefix.size()));
  return std::nullopt;
}

}  // namespace spindrift::net
