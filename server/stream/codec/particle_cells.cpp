#include "particle_cells.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>

#include "particle_quanta.h"
#include "prefix_code.h"

namespace spindrift::stream {
namespace {

/// A whole number from 0 on, small ones in few bits (Elias gamma).
void putGamma(std::uint32_t value, BitCursor& out) {
  const auto bits = static_cast<std::uint32_t>(std::bit_width(value + 1)) - 1;
  out.put(1u << bits, bits + 1);
  out.flush();
  out.put((value + 1) & ((1u << bits) - 1), bits);
  out.flush();
}

/// One attribute of the particles, group after group: each group's mean as its difference from the one before, then
/// what each particle differs from it.
struct AttributeState {
  int mean = 0;
  std::uint32_t mean_class = 0;
  std::uint32_t group_class = 0;
};

void putAttribute(ResidualGroup& values, std::size_t count, AttributeState& state, ResidualEncoder& out) {
  int sum = 0;
  for (const std::int16_t value : values.of) sum += value;
  const auto doubled = static_cast<int>(2 * count);
  const int raised = 2 * sum + static_cast<int>(count);
  const int mean = raised / doubled - (raised % doubled < 0 ? 1 : 0);  // to the nearest
  ResidualGroup step;
  step.of[0] = static_cast<std::int16_t>(mean - state.mean);
  state.mean_class = out.putGroup(step, 1, state.mean_class, state.mean_class);
  state.mean = mean;
  for (std::int16_t& value : values.of) value = static_cast<std::int16_t>(value - mean);
  for (std::size_t k = count; k < kGroupMaxCount; ++k) values.of[k] = 0;
  state.group_class = out.putGroup(values, count, state.group_class, state.group_class);
}

constexpr std::size_t kAttributeCount = 5;  ///< velocity along x, y, z, foam, tint

}  // namespace

void ParticleCellsEncoder::encode(std::span<const std::uint32_t> words, const ParticleScale& scale,
                                  const CellGrid& grid, ResidualEncoder& out) {
  assert(grid.totalCount() <= kCellMaxCount && grid.offset_bits >= 1 && grid.offset_bits <= kOffsetBitsMax);
  keys_.resize(words.size() / 3);
  items_.resize(words.size() / 3);
  quantizeParticles(words, scale, grid, keys_, items_);
  order_.sort(keys_, items_, grid.totalCount());
  putCells(out.bits());
  putPlaces(3 * (grid.offset_bits - 1), out.bits());
  putAttributes(out);
}

void ParticleCellsEncoder::putCells(BitWriter& out) const {
  std::array<std::uint32_t, kHalfSymbolCount> half_counts{};
  std::array<std::uint32_t, kGapSymbolCount> gap_counts{};
  for (const OccupiedCell& cell : order_.cells()) {
    ++gap_counts[static_cast<std::size_t>(std::bit_width(cell.gap))];
    ++half_counts[cell.halves & 0xffu];
    ++half_counts[cell.halves >> 8];
  }
  const PrefixWriter half_code = putFittedCode(half_counts, out);
  const PrefixWriter gap_code = putFittedCode(gap_counts, out);
  constexpr std::size_t kCellMaxBytes = 8, kExtraMaxBytes = 8;
  BitCursor cursor = out.begin(kCellMaxBytes * order_.cells().size() + kExtraMaxBytes * order_.extras().size());
  const std::uint32_t* extra = order_.extras().data();
  for (const OccupiedCell& cell : order_.cells()) {
    const auto gap_bits = static_cast<std::uint32_t>(std::bit_width(cell.gap));
    gap_code.put(gap_bits, cursor);
    if (gap_bits > 1) cursor.put(cell.gap & ((1u << (gap_bits - 1)) - 1), gap_bits - 1);
    cursor.flush();
    half_code.put(cell.halves & 0xffu, cursor);
    half_code.put(cell.halves >> 8, cursor);
    cursor.flush();
    std::uint32_t many = cell.halves & cell.halves >> 1 & 0x5555u;
    for (; many != 0; many &= many - 1) putGamma(*extra++, cursor);
  }
  out.end(cursor);
}

void ParticleCellsEncoder::putPlaces(std::uint32_t bit_count, BitWriter& out) const {
  const std::span<const std::uint64_t> items = order_.items();
  BitCursor cursor = out.begin(items.size() * bit_count / 8);
  for (std::size_t i = 0; i < items.size(); ++i) {
    cursor.put(placeBitsOf(items[i]), bit_count);
    if (i % 2 != 0) cursor.flush();
  }
  out.end(cursor);
}

void ParticleCellsEncoder::putAttributes(ResidualEncoder& out) const {
  const std::span<const std::uint64_t> items = order_.items();
  std::array<AttributeState, kAttributeCount> states;
  std::array<ResidualGroup, kAttributeCount> groups;
  for (std::size_t begin = 0; begin < items.size(); begin += kGroupMaxCount) {
    const std::size_t count = std::min(kGroupMaxCount, items.size() - begin);
    if (count < kGroupMaxCount) groups = {};
    for (std::size_t k = 0; k < count; ++k) {
      const std::uint32_t word = attributesOf(items[begin + k]);
      groups[0].of[k] = static_cast<std::int8_t>(word);
      groups[1].of[k] = static_cast<std::int8_t>(word >> 8);
      groups[2].of[k] = static_cast<std::int8_t>(word >> 16);
      groups[3].of[k] = static_cast<std::int16_t>(word >> 24 & 3);
      groups[4].of[k] = static_cast<std::int16_t>(word >> 26);
    }
    for (std::size_t a = 0; a < kAttributeCount; ++a) putAttribute(groups[a], count, states[a], out);
  }
}

}  // namespace spindrift::stream
