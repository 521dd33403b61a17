// Who may, from the options of `serve` and the files that they name; and who is the operator of a server that others
// can reach and for which no roles are configured.
#pragma once

#include <string>

#include <spindrift/access/access.h>
#include <spindrift/core/result.h>

#include "serve_options.h"

namespace spindrift::cli {

/// Returns whether clients on other machines can reach the server, directly or through a proxy.
bool isReachable(const FrontOptions& options);

/// Makes a token for the person who starts the server, if others can reach it and neither tokens, keys nor a role of
/// guests are given, or if it is for a class and neither tokens nor keys are; loadAccess() then makes guests players.
/// Call it once, before loadAccess().
void makeOperatorToken(FrontOptions& options);

/// Reads tokens (from the file or the environment, or FrontOptions::operator_token), keys for JWTs, and the role of
/// clients without a token. Errors name the option or the file and the line, never a token or a secret. May be called
/// again to read changed files.
core::Result<access::Access> loadAccess(const FrontOptions& options);

}  // namespace spindrift::cli
