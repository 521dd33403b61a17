// Who may, from the files that the options of `serve` name.
#pragma once

#include <spindrift/access/access.h>
#include <spindrift/core/result.h>

#include "serve_options.h"

namespace spindrift::cli {

/// Reads tokens (from the file or the environment, or FrontOptions::operator_token), keys for JWTs, and the role of
/// clients without a token. Errors name the option or the file and the line, never a token or a secret. May be called
/// again to read changed files.
core::Result<access::Access> loadAccess(const FrontOptions& options);

}  // namespace spindrift::cli
