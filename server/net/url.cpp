#include "url.h"

#include <charconv>

namespace spindrift::net {

std::optional<Target> parseTarget(std::string_view target) {
  if (!target.starts_with('/')) return std::nullopt;
  Target out;
  const std::size_t mark = target.find('?');
  if (mark != std::string_view::npos) {
    out.query = target.substr(mark + 1);
    target = target.substr(0, mark);
  }
  for (std::size_t k = 0; k < target.size(); ++k) {
    unsigned char byte = static_cast<unsigned char>(target[k]);
    if (byte == '%') {
      if (k + 2 >= target.size()) return std::nullopt;
      const char* const first = target.data() + k + 1;
      const auto [end, error] = std::from_chars(first, first + 2, byte, 16);
      if (error != std::errc() || end != first + 2) return std::nullopt;
      k += 2;
    }
    if (byte < 0x20 || byte == 0x7f || byte == '\\') return std::nullopt;
    out.path.push_back(static_cast<char>(byte));
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
