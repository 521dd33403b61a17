#include <bit>
#include <cstring>

#include <spindrift/core/crc32c.h>
#include <spindrift/core/crc32c_tables.h>

#if defined(__x86_64__)
#include <nmmintrin.h>
#endif

namespace spindrift::core {
namespace {

static_assert(std::endian::native == std::endian::little, "eight bytes are loaded as one little-endian word");

std::uint64_t load64(const std::uint8_t* at) {
  std::uint64_t word = 0;
  std::memcpy(&word, at, sizeof word);
  return word;
}

}  // namespace

std::uint32_t crc32cTable(ByteView bytes) {
  return crc32cByTables(bytes.data(), bytes.size());
}

#if defined(__x86_64__)

bool hasCrc32cInstruction() {
  static const bool has = __builtin_cpu_supports("sse4.2") != 0;
  return has;
}

__attribute__((target("sse4.2"))) std::uint32_t crc32cInstruction(ByteView bytes) {
  std::uint64_t crc = 0xFFFFFFFFu;
  const std::uint8_t* at = bytes.data();
  std::size_t left = bytes.size();
  for (; left >= 8; left -= 8, at += 8) crc = _mm_crc32_u64(crc, load64(at));
  auto low = static_cast<std::uint32_t>(crc);
  for (; left > 0; --left, ++at) low = _mm_crc32_u8(low, *at);
  return ~low;
}

#else

bool hasCrc32cInstruction() {
  return false;
}

std::uint32_t crc32cInstruction(ByteView bytes) {
  return crc32cTable(bytes);
}

#endif

std::uint32_t crc32c(ByteView bytes) {
  return hasCrc32cInstruction() ? crc32cInstruction(bytes) : crc32cTable(bytes);
}

}  // namespace spindrift::core
