#include <algorithm>
#include <charconv>
#include <utility>

#include <spindrift/http/url.h>

namespace spindrift::net {
namespace {

/// Returns the text without its percent escapes; nullopt if an escape is broken or a control character results.
std::optional<std::string> decoded(std::string_view text, bool plus_is_space) {
  constexpr std::size_t kDigitCount = 2;
  std::string out;
  while (!text.empty()) {
    auto byte = static_cast<unsigned char>(text.front());
    text.remove_prefix(1);
    if (byte == '%') {
      const std::string_view digits = text.substr(0, kDigitCount);
      const auto [end, error] = std::from_chars(digits.begin(), digits.end(), byte, 16);
      if (digits.size() < kDigitCount || error != std::errc() || end != digits.end()) return std::nullopt;
      text.remove_prefix(kDigitCount);
    } else if (byte == '+' && plus_is_space) {
      byte = ' ';
    }
    if (byte < 0x20 || byte == 0x7f) return std::nullopt;
    out.push_back(static_cast<char>(byte));
  }
  return out;
}

}  // namespace

std::optional<RequestTarget> parseTarget(std::string_view target) {
  if (!target.starts_with('/')) return std::nullopt;
  const std::size_t end = std::min(target.find('?'), target.size());
  auto path = decoded(target.substr(0, end), false);
  if (!path || path->find('\\') != std::string::npos) return std::nullopt;
  return RequestTarget{.path = *std::move(path), .query = std::string(target.substr(std::min(end + 1, target.size())))};
}

std::optional<std::vector<std::string>> queryValues(std::string_view query, std::string_view name) {
  std::vector<std::string> out;
  while (!query.empty()) {
    const std::string_view parameter = query.substr(0, query.find('&'));
    query.remove_prefix(std::min(query.size(), parameter.size() + 1));
    const std::size_t equals = std::min(parameter.find('='), parameter.size());
    if (parameter.substr(0, equals) != name) continue;
    auto value = decoded(parameter.substr(std::min(parameter.size(), equals + 1)), true);
    if (!value) return std::nullopt;
    out.push_back(*std::move(value));
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

namespace {

/// Returns what follows `root` and a slash; nullopt for a path outside of the root.
std::optional<std::string> nameBelow(std::string_view root, std::string_view path) {
  if (!path.starts_with(root)) return std::nullopt;
  path.remove_prefix(root.size());
  if (path.empty()) return std::string();
  return path.front() == '/' ? std::optional(std::string(path.substr(1))) : std::nullopt;
}

}  // namespace

std::optional<std::string> roomOfPath(std::string_view path) {
  return nameBelow("/ws", path);
}

std::optional<std::string> foxgloveRoomOfPath(std::string_view path) {
  return nameBelow("/foxglove", path);
}

}  // namespace spindrift::net
