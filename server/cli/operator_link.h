// Who is the operator of a server that others can reach and for which no roles are configured.
#pragma once

#include <cstdint>
#include <string>

#include "serve_options.h"

namespace spindrift::cli {

/// Returns whether clients on other machines can reach the server, directly or through a proxy.
bool isReachable(const FrontOptions& options);

/// Makes a token for the person who starts the server, if others can reach it and neither tokens, keys nor a role of
/// guests are given; loadAccess() then makes guests players. Call it once, before loadAccess().
void makeOperatorToken(FrontOptions& options);

/// Returns the lines for standard output at the start: the URL of the page, and if makeOperatorToken() made a token, a
/// link with it. Browsers do not send the fragment of a link to anybody.
std::string readyText(const FrontOptions& options, std::uint16_t port);

}  // namespace spindrift::cli
