// Keys from PEM texts, secrets, and JWK sets: RFC 7517, with the members of RFC 7518 section 6 and RFC 8037 section 2.
#include <array>

#include <openssl/bn.h>
#include <openssl/core_names.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/param_build.h>
#include <openssl/pem.h>

#include <spindrift/access/base64url.h>
#include <spindrift/access/jwt.h>

#include "json_object.h"

namespace spindrift::access {
namespace {

namespace json = boost::json;

constexpr std::size_t kIdMaxBytes = 256;
constexpr std::size_t kRsaMaxBytes = 2048;  // 16,384 bits; larger keys take long to use

template <auto kFree>
struct Freeing {
  void operator()(auto* object) const { kFree(object); }
};
template <typename Object, auto kFree>
using Owned = std::unique_ptr<Object, Freeing<kFree>>;
using Number = Owned<BIGNUM, BN_free>;

const unsigned char* bytesOf(const std::string& text) {
  return reinterpret_cast<const unsigned char*>(text.data());
}

core::Error refusal(const std::string& label, const std::string& why) {
  return core::invalid(label + ": " + why);
}

// Keys under which anybody could sign

/// On the curve of Ed25519, -x^2 + y^2 = 1 + d x^2 y^2 with d = -121665/121666 modulo p = 2^255 - 19 (RFC 8032 section
/// 5.1), the points whose order divides 8 are those with y = 1 and -1 (orders 1 and 2), y = 0 (order 4), and x^2 = -y^2
/// (order 8, as doubling then gives y = 0). The last turns the curve's equation into d y^4 + 2 y^2 - 1 = 0. So their y
/// are the roots of y (y^2 - 1) (-121665 y^4 + 121666 (2 y^2 - 1)). y need not be smaller than p in the key's bytes.
bool hasSmallOrder(std::array<unsigned char, 32> point) {
  constexpr BN_ULONG kA = 121665;
  constexpr BN_ULONG kB = 121666;
  point.back() &= 0x7F;  // the sign of x
  const Owned<BN_CTX, BN_CTX_free> context(BN_CTX_new());
  const Number p(BN_new());
  const Number y(BN_lebin2bn(point.data(), static_cast<int>(point.size()), nullptr));
  const Number square(BN_new());
  const Number one_less(BN_new());
  const Number quartic(BN_new());
  const Number product(BN_new());
  BN_set_bit(p.get(), 255);
  BN_sub_word(p.get(), 19);
  BN_mod_sqr(square.get(), y.get(), p.get(), context.get());
  BN_copy(one_less.get(), square.get());
  BN_sub_word(one_less.get(), 1);  // -1 for y = 0
  BN_copy(product.get(), square.get());
  BN_add(product.get(), product.get(), one_less.get());  // 2 y^2 - 1
  BN_mul_word(product.get(), kB);
  BN_mod_sqr(quartic.get(), square.get(), p.get(), context.get());
  BN_mul_word(quartic.get(), kA);
  BN_sub(quartic.get(), product.get(), quartic.get());
  BN_mod_mul(product.get(), y.get(), one_less.get(), p.get(), context.get());
  BN_mod_mul(product.get(), product.get(), quartic.get(), p.get(), context.get());
  return BN_is_zero(product.get()) == 1;
}

std::string weaknessOfRsa(const EVP_PKEY& key) {
  if (const int bits = EVP_PKEY_get_bits(&key); bits < kJwtRsaMinBits) {
    return "the RSA key has " + std::to_string(bits) + " bits; at least " + std::to_string(kJwtRsaMinBits) +
           " are needed";
  }
  BIGNUM* found = nullptr;
  const bool has_exponent = EVP_PKEY_get_bn_param(&key, OSSL_PKEY_PARAM_RSA_E, &found) == 1;
  const Number exponent(found);
  if (!has_exponent || BN_is_odd(exponent.get()) == 0 || BN_is_one(exponent.get()) == 1)
    return "the RSA key has an exponent that is 1 or even: anybody could sign for it; make a new key";
  return "";
}

/// Returns why an RSA or Ed25519 key must not be used, in one line; empty if it may be. RSA: fewer than kJwtRsaMinBits
/// bits, or an exponent that is 1 or even. Ed25519: a point of small order, for which one signature fits all texts.
std::string weaknessOf(const EVP_PKEY& key) {
  if (EVP_PKEY_get_base_id(&key) == EVP_PKEY_RSA) return weaknessOfRsa(key);
  std::array<unsigned char, 32> point{};
  std::size_t size = point.size();
  if (EVP_PKEY_get_raw_public_key(&key, point.data(), &size) != 1 || size != point.size())
    return "the Ed25519 key has not 32 bytes";
  return hasSmallOrder(point) ? "the Ed25519 key is a point of small order: anybody could sign for it; make a new key"
                              : "";
}

// JWK sets

/// Returns the member as text; empty where it is missing or no text.
std::string_view textOf(const json::object& object, std::string_view member) {
  const json::value* const found = object.if_contains(member);
  return found && found->is_string() ? std::string_view(found->get_string()) : std::string_view();
}

std::optional<std::string> decoded(const json::object& object, std::string_view member) {
  const std::string_view text = textOf(object, member);
  return text.empty() ? std::nullopt : fromBase64Url(text);
}

std::shared_ptr<EVP_PKEY> rsaKey(const std::string& modulus, const std::string& exponent) {
  const Number n(BN_bin2bn(bytesOf(modulus), static_cast<int>(modulus.size()), nullptr));
  const Number e(BN_bin2bn(bytesOf(exponent), static_cast<int>(exponent.size()), nullptr));
  const Owned<OSSL_PARAM_BLD, OSSL_PARAM_BLD_free> builder(OSSL_PARAM_BLD_new());
  if (!n || !e || !builder || OSSL_PARAM_BLD_push_BN(builder.get(), OSSL_PKEY_PARAM_RSA_N, n.get()) != 1 ||
      OSSL_PARAM_BLD_push_BN(builder.get(), OSSL_PKEY_PARAM_RSA_E, e.get()) != 1) {
    return nullptr;
  }
  const Owned<OSSL_PARAM, OSSL_PARAM_free> parameters(OSSL_PARAM_BLD_to_param(builder.get()));
  const Owned<EVP_PKEY_CTX, EVP_PKEY_CTX_free> context(EVP_PKEY_CTX_new_from_name(nullptr, "RSA", nullptr));
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

core::Result<JwtKey> parseKey(const json::object& object, JwtAlgorithm algorithm, const std::string& label) {
  JwtKey out{.algorithm = algorithm, .id = std::string(textOf(object, "kid"))};
  if (out.id.size() > kIdMaxBytes) {
    return refusal(label, "kid is longer than " + std::to_string(kIdMaxBytes) + " bytes");
  }
  if (algorithm == JwtAlgorithm::kHs256) {
    const auto secret = decoded(object, "k");
    if (!secret) return refusal(label, "k is not base64url");
    if (secret->size() < kJwtSecretMinBytes) {
      return refusal(label, "the secret has " + std::to_string(secret->size()) + " bytes; HS256 needs at least " +
                                std::to_string(kJwtSecretMinBytes));
    }
    out.secret = *secret;
    return out;
  }
  if (object.contains("d")) {
    return refusal(label, "it holds a private key (d): give the server the public part only");
  }
  if (algorithm == JwtAlgorithm::kEdDsa) {
    if (const auto x = decoded(object, "x")) {
      out.public_key.reset(EVP_PKEY_new_raw_public_key(EVP_PKEY_ED25519, nullptr, bytesOf(*x), x->size()),
                           &EVP_PKEY_free);
    }
    ERR_clear_error();
    if (!out.public_key) return refusal(label, "x is not base64url of the 32 bytes of an Ed25519 key");
  } else {
    const auto modulus = decoded(object, "n");
    const auto exponent = decoded(object, "e");
    if (!modulus || !exponent || modulus->size() > kRsaMaxBytes || exponent->size() > kRsaMaxBytes) {
      return refusal(label, "n and e are not base64url of an RSA key");
    }
    out.public_key = rsaKey(*modulus, *exponent);
    ERR_clear_error();
    if (!out.public_key) return refusal(label, "n and e are not an RSA key");
  }
  if (const std::string why = weaknessOf(*out.public_key); !why.empty()) return refusal(label, why);
  return out;
}

}  // namespace

std::string_view nameOf(JwtAlgorithm algorithm) {
  constexpr std::string_view kNames[] = {"HS256", "RS256", "EdDSA"};
  return kNames[static_cast<std::size_t>(algorithm)];
}

core::Result<JwtKey> parsePublicKey(std::string_view pem, const std::string& label) {
  if (pem.find("PRIVATE KEY-----") != std::string_view::npos) {
    return refusal(label, "this is a private key; the server needs the public one only: openssl pkey -in FILE -pubout");
  }
  const Owned<BIO, BIO_free> text(BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())));
  JwtKey out;
  // PEM_read_bio_PUBKEY asks nobody for a password: public keys have none.
  out.public_key.reset(text ? PEM_read_bio_PUBKEY(text.get(), nullptr, nullptr, nullptr) : nullptr, &EVP_PKEY_free);
  ERR_clear_error();
  if (!out.public_key) {
    return refusal(label,
                   "there is no public key in it: a PEM file begins with -----BEGIN PUBLIC KEY-----; for a shared "
                   "secret write hs256:FILE");
  }
  switch (EVP_PKEY_get_base_id(out.public_key.get())) {
    case EVP_PKEY_RSA:
      out.algorithm = JwtAlgorithm::kRs256;
      break;
    case EVP_PKEY_ED25519:
      out.algorithm = JwtAlgorithm::kEdDsa;
      break;
    default:
      return refusal(label, "keys of this kind are not supported: use RSA (RS256) or Ed25519 (EdDSA)");
  }
  if (const std::string why = weaknessOf(*out.public_key); !why.empty()) return refusal(label, why);
  return out;
}

core::Result<JwtKey> parseSecret(std::string_view text, const std::string& label) {
  if (text.ends_with('\n')) text.remove_suffix(1);
  if (text.ends_with('\r')) text.remove_suffix(1);
  if (text.starts_with("-----BEGIN ")) {
    return refusal(label, "this is a PEM file, not a secret; a public key is given without hs256:");
  }
  if (text.size() < kJwtSecretMinBytes) {
    return refusal(label, "the secret has " + std::to_string(text.size()) + " bytes; HS256 needs at least " +
                              std::to_string(kJwtSecretMinBytes) + ", as `openssl rand -hex 32` makes them");
  }
  return JwtKey{.algorithm = JwtAlgorithm::kHs256, .secret = std::string(text)};
}

core::Result<std::vector<JwtKey>> parseKeySet(std::string_view text, const std::string& label) {
  const auto set = parseJsonObject(text);
  if (!set) return refusal(label, "it is not a JWK set: " + set.error().message);
  const json::value* const keys = set->if_contains("keys");
  if (!keys || !keys->is_array())
    return refusal(label, "it is not a JWK set: an object with an array \"keys\" is expected");
  std::vector<JwtKey> out;
  int number = 0;
  for (const json::value& one : keys->get_array()) {
    const std::string which = label + ": key " + std::to_string(++number);
    if (!one.is_object()) return refusal(which, "it is not an object");
    const auto algorithm = algorithmOf(one.get_object());
    if (!algorithm) continue;
    auto key = parseKey(one.get_object(), *algorithm, which);
    if (!key) return key.error();
    out.push_back(*std::move(key));
  }
  if (out.empty()) return refusal(label, "it has no key for HS256 (oct), RS256 (RSA) or EdDSA (OKP with Ed25519)");
  if (out.size() > kJwtKeyMaxCount) {
    return refusal(label, "it has " + std::to_string(out.size()) + " keys; at most " + std::to_string(kJwtKeyMaxCount));
  }
  return out;
}

}  // namespace spindrift::access
