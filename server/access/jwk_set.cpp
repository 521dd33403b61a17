// Keys from a JWK set: RFC 7517, with the members of RFC 7518 section 6 and RFC 8037 section 2.
#include <openssl/bn.h>
#include <openssl/core_names.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/param_build.h>

#include <spindrift/access/base64url.h>
#include <spindrift/access/jwt.h>

#include "json_object.h"
#include "public_keys.h"

namespace spindrift::access {
namespace {

namespace json = boost::json;

constexpr std::size_t kIdMaxBytes = 256;
constexpr std::size_t kRsaMaxBytes = 2048;  // 16,384 bits; larger keys take long to use

/// Returns the member as text; empty where it is missing or no text.
std::string_view textOf(const json::object& object, std::string_view member) {
  const json::value* const found = object.if_contains(member);
  return found && found->is_string() ? std::string_view(found->get_string()) : std::string_view();
}

std::optional<std::string> bytesOf(const json::object& object, std::string_view member) {
  const std::string_view text = textOf(object, member);
  return text.empty() ? std::nullopt : fromBase64Url(text);
}

std::shared_ptr<EVP_PKEY> rsaKey(const std::string& modulus, const std::string& exponent) {
  const auto number = [](const std::string& bytes) {
    return std::unique_ptr<BIGNUM, decltype(&BN_free)>(
        BN_bin2bn(reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<int>(bytes.size()), nullptr),
        &BN_free);
  };
  const auto n = number(modulus);
  const auto e = number(exponent);
  const std::unique_ptr<OSSL_PARAM_BLD, decltype(&OSSL_PARAM_BLD_free)> builder(OSSL_PARAM_BLD_new(),
                                                                                &OSSL_PARAM_BLD_free);
  if (!n || !e || !builder || OSSL_PARAM_BLD_push_BN(builder.get(), OSSL_PKEY_PARAM_RSA_N, n.get()) != 1 ||
      OSSL_PARAM_BLD_push_BN(builder.get(), OSSL_PKEY_PARAM_RSA_E, e.get()) != 1) {
    return nullptr;
  }
  const std::unique_ptr<OSSL_PARAM, decltype(&OSSL_PARAM_free)> parameters(OSSL_PARAM_BLD_to_param(builder.get()),
                                                                           &OSSL_PARAM_free);
  const std::unique_ptr<EVP_PKEY_CTX, decltype(&EVP_PKEY_CTX_free)> context(
      EVP_PKEY_CTX_new_from_name(nullptr, "RSA", nullptr), &EVP_PKEY_CTX_free);
  EVP_PKEY* key = nullptr;
  if (!parameters || !context || EVP_PKEY_fromdata_init(context.get()) != 1 ||
      EVP_PKEY_fromdata(context.get(), &key, EVP_PKEY_PUBLIC_KEY, parameters.get()) != 1) {
    return nullptr;
  }
  return {key, &EVP_PKEY_free};
}

/// The algorithm that a JWK is for; nullopt: none of ours.
std::optional<JwtAlgorithm> algorithmOf(const json::object& key) {
  const std::string_view kind = textOf(key, "kty");
  std::optional<JwtAlgorithm> out;
  if (kind == "oct") out = JwtAlgorithm::kHs256;
  if (kind == "RSA") out = JwtAlgorithm::kRs256;
  if (kind == "OKP" && textOf(key, "crv") == "Ed25519") out = JwtAlgorithm::kEdDsa;
  if (!out) return std::nullopt;
  const bool is_other_use = key.contains("use") && textOf(key, "use") != "sig";
  const bool is_other_algorithm = key.contains("alg") && textOf(key, "alg") != nameOf(*out);
  return is_other_use || is_other_algorithm ? std::nullopt : out;
}

/// Returns the key, or why it is invalid.
std::variant<JwtKey, std::string> parseKey(const json::object& object, JwtAlgorithm algorithm) {
  JwtKey out{.algorithm = algorithm, .id = std::string(textOf(object, "kid"))};
  if (out.id.size() > kIdMaxBytes) return "kid is longer than " + std::to_string(kIdMaxBytes) + " bytes";
  if (algorithm == JwtAlgorithm::kHs256) {
    const auto secret = bytesOf(object, "k");
    if (!secret) return "k is not base64url";
    if (secret->size() < kJwtSecretMinBytes) {
      return "the secret has " + std::to_string(secret->size()) + " bytes; HS256 needs at least " +
             std::to_string(kJwtSecretMinBytes);
    }
    out.secret = *secret;
    return out;
  }
  if (object.contains("d")) return "it holds a private key (d): give the server the public part only";
  if (algorithm == JwtAlgorithm::kEdDsa) {
    const auto x = bytesOf(object, "x");
    if (x) {
      out.public_key.reset(EVP_PKEY_new_raw_public_key(EVP_PKEY_ED25519, nullptr,
                                                       reinterpret_cast<const unsigned char*>(x->data()), x->size()),
                           &EVP_PKEY_free);
    }
    ERR_clear_error();
    if (!out.public_key) return "x is not base64url of the 32 bytes of an Ed25519 key";
    if (std::string why = weaknessOf(*out.public_key); !why.empty()) return why;
    return out;
  }
  const auto modulus = bytesOf(object, "n");
  const auto exponent = bytesOf(object, "e");
  if (!modulus || !exponent || modulus->size() > kRsaMaxBytes || exponent->size() > kRsaMaxBytes)
    return "n and e are not base64url of an RSA key";
  out.public_key = rsaKey(*modulus, *exponent);
  ERR_clear_error();
  if (!out.public_key) return "n and e are not an RSA key";
  if (std::string why = weaknessOf(*out.public_key); !why.empty()) return why;
  return out;
}

}  // namespace

core::Result<std::vector<JwtKey>> parseKeySet(std::string_view text, const std::string& label) {
  const auto refuse = [&](const std::string& why) {
    return core::Error{core::ErrorCode::kInvalidInput, label + ": " + why};
  };
  const auto set = parseJsonObject(text);
  if (!set) return refuse("it is not a JWK set: " + set.error().message);
  const json::value* const keys = set->if_contains("keys");
  if (!keys || !keys->is_array()) return refuse("it is not a JWK set: an object with an array \"keys\" is expected");
  std::vector<JwtKey> out;
  std::size_t number = 0;
  for (const json::value& one : keys->get_array()) {
    const std::string which = "key " + std::to_string(++number) + ": ";
    if (!one.is_object()) return refuse(which + "it is not an object");
    const auto algorithm = algorithmOf(one.get_object());
    if (!algorithm) continue;
    auto key = parseKey(one.get_object(), *algorithm);
    if (const auto* why = std::get_if<std::string>(&key)) return refuse(which + *why);
    out.push_back(std::get<JwtKey>(std::move(key)));
  }
  if (out.empty()) return refuse("it has no key for HS256 (oct), RS256 (RSA) or EdDSA (OKP with Ed25519)");
  if (out.size() > kJwtKeyMaxCount) {
    return refuse("it has " + std::to_string(out.size()) + " keys; at most " + std::to_string(kJwtKeyMaxCount));
  }
  return out;
}

}  // namespace spindrift::access
