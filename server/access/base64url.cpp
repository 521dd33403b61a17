#include <algorithm>

#include <openssl/evp.h>

#include <spindrift/access/base64url.h>

namespace spindrift::access {

std::string toBase64Url(std::string_view bytes) {
  std::string out((bytes.size() + 2) / 3 * 4 + 1, '\0');  // OpenSSL adds a zero byte
  EVP_EncodeBlock(reinterpret_cast<unsigned char*>(out.data()), reinterpret_cast<const unsigned char*>(bytes.data()),
                  static_cast<int>(bytes.size()));
  out.resize((bytes.size() * 4 + 2) / 3);  // without the padding
  std::ranges::replace(out, '+', '-');
  std::ranges::replace(out, '/', '_');
  return out;
}

std::optional<std::string> fromBase64Url(std::string_view text) {
  std::string padded(text);
  std::ranges::replace(padded, '-', '+');
  std::ranges::replace(padded, '_', '/');
  padded.resize((text.size() + 3) / 4 * 4, '=');
  std::string out(padded.size() / 4 * 3, '\0');
  if (EVP_DecodeBlock(reinterpret_cast<unsigned char*>(out.data()),
                      reinterpret_cast<const unsigned char*>(padded.data()), static_cast<int>(padded.size())) < 0) {
    return std::nullopt;
  }
  out.resize(text.size() * 3 / 4);
  // OpenSSL also takes other alphabets' characters, padding, blanks and unused bits: only the one encoding is valid.
  if (toBase64Url(out) != text) return std::nullopt;
  return out;
}

}  // namespace spindrift::access
