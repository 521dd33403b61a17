#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include <spindrift/bitstream/encode/particle_order.h>

#include "processor.h"

#if SPINDRIFT_HAS_VECTORS
#include <immintrin.h>
#endif

namespace spindrift::codec {
namespace {

constexpr int kRadixBits = 11;
/// Up to this many cells per particle, a pass over all cells costs less than sorting.
constexpr std::uint64_t kCountedCells = 8;
constexpr std::uint64_t kEveryByte = 0x0101010101010101u;

/// Returns the lowest two bits of each byte, packed.
std::uint16_t packedPairs(std::uint64_t bytes) {
  std::uint64_t x = (bytes | bytes >> 6) & 0x000f000f000f000fu;
  x = (x | x >> 12) & 0x000000ff000000ffu;
  return static_cast<std::uint16_t>(x | x >> 24);
}

std::uint64_t sumOfBytes(std::uint64_t bytes) {
  constexpr std::uint64_t kEven = 0x00ff00ff00ff00ffu;
  return ((bytes & kEven) + (bytes >> 8 & kEven)) * 0x0001000100010001u >> 48;
}

/// Returns the highest bit of each byte that is kManyCount or more.
std::uint64_t whereMany(std::uint64_t bytes) {
  return (((bytes & 0x7f * kEveryByte) + (0x80 - kManyCount) * kEveryByte) | bytes) & 0x80 * kEveryByte;
}

/// Bit k: word k of 64 is not 0.
std::uint64_t notZero(std::span<const std::uint64_t> words) {
  std::uint64_t out = 0;
  for (std::size_t k = 0; k < 64; k += 8) {
    std::uint64_t eight = 0;
    for (std::size_t j = 0; j < 8; ++j) eight |= std::uint64_t{words[k + j] != 0} << j;
    out |= eight << k;
  }
  return out;
}

#if SPINDRIFT_HAS_VECTORS
__attribute__((target("avx2"))) std::uint64_t notZeroWithVectors(std::span<const std::uint64_t> words) {
  std::uint64_t zero = 0;
  for (std::size_t k = 0; k < 64; k += 4) {
    const __m256i four = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(words.data() + k));
    const __m256d is_zero = _mm256_castsi256_pd(_mm256_cmpeq_epi64(four, _mm256_setzero_si256()));
    zero |= std::uint64_t{static_cast<std::uint32_t>(_mm256_movemask_pd(is_zero))} << k;
  }
  return ~zero;
}
#else
std::uint64_t notZeroWithVectors(std::span<const std::uint64_t> words) {
  return notZero(words);
}
#endif

}  // namespace

void ParticleOrder::sort(std::span<const std::uint32_t> keys, std::span<const std::uint64_t> items,
                         std::uint64_t cell_count) {
  if (cell_count > kCountedCells * keys.size() || !sortByCounting(keys, items, cell_count))
    sortByDigits(keys, items, cell_count);
}

/// False: a cell holds more particles than a byte can count.
bool ParticleOrder::sortByCounting(std::span<const std::uint32_t> keys, std::span<const std::uint64_t> items,
                                   std::uint64_t cell_count) {
  static_assert(std::endian::native == std::endian::little, "byte e of a cell's word is its eighth e");
  if (counts_.size() < cell_count) counts_.resize((cell_count + 63) / 64 * 64);
  begins_.resize(counts_.size());
  ranks_.resize(keys.size());
  items_.resize(keys.size());
  auto* bytes = reinterpret_cast<std::uint8_t*>(counts_.data());
  std::uint8_t* ranks = ranks_.data();
  std::uint32_t overflow = 0;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const std::uint8_t rank = bytes[keys[i]]++;
    ranks[i] = rank;
    overflow |= (rank + 1u) & 0x100u;
  }
  if (overflow != 0) {
    std::ranges::fill(counts_, 0);
    return false;
  }
  cells_.clear();
  extras_.clear();
  const auto find = usesVectors() ? notZeroWithVectors : notZero;
  std::uint32_t begin = 0, next_cell = 0;
  for (std::uint64_t first = 0; first < cell_count; first += 64) {
    const std::span<std::uint64_t> some = std::span(counts_).subspan(first, 64);
    for (std::uint64_t occupied = find(some); occupied != 0; occupied &= occupied - 1) {
      const auto cell = static_cast<std::uint32_t>(first) + static_cast<std::uint32_t>(std::countr_zero(occupied));
      std::uint64_t counts = counts_[cell];
      const std::uint64_t sum = sumOfBytes(counts);
      if (sum > 255) {
        std::ranges::fill(counts_, 0);
        return false;
      }
      begins_[cell] = begin;
      counts_[cell] = (counts * kEveryByte) << 8;
      begin += static_cast<std::uint32_t>(sum);
      for (std::uint64_t many = whereMany(counts); many != 0; many &= many - 1) {
        const int shift = std::countr_zero(many) - 7;
        const std::uint64_t extra = (counts >> shift & 0xffu) - kManyCount;
        extras_.push_back(static_cast<std::uint32_t>(extra));
        counts -= extra << shift;
      }
      cells_.push_back({cell - next_cell, packedPairs(counts)});
      next_cell = cell + 1;
    }
  }
  std::uint64_t* sorted = items_.data();
  for (std::size_t i = 0; i < keys.size(); ++i) sorted[begins_[keys[i] >> 3] + bytes[keys[i]] + ranks[i]] = items[i];
  // Clear the counts for the next frame.
  std::uint32_t used = 0;
  for (const OccupiedCell& cell : cells_) {
    used += cell.gap;
    counts_[used++] = 0;
  }
  return true;
}

void ParticleOrder::sortByDigits(std::span<const std::uint32_t> keys, std::span<const std::uint64_t> items,
                                 std::uint64_t cell_count) {
  entries_.resize(keys.size());
  scratch_.resize(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) entries_[i] = {keys[i], static_cast<std::uint32_t>(i)};
  // Radix sort from the lowest digit to the highest; each pass is stable.
  for (int shift = 0; (cell_count * 8 - 1) >> shift != 0; shift += kRadixBits) {
    std::array<std::uint32_t, 1 << kRadixBits> begin{};
    const auto digit = [shift](const Entry& e) { return e.key >> shift & ((1u << kRadixBits) - 1); };
    for (const Entry& e : entries_) ++begin[digit(e)];
    std::uint32_t sum = 0;
    for (std::uint32_t& b : begin) sum += std::exchange(b, sum);
    for (const Entry& e : entries_) scratch_[begin[digit(e)]++] = e;
    std::swap(entries_, scratch_);
  }
  items_.clear();
  cells_.clear();
  extras_.clear();
  std::uint32_t next_cell = 0;
  for (std::size_t i = 0; i < entries_.size();) {
    OccupiedCell cell{.gap = (entries_[i].key >> 3) - next_cell};
    next_cell += cell.gap + 1;
    for (std::uint32_t eighth = 0; eighth < 8; ++eighth) {
      std::uint32_t count = 0;
      for (; i < entries_.size() && entries_[i].key == (next_cell - 1) * 8 + eighth; ++i, ++count)
        items_.push_back(items[entries_[i].particle]);
      cell.halves |= static_cast<std::uint16_t>(std::min(count, kManyCount) << (2 * eighth));
      if (count >= kManyCount) extras_.push_back(count - kManyCount);
    }
    cells_.push_back(cell);
  }
}

}  // namespace spindrift::codec
