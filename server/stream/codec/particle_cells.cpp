#include "particle_cells.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <utility>

#include "fitted_table.h"

namespace spindrift::stream {
namespace {

constexpr std::size_t kHalfSymbolCount = 256;  ///< counts of four eighths, two bits each
constexpr std::size_t kGapSymbolCount = 25;    ///< bits of the number of empty cells
constexpr std::uint32_t kManyCount = 3;        ///< this many in an eighth, or more: the rest is in the raw bits
constexpr int kRadixBits = 11;
constexpr int kMaxGammaBits = 23;

/// A whole number from 0 on, small ones in few bits (Elias gamma).
void putGamma(std::uint32_t value, ResidualEncoder& out) {
  const int bits = static_cast<int>(std::bit_width(value + 1)) - 1;
  out.putRaw(0, bits);
  out.putRaw(1, 1);
  out.putRaw((value + 1) & ((1u << bits) - 1), bits);
}
std::uint32_t getGamma(ResidualDecoder& in) {
  int bits = 0;
  while (bits < kMaxGammaBits && in.getRaw(1) == 0) ++bits;
  return ((1u << bits) | in.getRaw(bits)) - 1;
}

/// Which eighth of its cell a place lies in: x, z, y from the highest bit on.
std::uint32_t eighthOf(const CellParticle& p, std::uint32_t offset_bits) {
  const std::uint32_t high = offset_bits - 1;
  return (p.place[0] >> high & 1u) << 2 | (p.place[2] >> high & 1u) << 1 | (p.place[1] >> high & 1u);
}

std::uint32_t lowBits(const CellParticle& p, std::uint32_t bits) {
  const std::uint32_t mask = (1u << bits) - 1;
  return (p.place[0] & mask) | (p.place[2] & mask) << bits | (p.place[1] & mask) << (2 * bits);
}

/// One attribute of the particles, group after group: each group's mean as its difference from the one before, then
/// what each particle differs from it.
struct AttributeState {
  std::int16_t mean = 0;
  std::uint32_t mean_class = 0;
  std::uint32_t group_class = 0;
};

void putAttribute(std::span<std::int16_t> values, AttributeState& state, ResidualEncoder& out) {
  int sum = 0;
  for (const std::int16_t value : values) sum += value;
  const auto mean = static_cast<std::int16_t>(std::lround(static_cast<float>(sum) / static_cast<float>(values.size())));
  const std::array step = {static_cast<std::int16_t>(mean - state.mean)};
  state.mean_class = out.putGroup(step, state.mean_class, state.mean_class);
  state.mean = mean;
  for (std::int16_t& value : values) value = static_cast<std::int16_t>(value - mean);
  state.group_class = out.putGroup(values, state.group_class, state.group_class);
}

void getAttribute(std::span<std::int16_t> values, AttributeState& state, ResidualDecoder& in) {
  std::array<std::int16_t, 1> step{};
  state.mean_class = in.getGroup(step, state.mean_class, state.mean_class);
  state.mean = static_cast<std::int16_t>(state.mean + step[0]);
  state.group_class = in.getGroup(values, state.group_class, state.group_class);
  for (std::int16_t& value : values) value = static_cast<std::int16_t>(value + state.mean);
}

constexpr std::size_t kAttributeCount = 5;  ///< velocity along x, y, z, foam, tint

}  // namespace

void ParticleCellsEncoder::sortByCell(std::span<const CellParticle> particles, const CellGrid& grid) {
  const std::uint32_t bits = grid.offset_bits;
  entries_.resize(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const CellParticle& p = particles[i];
    const std::uint32_t cell =
        ((p.place[0] >> bits) * grid.cells_count[2] + (p.place[2] >> bits)) * grid.cells_count[1] +
        (p.place[1] >> bits);
    entries_[i] = {cell * 8 + eighthOf(p, bits), static_cast<std::uint32_t>(i)};
  }
  // From the lowest digit to the highest; each pass keeps the order of equal digits.
  scratch_.resize(entries_.size());
  for (int shift = 0; (grid.totalCount() * 8 - 1) >> shift != 0; shift += kRadixBits) {
    std::array<std::uint32_t, 1 << kRadixBits> begin{};
    const auto digit = [shift](const Entry& e) { return e.key >> shift & ((1u << kRadixBits) - 1); };
    for (const Entry& e : entries_) ++begin[digit(e)];
    std::uint32_t sum = 0;
    for (std::uint32_t& b : begin) sum += std::exchange(b, sum);
    for (const Entry& e : entries_) scratch_[begin[digit(e)]++] = e;
    std::swap(entries_, scratch_);
  }
}

void ParticleCellsEncoder::encode(std::span<const CellParticle> particles, const CellGrid& grid, ResidualEncoder& out) {
  assert(grid.totalCount() <= kCellMaxCount && grid.offset_bits >= 1 && grid.offset_bits <= kOffsetBitsMax);
  sortByCell(particles, grid);

  // Once over the cells for their symbols and how often each occurs, once more to write.
  cells_.clear();
  std::array<std::uint32_t, kHalfSymbolCount> half_counts{};
  std::array<std::uint32_t, kGapSymbolCount> gap_counts{};
  std::uint32_t next_cell = 0;
  for (std::size_t i = 0; i < entries_.size();) {
    Cell cell{.gap = (entries_[i].key >> 3) - next_cell, .end = 0, .halves = {0, 0}};
    next_cell += cell.gap + 1;
    for (std::uint32_t eighth = 0; eighth < 8; ++eighth) {
      std::uint32_t count = 0;
      while (i + count < entries_.size() && entries_[i + count].key == (next_cell - 1) * 8 + eighth) ++count;
      cell.halves[eighth / 4] |= static_cast<std::uint8_t>(std::min(count, kManyCount) << (2 * (eighth % 4)));
      i += count;
    }
    cell.end = static_cast<std::uint32_t>(i);
    ++gap_counts[std::bit_width(cell.gap)];
    for (const std::uint8_t half : cell.halves) ++half_counts[half];
    cells_.push_back(cell);
  }
  const SymbolTable half_table = putFittedTable(half_counts, out);
  const SymbolTable gap_table = putFittedTable(gap_counts, out);

  const std::uint32_t low = grid.offset_bits - 1;
  std::size_t i = 0;
  for (const Cell& cell : cells_) {
    const auto gap_bits = static_cast<int>(std::bit_width(cell.gap));
    out.put(gap_table, static_cast<std::size_t>(gap_bits));
    if (gap_bits > 1) out.putRaw(cell.gap & ((1u << (gap_bits - 1)) - 1), gap_bits - 1);
    for (const std::uint8_t half : cell.halves) out.put(half_table, half);
    while (i < cell.end) {
      const std::uint32_t key = entries_[i].key;
      std::size_t end = i;
      while (end < cell.end && entries_[end].key == key) ++end;
      if (end - i >= kManyCount) putGamma(static_cast<std::uint32_t>(end - i) - kManyCount, out);
      for (; i < end; ++i) out.putRaw(lowBits(particles[entries_[i].particle], low), static_cast<int>(3 * low));
    }
  }

  std::array<AttributeState, kAttributeCount> attributes;
  std::array<std::array<std::int16_t, kGroupMaxCount>, kAttributeCount> group{};
  for (std::size_t begin = 0; begin < entries_.size(); begin += kGroupMaxCount) {
    const std::size_t count = std::min(kGroupMaxCount, entries_.size() - begin);
    for (std::size_t k = 0; k < count; ++k) {
      const CellParticle& p = particles[entries_[begin + k].particle];
      for (std::size_t axis = 0; axis < 3; ++axis) group[axis][k] = p.velocity[axis];
      group[3][k] = p.foam;
      group[4][k] = p.tint;
    }
    for (std::size_t a = 0; a < kAttributeCount; ++a)
      putAttribute(std::span(group[a]).first(count), attributes[a], out);
  }
}

bool decodeParticleCells(ResidualDecoder& in, const CellGrid& grid, std::span<CellParticle> particles) {
  const SymbolTable half_table = getFittedTable(kHalfSymbolCount, in);
  const SymbolTable gap_table = getFittedTable(kGapSymbolCount, in);
  const std::uint32_t low = grid.offset_bits - 1;
  const std::uint32_t mask = (1u << low) - 1;
  const std::uint64_t cell_count = grid.totalCount();
  std::uint64_t cell = 0;
  for (std::size_t i = 0; i < particles.size(); ++cell) {
    const auto gap_bits = static_cast<int>(in.get(gap_table));
    cell += gap_bits > 1 ? (1u << (gap_bits - 1)) | in.getRaw(gap_bits - 1) : static_cast<std::uint32_t>(gap_bits);
    if (cell >= cell_count) return false;
    const std::uint32_t y = static_cast<std::uint32_t>(cell) % grid.cells_count[1];
    const std::uint32_t column = static_cast<std::uint32_t>(cell) / grid.cells_count[1];
    const std::uint32_t z = column % grid.cells_count[2], x = column / grid.cells_count[2];
    const std::size_t begin = i;
    std::uint32_t halves = in.get(half_table);
    halves |= in.get(half_table) << 8;
    for (std::uint32_t eighth = 0; eighth < 8; ++eighth) {
      std::size_t count = halves >> (2 * eighth) & 3u;
      if (count == kManyCount) count += getGamma(in);
      if (count > particles.size() - i) return false;
      for (const std::size_t end = i + count; i < end; ++i) {
        const std::uint32_t bits = in.getRaw(static_cast<int>(3 * low));
        const auto place = [&](std::uint32_t at, std::uint32_t half, std::uint32_t offset) {
          return static_cast<std::uint16_t>((at * 2 + half) << low | (offset & mask));
        };
        particles[i].place = {place(x, eighth >> 2, bits), place(y, eighth & 1u, bits >> (2 * low)),
                              place(z, eighth >> 1 & 1u, bits >> low)};
      }
    }
    if (i == begin) return false;  // a cell that is named holds something
  }
  std::array<AttributeState, kAttributeCount> attributes;
  std::array<std::array<std::int16_t, kGroupMaxCount>, kAttributeCount> group{};
  for (std::size_t begin = 0; begin < particles.size(); begin += kGroupMaxCount) {
    const std::size_t count = std::min(kGroupMaxCount, particles.size() - begin);
    for (std::size_t a = 0; a < kAttributeCount; ++a) getAttribute(std::span(group[a]).first(count), attributes[a], in);
    for (std::size_t k = 0; k < count; ++k) {
      CellParticle& p = particles[begin + k];
      for (std::size_t axis = 0; axis < 3; ++axis) p.velocity[axis] = group[axis][k];
      p.foam = static_cast<std::uint8_t>(std::clamp<int>(group[3][k], 0, 3));
      p.tint = static_cast<std::uint8_t>(std::clamp<int>(group[4][k], 0, 7));
    }
  }
  return true;
}

}  // namespace spindrift::stream
