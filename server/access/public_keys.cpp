#include "public_keys.h"

#include <array>
#include <memory>

#include <openssl/bn.h>
#include <openssl/core_names.h>
#include <openssl/evp.h>

#include <spindrift/access/jwt.h>

namespace spindrift::access {
namespace {

using Number = std::unique_ptr<BIGNUM, decltype(&BN_free)>;

Number number(BIGNUM* value) {
  return {value, &BN_free};
}

/// On the curve of Ed25519, -x^2 + y^2 = 1 + d x^2 y^2 with d = -121665/121666 modulo p = 2^255 - 19 (RFC 8032 section
/// 5.1), the points whose order divides 8 are those with y = 1 and -1 (orders 1 and 2), y = 0 (order 4), and x^2 = -y^2
/// (order 8, as doubling then gives y = 0). The last turns the curve's equation into d y^4 + 2 y^2 - 1 = 0. So their y
/// are the roots of y (y^2 - 1) (-121665 y^4 + 121666 (2 y^2 - 1)). y need not be smaller than p in the key's bytes.
bool hasSmallOrder(std::array<unsigned char, 32> point) {
  constexpr BN_ULONG kA = 121665;
  constexpr BN_ULONG kB = 121666;
  point.back() &= 0x7F;  // the sign of x
  const std::unique_ptr<BN_CTX, decltype(&BN_CTX_free)> context(BN_CTX_new(), &BN_CTX_free);
  const Number p = number(BN_new());
  const Number y = number(BN_lebin2bn(point.data(), static_cast<int>(point.size()), nullptr));
  const Number square = number(BN_new());
  const Number one_less = number(BN_new());
  const Number quartic = number(BN_new());
  const Number product = number(BN_new());
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
  const Number exponent = number(found);
  if (!has_exponent || BN_is_odd(exponent.get()) == 0 || BN_is_one(exponent.get()) == 1)
    return "the RSA key has an exponent that is 1 or even: anybody could sign for it; make a new key";
  return "";
}

}  // namespace

std::string weaknessOf(const EVP_PKEY& key) {
  if (EVP_PKEY_get_base_id(&key) == EVP_PKEY_RSA) return weaknessOfRsa(key);
  std::array<unsigned char, 32> point{};
  std::size_t size = point.size();
  if (EVP_PKEY_get_raw_public_key(&key, point.data(), &size) != 1 || size != point.size())
    return "the Ed25519 key has not 32 bytes";
  return hasSmallOrder(point) ? "the Ed25519 key is a point of small order: anybody could sign for it; make a new key"
                              : "";
}

}  // namespace spindrift::access
