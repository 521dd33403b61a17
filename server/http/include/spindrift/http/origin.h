// Checks of the Origin header, which browsers send to name the page; other clients send none.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace spindrift::net {

/// Returns whether `allowed` contains this Origin ("*" = any).
bool isOriginListed(std::string_view origin, std::span<const std::string> allowed);

/// Returns whether a request with these headers is accepted: no Origin, one of `allowed` ("*" = any), or the server's
/// own, that is, the host that the request was sent to. If the server listens on the loopback only, that host has to be
/// the loopback too, so that a foreign name that resolves to it gets no access.
bool isOriginAllowed(std::string_view origin, std::string_view host, bool listens_on_loopback,
                     std::span<const std::string> allowed);

}  // namespace spindrift::net
