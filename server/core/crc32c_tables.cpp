#include <array>
#include <bit>
#include <cstring>

#include <spindrift/core/crc32c_tables.h>

namespace spindrift::core {
namespace {

static_assert(std::endian::native == std::endian::little, "eight bytes are loaded as one little-endian word");

constexpr std::uint32_t kReflectedPolynomial = 0x82F63B78u;

using Tables = std::array<std::array<std::uint32_t, 256>, 16>;

/// tables[k][b]: checksum of byte b followed by k zero bytes.
constexpr Tables makeTables() {
  Tables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? kReflectedPolynomial : 0u);
    tables[0][byte] = crc;
  }
  for (std::size_t k = 1; k < tables.size(); ++k) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t previous = tables[k - 1][byte];
      tables[k][byte] = (previous >> 8) ^ tables[0][previous & 0xFFu];
    }
  }
  return tables;
}

constexpr Tables kTables = makeTables();

}  // namespace

std::uint32_t crc32cByTables(const std::uint8_t* bytes, std::size_t byte_count) {
  std::uint32_t crc = ~0u;
  for (; byte_count >= 16; byte_count -= 16, bytes += 16) {
    std::uint64_t low = 0, high = 0;
    std::memcpy(&low, bytes, sizeof low);
    std::memcpy(&high, bytes + sizeof low, sizeof high);
    low ^= crc;
    crc = 0;
    for (unsigned k = 0; k < 8; ++k)
      crc ^= kTables[15 - k][(low >> (8 * k)) & 0xFFu] ^ kTables[7 - k][(high >> (8 * k)) & 0xFFu];
  }
  for (; byte_count > 0; --byte_count, ++bytes) crc = (crc >> 8) ^ kTables[0][(crc ^ *bytes) & 0xFFu];
  return ~crc;
}

}  // namespace spindrift::core
