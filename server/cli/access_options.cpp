#include "access_options.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <spindrift/access/base64url.h>
#include <spindrift/access/digest.h>
#include <spindrift/access/jwt.h>
#include <spindrift/core/files.h>
#include <spindrift/http/network_text.h>

namespace spindrift::cli {
namespace {

using core::Error;

constexpr std::size_t kTokenFileMaxBytes = 1 << 20;

core::Result<std::string> readFile(const std::string& option, const std::string& file, std::size_t max_bytes,
                                   const std::string& what) {
  auto text = core::readText(file, max_bytes, what, "is it the right file?");
  if (text) return text;
  return Error{text.error().code, option + " " + file + ": " + text.error().message};
}

/// The keys of --jwt-key and --jwt-keys.
core::Result<std::vector<access::JwtKey>> loadJwtKeys(const FrontOptions& options) {
  std::vector<access::JwtKey> out;
  for (const std::string& source : options.jwt_keys) {
    constexpr std::string_view kSecret = "hs256:";
    const bool is_secret = source.starts_with(kSecret);
    const std::string file = is_secret ? source.substr(kSecret.size()) : source;
    const auto text = readFile("--jwt-key", file, access::kJwtFileMaxBytes, is_secret ? "a secret" : "a public key");
    if (!text) return text.error();
    auto key = is_secret ? access::parseSecret(*text, file) : access::parsePublicKey(*text, file);
    if (!key) return Error{key.error().code, "--jwt-key " + key.error().message};
    out.push_back(*std::move(key));
  }
  if (!options.jwt_key_set.empty()) {
    const auto text = readFile("--jwt-keys", options.jwt_key_set, access::kJwtFileMaxBytes, "a JWK set");
    if (!text) return text.error();
    auto keys = access::parseKeySet(*text, options.jwt_key_set);
    if (!keys) return Error{keys.error().code, "--jwt-keys " + keys.error().message};
    std::ranges::move(*keys, std::back_inserter(out));
  }
  if (out.size() > access::kJwtKeyMaxCount) {
    return core::invalid("--jwt-key, --jwt-keys: there are " + std::to_string(out.size()) + " keys; at most " +
                         std::to_string(access::kJwtKeyMaxCount));
  }
  return out;
}

bool hasTokens(const FrontOptions& options) {
  return !options.token_file.empty() || !options.tokens.empty() || !options.jwt_keys.empty() ||
         !options.jwt_key_set.empty();
}

}  // namespace

bool isReachable(const FrontOptions& options) {
  return !net::isLoopback(options.address) || !options.trusted_proxies.empty();
}

void makeOperatorToken(FrontOptions& options) {
  constexpr std::size_t kTokenBytes = 16;
  // A class has guests of its own role, and nevertheless needs an operator.
  const bool is_wanted = options.is_class || (isReachable(options) && options.guest_role.empty());
  if (is_wanted && !hasTokens(options)) options.operator_token = access::toBase64Url(access::randomBytes(kTokenBytes));
}

core::Result<access::Access> loadAccess(const FrontOptions& options) {
  std::string text;
  std::string label = "SPINDRIFT_TOKENS";
  bool has_tokens = false;
  if (!options.token_file.empty()) {
    auto read = readFile("--tokens-file", options.token_file, kTokenFileMaxBytes, "a file of tokens");
    if (!read) return read.error();
    text = *std::move(read);
    label = options.token_file;
    has_tokens = true;
  } else if (!options.tokens.empty()) {
    text = options.tokens;
    std::ranges::replace(text, ';', '\n');  // environment variables are awkward with several lines
    has_tokens = true;
  }
  auto keys = loadJwtKeys(options);
  if (!keys) return keys.error();
  const bool has_keys = !keys->empty();
  if (!has_keys && !(options.jwt_issuer.empty() && options.jwt_audience.empty())) {
    return core::invalid(
        "--jwt-issuer and --jwt-audience without a key accept no JWT: give --jwt-key FILE or --jwt-keys FILE");
  }
  std::optional<core::Role> guest = has_tokens || has_keys ? core::Role::kViewer : core::Role::kOperator;
  if (!options.operator_token.empty()) {
    guest = core::Role::kPlayer;
    text = "operator " + options.operator_token;
    label = "operator's link";
  }
  if (!options.guest_role.empty()) guest = core::parseRole(options.guest_role);  // "none" is not a role
  auto access = access::Access::parse(text, label, guest);
  if (!access) return access;
  if (has_tokens && access->tokenCount() == 0)
    return core::invalid(label + ": there is no token in it: write lines of ROLE TOKEN");
  if (!guest && access->tokenCount() == 0 && !has_keys) {
    return core::invalid(
        "--guests none without tokens refuses every client: give --tokens-file FILE or --jwt-key FILE");
  }
  access->acceptJwts(*std::move(keys), {.issuer = options.jwt_issuer, .audience = options.jwt_audience});
  return access;
}

}  // namespace spindrift::cli
