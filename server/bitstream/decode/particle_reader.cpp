#include <algorithm>
#include <cstring>

#include <spindrift/bitstream/decode/particle_reader.h>
#include <spindrift/bitstream/decode/residual_reader.h>

#include "format/short_vectors.h"
#include "prefix_slots.h"

namespace spindrift::codec {
namespace {

constexpr std::uint32_t kUsualOffsetBits = 5;

bool isWithinBounds(const CellGrid& grid) {
  if (grid.offset_bits < 1 || grid.offset_bits > kOffsetBitsMax) return false;
  const auto isAllowed = [&](std::uint32_t cells) {
    return cells >= 1 && cells <= kCoordinateMaxCount >> grid.offset_bits;
  };
  return std::all_of(grid.cells_count.begin(), grid.cells_count.end(), isAllowed) && grid.totalCount() <= kCellMaxCount;
}

std::uint32_t getGamma(BitSource& in) {
  std::uint32_t bits = 0;
  while (bits < kMaxGammaBits && in.get(1) == 0) ++bits;
  return ((1u << bits) | in.get(bits)) - 1;
}

/// Packs x, z, y of 16 bits each, in the layout of a particle's words.
constexpr std::uint64_t placeOf(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
  return x | z << 16 | y << 32;
}

/// Table by the counts of four eighths (two bits each): number of particles before the end of each eighth, one byte
/// each.
constexpr std::array<std::uint32_t, kHalfSymbolCount> makeEnds() {
  std::array<std::uint32_t, kHalfSymbolCount> ends{};
  for (std::uint32_t symbol = 0; symbol < ends.size(); ++symbol) {
    for (std::uint32_t e = 0, count = 0; e < 4; ++e) {
      count += symbol >> (2 * e) & 3u;
      ends[symbol] |= count << (8 * e);
    }
  }
  return ends;
}
constexpr std::array<std::uint32_t, kHalfSymbolCount> kEnds = makeEnds();

/// Decodes the cells: writes the corner of its eighth as each particle's position.
class CellReader {
 public:
  CellReader(std::uint32_t count, const CellGrid& grid, std::uint8_t* out) : grid_(grid), out_(out), left_(count) {
    const std::uint32_t low = grid.offset_bits - 1;
    for (std::size_t e = 0; e < 8; ++e) eighths_[e] = placeOf(e >> 2, e & 1, e >> 1 & 1) << low;
  }

  bool read(BitSource& from) {
    PrefixSlots half_code, gap_code;
    if (!half_code.read(kHalfSymbolCount, from) || !gap_code.read(kGapSymbolCount, from)) return false;
    BitSource bits = from;  // a copy stays in registers
    const auto [cells_x, cells_y, cells_z] = grid_.cells_count;
    std::uint32_t x = 0, y = 0, z = 0;
    for (; left_ > 0; ++y) {
      // At most 11 bits for the gap's code, 23 raw bits, 22 bits for the two halves.
      bits.prepare();
      std::uint64_t window = bits.peek();
      const Slot gap = gap_code[window];
      const std::uint32_t raw_bits = gap.symbol - (gap.symbol > 0 ? 1u : 0u);
      window >>= gap.length;
      const std::uint32_t one = gap.symbol > 0 ? 1u : 0u;
      y += (one << raw_bits) + (static_cast<std::uint32_t>(window) & ((1u << raw_bits) - 1));
      window >>= raw_bits;
      // The next cell is mostly in this column or the next one: handled without a branch.
      const std::uint32_t is_beyond = y >= cells_y ? 1 : 0;
      y -= cells_y & (0 - is_beyond);
      x += is_beyond;
      if (y >= cells_y) {
        x += y / cells_y;
        y %= cells_y;
      }
      if (x >= cells_x) {
        z += x / cells_x;
        x %= cells_x;
        if (z >= cells_z) return false;
      }
      const Slot low_half = half_code[window], high_half = half_code[window >> low_half.length];
      bits.take(gap.length + raw_bits + low_half.length + high_half.length);
      const std::uint32_t halves = low_half.symbol | static_cast<std::uint32_t>(high_half.symbol) << 8;
      if (halves == 0) return false;  // a coded cell is not empty
      const std::uint64_t corner = placeOf(x, y, z) << grid_.offset_bits;
      const bool has_many = (halves & halves >> 1 & 0x5555u) != 0;
      if (!has_many && left_ >= kSureCount)
        putFew(corner, low_half.symbol, high_half.symbol);
      else if (!putMany(corner, halves, bits))
        return false;
    }
    from = bits;
    return true;
  }

 private:
  /// Largest number of particles in eight eighths with at most two each.
  static constexpr std::uint32_t kSureCount = 16;

  static void put(std::uint8_t* at, std::uint64_t place) { std::memcpy(at, &place, sizeof place); }
  /// For cells with at most two particles per eighth: always writes two per eighth; the next eighth overwrites the
  /// surplus.
  void putFew(std::uint64_t corner, std::size_t low_half, std::size_t high_half) {
    const std::uint32_t low_ends = kEnds[low_half];
    const std::uint32_t high_ends = kEnds[high_half] + (low_ends >> 24) * 0x01010101u;
    const std::uint64_t ends = low_ends | std::uint64_t{high_ends} << 32;
    const std::uint64_t begins = ends << 8;
    std::uint8_t* const out = out_;
    for (std::size_t e = 0; e < 8; ++e) {
      std::uint8_t* const at = out + kParticleWordBytes * (begins >> (8 * e) & 0xffu);
      const std::uint64_t place = corner + eighths_[e];
      put(at, place);
      put(at + kParticleWordBytes, place);
    }
    left_ -= high_ends >> 24;
    out_ = out + kParticleWordBytes * (high_ends >> 24);
  }
  bool putMany(std::uint64_t corner, std::uint32_t halves, BitSource& bits) {
    for (std::size_t e = 0; e < 8; ++e, halves >>= 2) {
      std::uint32_t count = halves & 3u;
      if (count == kManyCount) count += getGamma(bits);
      if (count > left_) return false;
      left_ -= count;
      for (; count > 0; --count, out_ += kParticleWordBytes) put(out_, corner + eighths_[e]);
    }
    return true;
  }

  const CellGrid grid_;
  std::uint8_t* out_;
  std::uint32_t left_;
  std::array<std::uint64_t, 8> eighths_;
};

/// State of one attribute of the particles from group to group: a value is the group's mean plus a residual.
struct Attribute {
  ResidualGroup values;
  std::int16_t mean = 0;
  std::uint32_t mean_class = 0;
  std::uint32_t group_class = 0;

  void read(ResidualReader& in, std::size_t count) {
    ResidualGroup& step = values;
    mean_class = in.group(step, 1, mean_class, mean_class);
    mean = static_cast<std::int16_t>(mean + step.of[0]);
    group_class = in.group(values, count, group_class, group_class);
    if (group_class == 0) return fill64(values.of.data(), mean);
    for (std::int16_t& value : values.of) value = static_cast<std::int16_t>(value + mean);
  }
};

Shorts clamped(Shorts v, std::int16_t least, std::int16_t most) {
  const Shorts low = Shorts{} + least, high = Shorts{} + most;
  v = v < low ? low : v;
  return v > high ? high : v;
}
Shorts bytesOf(Shorts velocities) {
  return clamped(velocities, -127, 127) & 0xff;
}
/// 255 / 7 of a tint, rounded down, is tint times this over 32.
constexpr int kTintScale = 1166;
static_assert([] {
  for (int tint = 0; tint < 8; ++tint) {
    if (tint * kTintScale / 32 != tint * 255 / 7) return false;
  }
  return true;
}());
Shorts tintsOf(Shorts tints) {
  return clamped(tints, 0, 7) * kTintScale >> 5;
}
Shorts foamsOf(Shorts foams) {
  return clamped(foams, 0, 3) * 85;
}

/// Velocity, tint and foam of a group: the last six bytes of each particle, as two and four bytes.
struct Tails {
  alignas(16) std::array<std::uint16_t, kGroupMaxCount> first;
  alignas(16) std::array<std::uint32_t, kGroupMaxCount> second;
};

struct Attributes {
  Attribute vx, vy, vz, foam, tint;

  void read(ResidualReader& in, std::size_t count, Tails& out) {
    for (Attribute* attribute : {&vx, &vy, &vz, &foam, &tint}) attribute->read(in, count);
    for (std::size_t k = 0; k < kGroupMaxCount; k += 8) {
      const auto valuesOf = [k](const Attribute& attribute) {
        return loadVector<Shorts>(attribute.values.of.data() + k);
      };
      storeVector(out.first.data() + k, bytesOf(valuesOf(vx)) | bytesOf(valuesOf(vy)) << 8);
      const Shorts low = bytesOf(valuesOf(vz)) | tintsOf(valuesOf(tint)) << 8, high = foamsOf(valuesOf(foam));
      storeVector(out.second.data() + k, interleaveLow(low, high));
      storeVector(out.second.data() + k + 4, interleaveHigh(low, high));
    }
  }
};

/// Adds the low bits of the positions and the attributes of a group to the positions from the cells. `place`: position
/// of the low bits.
void putGroup(const BitSource& bits, std::uint32_t place, std::uint32_t low, const Tails& tails, std::size_t count,
              std::uint8_t* out) {
  const std::uint64_t mask = (1u << low) - 1;
  for (std::size_t k = 0; k < count; ++k, out += kParticleWordBytes, place += 3 * low) {
    const std::uint64_t offsets = bits.peekAt(place);
    std::uint64_t word = 0;
    std::memcpy(&word, out, sizeof word);
    word |= (offsets & mask) | (offsets >> low & mask) << 16 | (offsets >> 2 * low & mask) << 32 |
            std::uint64_t{tails.first[k]} << 48;
    std::memcpy(out, &word, sizeof word);
    std::memcpy(out + sizeof word, &tails.second[k], sizeof tails.second[k]);
  }
}

/// The same for cells of 32 quanta, the server's usual size: shifts by constants.
void putUsualGroup(const BitSource& bits, std::uint32_t place, const Tails& tails, std::size_t count,
                   std::uint8_t* out) {
  constexpr std::uint32_t kLow = kUsualOffsetBits - 1, kAtOnce = 4;
  static_assert(kAtOnce * 3 * kLow <= 57);
  std::size_t k = 0;
  for (; k + kAtOnce <= count; k += kAtOnce, place += kAtOnce * 3 * kLow) {
    const std::uint64_t window = bits.peekAt(place);
    for (std::size_t i = k; i < k + kAtOnce; ++i, out += kParticleWordBytes) {
      const std::uint64_t offsets = window >> (i - k) * 3 * kLow;
      std::uint64_t word = 0;
      std::memcpy(&word, out, sizeof word);
      word |=
          (offsets & 0xfu) | (offsets & 0xf0u) << 12 | (offsets & 0xf00u) << 24 | std::uint64_t{tails.first[i]} << 48;
      std::memcpy(out, &word, sizeof word);
      std::memcpy(out + sizeof word, &tails.second[i], sizeof tails.second[i]);
    }
  }
  if (k == count) return;
  Tails rest;
  std::copy(tails.first.begin() + k, tails.first.begin() + count, rest.first.begin());
  std::copy(tails.second.begin() + k, tails.second.begin() + count, rest.second.begin());
  putGroup(bits, place, kLow, rest, count - k, out);
}

}  // namespace

bool readParticles(const std::uint8_t* payload, std::uint32_t byte_count, std::uint32_t count, const CellGrid& grid,
                   std::uint8_t* out) {
  if (count > kParticleReadMaxCount || !isWithinBounds(grid) || byte_count > BitSource::kMaxBytes) return false;
  ResidualReader in(payload, byte_count);
  if (!CellReader(count, grid, out).read(in.bits())) return false;
  const BitSource offsets = in.bits();
  const std::uint32_t low = grid.offset_bits - 1;
  if (!in.bits().skip(std::uint64_t{count} * 3 * low)) return false;
  Attributes attributes;
  Tails tails;
  std::uint32_t place = offsets.place();
  for (std::size_t begin = 0; begin < count; begin += kGroupMaxCount) {
    const std::size_t group_count = std::min(kGroupMaxCount, count - begin);
    attributes.read(in, group_count, tails);
    if (grid.offset_bits == kUsualOffsetBits)
      putUsualGroup(offsets, place, tails, group_count, out + begin * kParticleWordBytes);
    else
      putGroup(offsets, place, low, tails, group_count, out + begin * kParticleWordBytes);
    place += std::uint32_t{kGroupMaxCount} * 3 * low;
  }
  return in.isAtEnd();
}

}  // namespace spindrift::codec
