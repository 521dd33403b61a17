// Makes JSON Web Tokens for tests, with keys that are generated at the start of the test program.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rsa.h>

#include <spindrift/access/base64url.h>
#include <spindrift/access/digest.h>

namespace spindrift::test {

inline constexpr const char* kJwtSecret = "a-secret-of-at-least-32-characters";

using KeyPair = std::shared_ptr<EVP_PKEY>;

inline KeyPair makeRsaKey(unsigned bits = 2048) {
  return {EVP_RSA_gen(bits), &EVP_PKEY_free};
}
inline KeyPair makeEd25519Key() {
  return {EVP_PKEY_Q_keygen(nullptr, nullptr, "ED25519"), &EVP_PKEY_free};
}
inline KeyPair makeEcKey() {
  return {EVP_PKEY_Q_keygen(nullptr, nullptr, "EC", "P-256"), &EVP_PKEY_free};
}

/// The public key as PEM, or with `is_private` the private one.
inline std::string pemOf(const KeyPair& key, bool is_private = false) {
  const std::unique_ptr<BIO, decltype(&BIO_free)> out(BIO_new(BIO_s_mem()), &BIO_free);
  const int done = is_private ? PEM_write_bio_PrivateKey(out.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr)
                              : PEM_write_bio_PUBKEY(out.get(), key.get());
  char* text = nullptr;
  const long size = BIO_get_mem_data(out.get(), &text);
  if (done != 1) throw std::runtime_error("no PEM");
  return {text, static_cast<std::size_t>(size)};
}

/// The bytes of an Ed25519 public key.
inline std::string rawPublicKey(const KeyPair& key) {
  std::string out(32, '\0');
  std::size_t size = out.size();
  if (EVP_PKEY_get_raw_public_key(key.get(), reinterpret_cast<unsigned char*>(out.data()), &size) != 1)
    throw std::runtime_error("no raw key");
  return out;
}

inline std::string unsignedToken(const std::string& header, const std::string& claims) {
  return access::toBase64Url(header) + "." + access::toBase64Url(claims);
}

/// A token with any header, signed with HMAC and SHA-256.
inline std::string hmacToken(const std::string& header, const std::string& claims, const std::string& secret) {
  const std::string text = unsignedToken(header, claims);
  const access::Digest digest = access::hmacOf(secret, text);
  return text + "." + access::toBase64Url({reinterpret_cast<const char*>(digest.data()), digest.size()});
}

inline std::string hs256(const std::string& claims, const std::string& secret = kJwtSecret) {
  return hmacToken(R"({"alg":"HS256","typ":"JWT"})", claims, secret);
}

/// A token with any header, signed with a private key; RSA with SHA-256.
inline std::string signedToken(const std::string& header, const std::string& claims, const KeyPair& key) {
  const std::string text = unsignedToken(header, claims);
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(), &EVP_MD_CTX_free);
  const EVP_MD* const hash = EVP_PKEY_get_base_id(key.get()) == EVP_PKEY_ED25519 ? nullptr : EVP_sha256();
  const auto* const bytes = reinterpret_cast<const unsigned char*>(text.data());
  std::size_t size = 0;
  if (EVP_DigestSignInit(context.get(), nullptr, hash, nullptr, key.get()) != 1 ||
      EVP_DigestSign(context.get(), nullptr, &size, bytes, text.size()) != 1)
    throw std::runtime_error("no signature");
  std::string signature(size, '\0');
  if (EVP_DigestSign(context.get(), reinterpret_cast<unsigned char*>(signature.data()), &size, bytes, text.size()) != 1)
    throw std::runtime_error("no signature");
  signature.resize(size);
  return text + "." + access::toBase64Url(signature);
}

}  // namespace spindrift::test
