#include <random>
#include <string_view>

#include <gtest/gtest.h>

#include <spindrift/core/crc32c.h>
#include <spindrift/core/crc32c_tables.h>

namespace spindrift::core {
namespace {

ByteView viewOf(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::uint32_t crc32cTable(ByteView bytes) {
  return crc32cByTables(bytes.data(), bytes.size());
}

/// The definition, bit by bit, as the reference for the fast implementations.
std::uint32_t bitwiseCrc32c(ByteView bytes) {
  std::uint32_t crc = ~0u;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0x82F63B78u : 0u);
  }
  return ~crc;
}

TEST(Crc32c, EqualsThePublishedCheckValueByTables) {
  EXPECT_EQ(crc32cTable(viewOf("123456789")), 0xE3069283u);
}

TEST(Crc32c, EqualsThePublishedCheckValueOnThisMachine) {
  EXPECT_EQ(crc32c(viewOf("123456789")), 0xE3069283u);
}

TEST(Crc32c, NoBytesGiveZero) {
  EXPECT_EQ(crc32c({}), 0u);
  EXPECT_EQ(crc32cTable({}), 0u);
}

TEST(Crc32c, AgreesWithTheBitwiseDefinition) {
  std::mt19937 random(20240611);
  Bytes bytes(300);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  for (std::size_t begin = 0; begin < 9; ++begin) {
    for (std::size_t size = 0; size + begin <= bytes.size(); size += 1 + size / 40) {
      const auto part = ByteView(bytes).subspan(begin, size);
      const std::uint32_t expected = bitwiseCrc32c(part);
      ASSERT_EQ(crc32cTable(part), expected) << "begin " << begin << " size " << size;
      ASSERT_EQ(crc32c(part), expected) << "begin " << begin << " size " << size;
    }
  }
}

}  // namespace
}  // namespace spindrift::core
