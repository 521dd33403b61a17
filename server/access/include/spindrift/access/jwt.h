// JSON Web Tokens (RFC 7519) signed with HS256, RS256 (RFC 7518) or EdDSA with Ed25519 (RFC 8037).
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <spindrift/access/grant.h>
#include <spindrift/core/result.h>

struct evp_pkey_st;  // OpenSSL's EVP_PKEY

namespace spindrift::access {

enum class JwtAlgorithm : std::uint8_t { kHs256, kRs256, kEdDsa };

/// Returns "HS256", "RS256" or "EdDSA".
std::string_view nameOf(JwtAlgorithm algorithm);

/// A key that verifies. Its algorithm belongs to it, so that a token cannot choose another one for it.
struct JwtKey {
  JwtAlgorithm algorithm = JwtAlgorithm::kHs256;
  std::string id{};                           ///< `kid`; empty: none
  std::string secret{};                       ///< of kHs256
  std::shared_ptr<evp_pkey_st> public_key{};  ///< of the others
};

inline constexpr std::size_t kJwtKeyMaxCount = 32;
inline constexpr std::size_t kJwtSecretMinBytes = 32;     ///< RFC 7518 section 3.2
inline constexpr int kJwtRsaMinBits = 2048;               ///< RFC 7518 section 3.3
inline constexpr std::size_t kJwtFileMaxBytes = 1 << 18;  ///< of a file of keys
/// By how much the clocks of the issuer and of this machine may differ.
inline constexpr std::chrono::seconds kJwtLeeway{30};

/// Reads a PEM text with one public key: RSA gives RS256, Ed25519 gives EdDSA. kInvalidInput names `label` and what is
/// wrong: a private key, another kind of key, an RSA key below kJwtRsaMinBits.
core::Result<JwtKey> parsePublicKey(std::string_view pem, const std::string& label);
/// Takes the text as secret of HS256; a line break at its end does not belong to it. kInvalidInput if it is shorter
/// than kJwtSecretMinBytes.
core::Result<JwtKey> parseSecret(std::string_view text, const std::string& label);
/// Reads a JWK set (RFC 7517). Keys of other kinds, curves, algorithms and uses are left out, as its section 5 asks.
/// kInvalidInput: no JWK set, a private key, a key that is malformed or too small, no usable key.
core::Result<std::vector<JwtKey>> parseKeySet(std::string_view json, const std::string& label);

/// Claims that tokens need besides a valid signature.
struct JwtRules {
  std::string issuer{};    ///< `iss`; empty: not checked
  std::string audience{};  ///< has to be in `aud`; empty: not checked
};

/// Returns whether a text has the form of a JWT: three parts between dots.
bool looksLikeJwt(std::string_view token);

/// Checks a token: form, algorithm and signature first, then its claims. Errors (kInvalidInput) say what is wrong in
/// one line, without any part of the token. Never uses an algorithm that none of `keys` has. Any thread.
core::Result<Grant> verifyJwt(std::string_view token, const std::vector<JwtKey>& keys, const JwtRules& rules,
                              std::chrono::system_clock::time_point now);

}  // namespace spindrift::access
