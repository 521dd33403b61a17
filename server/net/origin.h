// Which pages may talk to this server. Browsers name the page in Origin; anything else sends none.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace spindrift::net {

/// Whether `allowed` names this page ("*" = every one).
bool isOriginListed(std::string_view origin, std::span<const std::string> allowed);

/// Whether a request with these headers is to be heard: no Origin at all, one of `allowed` ("*" = every one), or the
/// server's own, that is, the host that the request was sent to. On a server that listens on the loopback only that
/// host has to be the loopback as well, so that a foreign name that resolves to it opens nothing.
bool isOriginAllowed(std::string_view origin, std::string_view host, bool listens_on_loopback,
                     std::span<const std::string> allowed);

}  // namespace spindrift::net
