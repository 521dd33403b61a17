#include "particle_order.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace spindrift::stream {
namespace {

constexpr int kRadixBits = 11;
/// Up to this many cells a particle, looking at all cells costs less than sorting.
constexpr std::uint64_t kCountedCells = 8;
constexpr std::uint64_t kEveryByte = 0x0101010101010101u;

/// The lowest two bits of each byte, side by side.
std::uint16_t packedPairs(std::uint64_t bytes) {
  std::uint64_t x = (bytes | bytes >> 6) & 0x000f000f000f000fu;
  x = (x | x >> 12) & 0x000000ff000000ffu;
  return static_cast<std::uint16_t>(x | x >> 24);
}

std::uint64_t sumOfBytes(std::uint64_t bytes) {
  constexpr std::uint64_t kEven = 0x00ff00ff00ff00ffu;
  return ((bytes & kEven) + (bytes >> 8 & kEven)) * 0x0001000100010001u >> 48;
}

bool hasMany(std::uint64_t bytes) {
  return ((((bytes & 0x7f * kEveryByte) + (0x80 - kManyCount) * kEveryByte) | bytes) & 0x80 * kEveryByte) != 0;
}

}  // namespace

void ParticleOrder::sort(std::span<const std::uint32_t> keys, std::span<const std::uint64_t> items,
                         std::uint64_t cell_count) {
  if (cell_count > kCountedCells * keys.size() || !sortByCounting(keys, items, cell_count))
    sortByDigits(keys, items, cell_count);
}

/// False: a cell holds more than a byte can count.
bool ParticleOrder::sortByCounting(std::span<const std::uint32_t> keys, std::span<const std::uint64_t> items,
                                   std::uint64_t cell_count) {
  static_assert(std::endian::native == std::endian::little, "byte e of a cell's word is its eighth e");
  counts_.assign(cell_count, 0);
  begins_.resize(cell_count);
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
  if (overflow != 0) return false;
  cells_.clear();
  extras_.clear();
  std::uint32_t begin = 0, next_cell = 0;
  const std::uint64_t* words = counts_.data();
  for (std::uint32_t cell = 0; cell < cell_count; ++cell) {
    while (cell + 4 <= cell_count && (words[cell] | words[cell + 1] | words[cell + 2] | words[cell + 3]) == 0)
      cell += 4;
    if (cell == cell_count) break;
    std::uint64_t counts = words[cell];
    if (counts == 0) continue;
    const std::uint64_t sum = sumOfBytes(counts);
    if (sum > 255) return false;
    begins_[cell] = begin;
    counts_[cell] = (counts * kEveryByte) << 8;
    begin += static_cast<std::uint32_t>(sum);
    if (hasMany(counts)) {
      for (int shift = 0; shift < 64; shift += 8) {
        const auto count = static_cast<std::uint32_t>(counts >> shift & 0xffu);
        if (count < kManyCount) continue;
        extras_.push_back(count - kManyCount);
        counts -= std::uint64_t{count - kManyCount} << shift;
      }
    }
    cells_.push_back({cell - next_cell, packedPairs(counts)});
    next_cell = cell + 1;
  }
  std::uint64_t* sorted = items_.data();
  for (std::size_t i = 0; i < keys.size(); ++i) sorted[begins_[keys[i] >> 3] + bytes[keys[i]] + ranks[i]] = items[i];
  return true;
}

void ParticleOrder::sortByDigits(std::span<const std::uint32_t> keys, std::span<const std::uint64_t> items,
                                 std::uint64_t cell_count) {
  entries_.resize(keys.size());
  scratch_.resize(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) entries_[i] = {keys[i], static_cast<std::uint32_t>(i)};
  // From the lowest digit to the highest; each pass keeps the order of equal digits.
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

}  // namespace spindrift::stream
