#include <array>
#include <cstdint>

#include <spindrift/access/base64url.h>

namespace spindrift::access {
namespace {

constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
constexpr std::uint8_t kNone = 0xFF;

constexpr std::array<std::uint8_t, 256> makeValues() {
  std::array<std::uint8_t, 256> out{};
  out.fill(kNone);
  for (std::size_t k = 0; k < kAlphabet.size(); ++k)
    out[static_cast<unsigned char>(kAlphabet[k])] = static_cast<std::uint8_t>(k);
  return out;
}

constexpr std::array<std::uint8_t, 256> kValues = makeValues();

}  // namespace

std::optional<std::string> fromBase64Url(std::string_view text) {
  if (text.size() % 4 == 1) return std::nullopt;
  std::string out;
  out.reserve(text.size() * 3 / 4);
  std::uint32_t bits = 0;
  int bit_count = 0;
  for (const char c : text) {
    const std::uint8_t value = kValues[static_cast<unsigned char>(c)];
    if (value == kNone) return std::nullopt;
    bits = (bits << 6) | value;
    bit_count += 6;
    if (bit_count < 8) continue;
    bit_count -= 8;
    out.push_back(static_cast<char>((bits >> bit_count) & 0xFFu));
  }
  if ((bits & ((1u << bit_count) - 1u)) != 0) return std::nullopt;
  return out;
}

std::string toBase64Url(std::string_view bytes) {
  std::string out;
  out.reserve((bytes.size() * 4 + 2) / 3);
  std::uint32_t bits = 0;
  int bit_count = 0;
  for (const char c : bytes) {
    bits = (bits << 8) | static_cast<unsigned char>(c);
    bit_count += 8;
    for (; bit_count >= 6; bit_count -= 6) out.push_back(kAlphabet[(bits >> (bit_count - 6)) & 63u]);
  }
  if (bit_count > 0) out.push_back(kAlphabet[(bits << (6 - bit_count)) & 63u]);
  return out;
}

}  // namespace spindrift::access
