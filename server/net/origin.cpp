#include "origin.h"

#include <algorithm>
#include <cctype>

namespace spindrift::net {
namespace {

bool equalsIgnoringCase(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

/// "http://host:8080" -> "host:8080"; empty without http:// or https:// ("null").
std::string_view hostOf(std::string_view origin) {
  for (const std::string_view scheme : {std::string_view("http://"), std::string_view("https://")}) {
    if (origin.size() > scheme.size() && equalsIgnoringCase(origin.substr(0, scheme.size()), scheme))
      return origin.substr(scheme.size());
  }
  return {};
}

bool isLoopbackName(std::string_view host) {
  const bool is_bracketed = host.starts_with('[');
  const std::size_t end = is_bracketed ? host.find(']') : host.rfind(':');
  const std::string_view name =
      is_bracketed && end != std::string_view::npos ? host.substr(0, end + 1) : host.substr(0, end);
  if (equalsIgnoringCase(name, "localhost") || name == "[::1]") return true;
  // 127.0.0.0/8, but not a host name that starts with "127.".
  return name.starts_with("127.") &&
         std::ranges::all_of(name, [](unsigned char c) { return std::isdigit(c) || c == '.'; });
}

}  // namespace

bool isOriginListed(std::string_view origin, std::span<const std::string> allowed) {
  return std::ranges::any_of(
      allowed, [&](const std::string& known) { return known == "*" || equalsIgnoringCase(known, origin); });
}

bool isOriginAllowed(std::string_view origin, std::string_view host, bool listens_on_loopback,
                     std::span<const std::string> allowed) {
  if (origin.empty() || isOriginListed(origin, allowed)) return true;
  const std::string_view page_host = hostOf(origin);
  if (page_host.empty() || !equalsIgnoringCase(page_host, host)) return false;
  return !listens_on_loopback || isLoopbackName(host);
}

}  // namespace spindrift::net
