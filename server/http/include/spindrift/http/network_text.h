// Networks, addresses and origins in text form: of options, and of the Origin header, which browsers send to name the
// page; other clients send none.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include <spindrift/core/result.h>

namespace spindrift::net {

/// Checks ADDRESS/BITS ("10.0.0.0/8", "2001:db8::/32") or one ADDRESS. kInvalidInput says what is wrong: no address,
/// more bits than the address has, or bits set behind the prefix.
core::Result<void> checkNetwork(const std::string& text);

/// Checks an address to listen on. kInvalidInput says what was meant: an address with a port or in a URL, a host's
/// name, a link-local address without its interface.
core::Result<void> checkListenAddress(const std::string& text);

/// Checks an Origin to compare with those that browsers send (RFC 6454 section 6.2): SCHEME://HOST[:PORT] without the
/// scheme's default port, "null", or "*" for any. kInvalidInput says what was meant: a URL with a path, a host without
/// a scheme, a pattern.
core::Result<void> checkOrigin(const std::string& text);

/// Checks the Origin of a page that may embed the water: http://HOST[:PORT] or https://HOST[:PORT], as in
/// checkOrigin(). kInvalidInput also for "*" and "null", which name no page, and for an IPv6 address, which a frame
/// policy cannot name (Content Security Policy Level 3, section 2.3.1).
core::Result<void> checkParentOrigin(const std::string& text);

/// Returns whether `allowed` contains this Origin ("*" = any).
bool isOriginListed(std::string_view origin, std::span<const std::string> allowed);

/// Returns whether a request with these headers is accepted: no Origin, one of `allowed` ("*" = any), or the server's
/// own, that is, the host that the request was sent to. If the server listens on the loopback only, that host has to be
/// the loopback too, so that a foreign name that resolves to it gets no access.
bool isOriginAllowed(std::string_view origin, std::string_view host, bool listens_on_loopback,
                     std::span<const std::string> allowed);

/// Returns whether only this machine can reach a server that listens on `address`.
inline bool isLoopback(std::string_view address) {
  return address.starts_with("127.") || address == "::1";
}

}  // namespace spindrift::net
