// What `serve` and `edge` print when they are ready: the addresses of the page, and on a terminal a QR code for phones.
#pragma once

#include <cstdint>
#include <string>

#include "serve_options.h"

namespace spindrift::cli {

/// Returns the lines for standard output at the start: the URL of the page; if makeOperatorToken() made a token, a link
/// with it; and the URLs at which other devices open the page. For a class the addresses of the projector and of phones
/// instead. Browsers do not send the fragment of a link to anybody.
std::string readyText(const FrontOptions& options, std::uint16_t port);

/// Returns the URL for the QR code: of the page, for a class of the pad; empty if only this machine can reach the
/// server.
std::string phoneUrl(const FrontOptions& options, std::uint16_t port);

}  // namespace spindrift::cli
