#include "particle_cells.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>

#include "group_writer.h"
#include "particle_quanta.h"
#include "prefix_code.h"

namespace spindrift::stream {
namespace {

constexpr std::size_t kHalfSymbolCount = 256;  ///< counts of four eighths, two bits each
constexpr std::size_t kGapSymbolCount = 25;    ///< bits of the number of empty cells
constexpr std::uint32_t kMaxGammaBits = 23;

/// A whole number from 0 on, small ones in few bits (Elias gamma).
void putGamma(std::uint32_t value, BitCursor& out) {
  const auto bits = static_cast<std::uint32_t>(std::bit_width(value + 1)) - 1;
  out.put(1u << bits, bits + 1);
  out.put((value + 1) & ((1u << bits) - 1), bits);
  out.flush();
}
std::uint32_t getGamma(BitReader& in) {
  std::uint32_t bits = 0;
  while (bits < kMaxGammaBits && in.get(1) == 0) ++bits;
  return ((1u << bits) | in.get(bits)) - 1;
}

/// One attribute of the particles, group after group: each group's mean as its difference from the one before, then
/// what each particle differs from it.
struct AttributeState {
  int mean = 0;
  std::uint32_t mean_class = 0;
  std::uint32_t group_class = 0;
};

void getAttribute(ResidualGroup& values, std::size_t count, AttributeState& state, ResidualDecoder& in) {
  ResidualGroup step;
  state.mean_class = in.getGroup(step, 1, state.mean_class, state.mean_class);
  state.mean = static_cast<std::int16_t>(state.mean + step.of[0]);
  state.group_class = in.getGroup(values, count, state.group_class, state.group_class);
  for (std::int16_t& value : values.of) value = static_cast<std::int16_t>(value + state.mean);
}

static_assert(kGroupMaxCount == 64, "twice as many are 1 << 7");
constexpr std::size_t kAttributeCount = 5;  ///< velocity along x, y, z, foam, tint
using AttributeStates = std::array<AttributeState, kAttributeCount>;

/// Where an attribute stands in what attributesOf() gives: (word << up) >> down with its sign, and the mask.
struct AttributeBits {
  std::uint32_t up, down;
  std::int32_t mask;
};
constexpr std::array<AttributeBits, kAttributeCount> kAttributes = {
    {{24, 24, -1}, {16, 24, -1}, {8, 24, -1}, {0, 24, 3}, {0, 26, 7}}};

/// Of up to 64 particles.
SPINDRIFT_INLINE GroupWriter putAttributes(std::span<const std::uint64_t> items, AttributeStates& states,
                                           GroupWriter out) {
  const std::size_t count = items.size();
  const auto doubled = static_cast<int>(2 * count);
  std::array<std::uint32_t, kGroupMaxCount> words{};
  for (std::size_t k = 0; k < count; ++k) words[k] = attributesOf(items[k]);
#pragma GCC unroll 1
  for (std::size_t attribute = 0; attribute < kAttributeCount; ++attribute) {
    const AttributeBits bits = kAttributes[attribute];
    AttributeState& state = states[attribute];
    ResidualGroup values;
    for (std::size_t k = 0; k < kGroupMaxCount; ++k)
      values.of[k] =
          static_cast<std::int16_t>((static_cast<std::int32_t>(words[k] << bits.up) >> bits.down) & bits.mask);
    const int raised = 2 * GroupRows(values.of.data(), 8).sum() + static_cast<int>(count);
    // To the nearest; a shift rounds down as the other does.
    const int mean = count == kGroupMaxCount ? raised >> 7 : raised / doubled - (raised % doubled < 0 ? 1 : 0);
    state.mean_class = out.putOne(static_cast<std::int16_t>(mean - state.mean), state.mean_class);
    state.mean = mean;
    for (std::int16_t& value : values.of) value = static_cast<std::int16_t>(value - mean);
    for (std::size_t k = count; k < kGroupMaxCount; ++k) values.of[k] = 0;
    state.group_class = out.putGroup(values, count, state.group_class, state.group_class);
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
  const std::span<const std::uint64_t> items = order_.items();
  BitCursor cursor = out.begin(items.size() * bit_count / 8);
  std::size_t i = 0;
  if (4 * bit_count <= 56) {
    for (; i + 4 <= items.size(); i += 4) {
      const std::uint64_t first = placeBitsOf(items[i]) | std::uint64_t{placeBitsOf(items[i + 1])} << bit_count;
      const std::uint64_t second = placeBitsOf(items[i + 2]) | std::uint64_t{placeBitsOf(items[i + 3])} << bit_count;
      cursor.putLong(first | second << (2 * bit_count), 4 * bit_count);
      cursor.flush();
    }
  }
  for (; i < items.size(); ++i) {
    cursor.put(placeBitsOf(items[i]), bit_count);
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

bool decodeParticleCells(ResidualDecoder& in, const CellGrid& grid, std::span<CellParticle> particles) {
  BitReader& bits = in.bits();
  const auto half_code = getFittedCode(kHalfSymbolCount, bits);
  if (!half_code) return false;
  const auto gap_code = getFittedCode(kGapSymbolCount, bits);
  if (!gap_code) return false;
  const std::uint32_t low = grid.offset_bits - 1;
  const std::uint64_t cell_count = grid.totalCount();
  std::uint64_t cell = 0;
  for (std::size_t i = 0; i < particles.size(); ++cell) {
    const std::uint32_t gap_bits = gap_code->get(bits);
    cell += gap_bits > 1 ? (1u << (gap_bits - 1)) | bits.get(gap_bits - 1) : gap_bits;
    if (cell >= cell_count) return false;
    const std::uint32_t y = static_cast<std::uint32_t>(cell) % grid.cells_count[1];
    const std::uint32_t column = static_cast<std::uint32_t>(cell) / grid.cells_count[1];
    const std::uint32_t x = column % grid.cells_count[0], z = column / grid.cells_count[0];
    std::uint32_t halves = half_code->get(bits);
    halves |= half_code->get(bits) << 8;
    if (halves == 0) return false;  // a cell that is named holds something
    for (std::uint32_t eighth = 0; eighth < 8; ++eighth) {
      std::size_t count = halves >> (2 * eighth) & 3u;
      if (count == kManyCount) count += getGamma(bits);
      if (count > particles.size() - i) return false;
      const auto place = [&](std::uint32_t at, std::uint32_t half) {
        return static_cast<std::uint16_t>((at * 2 + (half & 1u)) << low);
      };
      const std::array places = {place(x, eighth >> 2), place(y, eighth), place(z, eighth >> 1)};
      for (const std::size_t end = i + count; i < end; ++i) particles[i].place = places;
    }
  }
  const std::uint32_t mask = (1u << low) - 1;
  for (CellParticle& p : particles) {
    const std::uint32_t offsets = bits.get(3 * low);
    p.place[0] = static_cast<std::uint16_t>(p.place[0] | (offsets & mask));
    p.place[2] = static_cast<std::uint16_t>(p.place[2] | (offsets >> low & mask));
    p.place[1] = static_cast<std::uint16_t>(p.place[1] | offsets >> (2 * low));
  }
  AttributeStates states;
  std::array<ResidualGroup, kAttributeCount> groups;
  for (std::size_t begin = 0; begin < particles.size(); begin += kGroupMaxCount) {
    const std::size_t count = std::min(kGroupMaxCount, particles.size() - begin);
    for (std::size_t a = 0; a < kAttributeCount; ++a) getAttribute(groups[a], count, states[a], in);
    for (std::size_t k = 0; k < count; ++k) {
      CellParticle& p = particles[begin + k];
      for (std::size_t axis = 0; axis < 3; ++axis) p.velocity[axis] = groups[axis].of[k];
      p.foam = static_cast<std::uint8_t>(std::clamp<int>(groups[3].of[k], 0, 3));
      p.tint = static_cast<std::uint8_t>(std::clamp<int>(groups[4].of[k], 0, 7));
    }
  }
  return true;
}

}  // namespace spindrift::stream
