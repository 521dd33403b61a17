#include <algorithm>
#include <cctype>

#include <boost/beast/core/string.hpp>

#include <spindrift/http/network_text.h>

#include "field_list.h"

namespace spindrift::net {
namespace {

using boost::beast::iequals;

/// "http://host:8080" -> "host:8080"; empty without http:// or https:// ("null").
std::string_view hostOf(std::string_view origin) {
  for (const std::string_view scheme : {std::string_view("http://"), std::string_view("https://")}) {
    if (origin.size() > scheme.size() && iequals(origin.substr(0, scheme.size()), scheme))
      return origin.substr(scheme.size());
  }
  return {};
}

bool isLoopbackName(std::string_view host) {
  const bool is_bracketed = host.starts_with('[');
  const std::size_t end = is_bracketed ? host.find(']') : host.rfind(':');
  const std::string_view name =
      is_bracketed && end != std::string_view::npos ? host.substr(0, end + 1) : host.substr(0, end);
  if (iequals(name, "localhost") || name == "[::1]") return true;
  // 127.0.0.0/8, but not a host name that starts with "127.".
  return name.starts_with("127.") &&
         std::ranges::all_of(name, [](unsigned char c) { return std::isdigit(c) || c == '.'; });
}

core::Error wrongOrigin(const std::string& text, const std::string& why) {
  return {core::ErrorCode::kInvalidInput, "'" + text + "' is not an Origin: " + why};
}

/// Returns "host:port" without the port that the scheme has by default, which browsers leave out.
std::string_view withoutDefaultPort(std::string_view scheme, std::string_view authority) {
  const std::string_view port = iequals(scheme, "https")  ? ":443"
                                : iequals(scheme, "http") ? ":80"
                                                          : std::string_view();
  return authority.substr(0, authority.size() - (authority.ends_with(port) ? port.size() : 0));
}

/// A host in the characters that browsers send, with an optional port.
bool isAuthority(std::string_view text) {
  const std::size_t colon = text.ends_with(']') ? std::string_view::npos : text.rfind(':');
  const std::string_view host = text.substr(0, colon);
  if (colon != std::string_view::npos && wholeNumber(text.substr(colon + 1), kPortMax).value_or(0) == 0) return false;
  const bool is_ipv6 = host.starts_with('[') && host.ends_with(']');
  const std::string_view marks = is_ipv6 ? "[:]." : "-._";
  return !host.empty() && std::ranges::all_of(host, [&](unsigned char c) {
    return (c < 0x80 && std::isalnum(c) != 0) || marks.find(static_cast<char>(c)) != std::string_view::npos;
  });
}

}  // namespace

core::Result<void> checkOrigin(const std::string& text) {
  constexpr const char* kForm = "write SCHEME://HOST[:PORT], such as https://water.example";
  if (text == "*" || text == "null") return {};
  if (text.empty()) return wrongOrigin(text, kForm);
  if (text.find_first_of(" \t\r\n") != std::string::npos)
    return wrongOrigin(text, "it has a blank in it; write ',' between several");
  if (text.find('*') != std::string::npos)
    return wrongOrigin(text, "patterns are not supported; name every origin, or write * for any");
  const std::size_t mark = text.find("://");
  if (mark == std::string::npos || mark == 0)
    return wrongOrigin(text, "it has no scheme; write https://" + text + " or http://" + text);
  const std::string_view scheme = std::string_view(text).substr(0, mark);
  const std::string_view rest = std::string_view(text).substr(mark + 3);
  const std::string_view whole = rest.substr(0, rest.find_first_of("/?#"));
  const std::string_view authority = withoutDefaultPort(scheme, whole.substr(whole.rfind('@') + 1));
  const bool is_socket = iequals(scheme, "ws") || iequals(scheme, "wss");
  if (!isAuthority(authority)) {
    return wrongOrigin(text, std::string("its host or port is invalid; ") + kForm +
                                 ", other letters than ASCII in the host as browsers send them (xn--…)");
  }
  const std::string meant =
      (is_socket ? iequals(scheme, "ws") ? "http" : "https" : std::string(scheme)) + "://" + std::string(authority);
  if (meant == text) return {};
  return wrongOrigin(
      text, "browsers send the scheme of the page, its host, and a port other than the scheme's own; write " + meant);
}

core::Result<void> checkParentOrigin(const std::string& text) {
  if (text == "null" || text.find('*') != std::string::npos) {
    return core::Error{core::ErrorCode::kInvalidInput,
                       "'" + text +
                           "' names no page, and a page that embeds the water acts with its visitors' rights: " +
                           "list the Origin of each, such as https://school.example"};
  }
  if (text.find('[') != std::string::npos)
    return wrongOrigin(text, "browsers take no IPv6 address in a frame policy; name the host");
  if (auto checked = checkOrigin(text); !checked) return checked;
  if (hostOf(text).empty()) return wrongOrigin(text, "pages that embed the water are at http:// or https://");
  return {};
}

bool isOriginListed(std::string_view origin, std::span<const std::string> allowed) {
  return std::ranges::any_of(allowed, [&](const std::string& known) { return known == "*" || iequals(known, origin); });
}

bool isOriginAllowed(std::string_view origin, std::string_view host, bool listens_on_loopback,
                     std::span<const std::string> allowed) {
  if (origin.empty() || isOriginListed(origin, allowed)) return true;
  const std::string_view page_host = hostOf(origin);
  if (page_host.empty() || !iequals(page_host, host)) return false;
  return !listens_on_loopback || isLoopbackName(host);
}

}  // namespace spindrift::net
