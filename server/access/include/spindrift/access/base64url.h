// The base64url encoding of RFC 4648 section 5 without padding, as JSON Web Tokens use it (RFC 7515 section 2).
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace spindrift::access {

/// Returns nullopt for characters outside of the alphabet, padding, an impossible length, or unused bits that are not
/// 0: every text has one encoding only.
std::optional<std::string> fromBase64Url(std::string_view text);
std::string toBase64Url(std::string_view bytes);

}  // namespace spindrift::access
