// Keys from PEM texts and secrets.
#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/pem.h>

#include <spindrift/access/jwt.h>

#include "public_keys.h"

namespace spindrift::access {
namespace {

core::Error refusal(const std::string& label, const std::string& why) {
  return {core::ErrorCode::kInvalidInput, label + ": " + why};
}

}  // namespace

std::string_view nameOf(JwtAlgorithm algorithm) {
  switch (algorithm) {
    case JwtAlgorithm::kHs256:
      return "HS256";
    case JwtAlgorithm::kRs256:
      return "RS256";
    case JwtAlgorithm::kEdDsa:
      return "EdDSA";
  }
  return "";
}

core::Result<JwtKey> parsePublicKey(std::string_view pem, const std::string& label) {
  if (pem.find("PRIVATE KEY-----") != std::string_view::npos) {
    return refusal(label, "this is a private key; the server needs the public one only: openssl pkey -in FILE -pubout");
  }
  const std::unique_ptr<BIO, decltype(&BIO_free)> text(BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())),
                                                       &BIO_free);
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

}  // namespace spindrift::access
