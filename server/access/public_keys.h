// Public keys under which anybody could sign. Private to this module.
#pragma once

#include <string>

#include <openssl/types.h>

namespace spindrift::access {

/// Returns why an RSA or Ed25519 key must not be used, in one line; empty if it may be. RSA: fewer than kJwtRsaMinBits
/// bits, or an exponent that is 1 or even. Ed25519: a point of small order, for which one signature fits all texts.
std::string weaknessOf(const EVP_PKEY& key);

}  // namespace spindrift::access
