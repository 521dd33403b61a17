#include <bit>
#include <cstring>

#include <spindrift/core/crc32c.h>
#include <spindrift/core/crc32c_tables.h>

#if defined(__x86_64__)
#include <nmmintrin.h>
#endif

namespace spindrift::core {

#if defined(__x86_64__)
namespace {

static_assert(std::endian::native == std::endian::little, "eight bytes are loaded as one little-endian word");

__attribute__((target("sse4.2"))) std::uint32_t crc32cByInstruction(ByteView bytes) {
  std::uint64_t crc = 0xFFFFFFFFu;
  const std::uint8_t* at = bytes.data();
  std::size_t left = bytes.size();
  for (; left >= 8; left -= 8, at += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, at, sizeof word);
    crc = _mm_crc32_u64(crc, word);
  }
  auto low = static_cast<std::uint32_t>(crc);
  for (; left > 0; --left, ++at) low = _mm_crc32_u8(low, *at);
  return ~low;
}

}  // namespace
#endif

std::uint32_t crc32c(ByteView bytes) {
#if defined(__x86_64__)
  static const bool has_instruction = __builtin_cpu_supports("sse4.2") != 0;
  if (has_instruction) return crc32cByInstruction(bytes);
#endif
  return crc32cByTables(bytes.data(), bytes.size());
}

}  // namespace spindrift::core
