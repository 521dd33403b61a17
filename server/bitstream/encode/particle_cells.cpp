#include <algorithm>
#include <array>
#include <bit>
#include <cassert>

#include <spindrift/bitstream/encode/particle_cells.h>

#include "group_writer.h"
#include "prefix_code.h"

namespace spindrift::codec {
namespace {

/// Writes a whole number >= 0, small ones in few bits (Elias gamma).
void putGamma(std::uint32_t value, BitCursor& out) {
  const auto bits = static_cast<std::uint32_t>(std::bit_width(value + 1)) - 1;
  out.put(1u << bits, bits + 1);
  out.put((value + 1) & ((1u << bits) - 1), bits);
  out.flush();
}

/// State of one attribute of the particles: each group's mean is coded as the difference from the previous mean, then
/// each particle's difference from the mean.
struct AttributeState {
  int mean = 0;
  std::uint32_t mean_class = 0;
  std::uint32_t group_class = 0;
};

static_assert(kGroupMaxCount == 64, "twice as many are 1 << 7");
constexpr std::size_t kAttributeCount = 5;  ///< velocity along x, y, z, foam, tint
using AttributeStates = std::array<AttributeState, kAttributeCount>;

/// Position of an attribute in the upper word of an item: (word << up) >> down with its sign, and the mask.
struct AttributeBits {
  std::uint32_t up, down;
  std::int32_t mask;
};
constexpr std::array<AttributeBits, kAttributeCount> kAttributes = {
    {{24, 24, -1}, {16, 24, -1}, {8, 24, -1}, {0, 24, 3}, {0, 26, 7}}};

/// Writes the attributes of up to 64 particles.
SPINDRIFT_INLINE GroupWriter putAttributes(std::span<const std::uint64_t> items, AttributeStates& states,
                                           GroupWriter out) {
  const std::size_t count = items.size();
  const auto doubled = static_cast<int>(2 * count);
  std::array<std::uint32_t, kGroupMaxCount> words{};
  for (std::size_t k = 0; k < count; ++k) words[k] = static_cast<std::uint32_t>(items[k] >> 32);
#pragma GCC unroll 1
  for (std::size_t attribute = 0; attribute < kAttributeCount; ++attribute) {
    const AttributeBits bits = kAttributes[attribute];
    AttributeState& state = states[attribute];
    ResidualGroup values;
    for (std::size_t k = 0; k < kGroupMaxCount; ++k)
      values.of[k] =
          static_cast<std::int16_t>((static_cast<std::int32_t>(words[k] << bits.up) >> bits.down) & bits.mask);
    const int raised = 2 * GroupRows(values.of.data()).sum() + static_cast<int>(count);
    // Rounds to nearest. Both branches floor: the shift does, and the division is corrected for negative values.
    const int mean = count == kGroupMaxCount ? raised >> 7 : raised / doubled - (raised % doubled < 0 ? 1 : 0);
    state.mean_class = out.putOne(static_cast<std::int16_t>(mean - state.mean), state.mean_class);
    state.mean = mean;
    for (std::int16_t& value : values.of) value = static_cast<std::int16_t>(value - mean);
    for (std::size_t k = count; k < kGroupMaxCount; ++k) values.of[k] = 0;
    state.group_class = out.putGroup(GroupRows(values.of.data()), count, state.group_class, state.group_class);
  }
  return out;
}
GroupWriter putAttributesPlainly(std::span<const std::uint64_t> items, AttributeStates& states, GroupWriter out) {
  return putAttributes(items, states, out);
}
SPINDRIFT_VECTORS GroupWriter putAttributesWithVectors(std::span<const std::uint64_t> items, AttributeStates& states,
                                                       GroupWriter out) {
  return putAttributes(items, states, out);
}

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
    if (gap_bits > 1) {
      cursor.put(cell.gap & ((1u << (gap_bits - 1)) - 1), gap_bits - 1);
      cursor.flush();
    }
    half_code.put(cell.halves & 0xffu, cursor);
    half_code.put(cell.halves >> 8, cursor);
    cursor.flush();
    std::uint32_t many = cell.halves & cell.halves >> 1 & 0x5555u;
    for (; many != 0; many &= many - 1) putGamma(*extra++, cursor);
  }
  out.end(cursor);
}

void ParticleCellsEncoder::putPlaces(std::uint32_t bit_count, BitWriter& out) const {
  const auto placeOf = [](std::uint64_t item) { return item & 0xffffffffu; };
  const std::span<const std::uint64_t> items = order_.items();
  BitCursor cursor = out.begin(items.size() * bit_count / 8);
  std::size_t i = 0;
  if (4 * bit_count <= 56) {
    for (; i + 4 <= items.size(); i += 4) {
      const std::uint64_t first = placeOf(items[i]) | placeOf(items[i + 1]) << bit_count;
      const std::uint64_t second = placeOf(items[i + 2]) | placeOf(items[i + 3]) << bit_count;
      cursor.put(first | second << (2 * bit_count), 4 * bit_count);
      cursor.flush();
    }
  }
  for (; i < items.size(); ++i) {
    cursor.put(placeOf(items[i]), bit_count);
    cursor.flush();
  }
  out.end(cursor);
}

void ParticleCellsEncoder::putAttributes(ResidualEncoder& out) const {
  const auto put = usesVectors() ? putAttributesWithVectors : putAttributesPlainly;
  std::span<const std::uint64_t> items = order_.items();
  AttributeStates states;
  while (!items.empty()) {
    const std::size_t count = std::min(kGroupMaxCount, items.size());
    out.end(put(items.first(count), states, out.begin(2 * kAttributeCount)));
    items = items.subspan(count);
  }
}

}  // namespace spindrift::codec
