// Particles as packed by the GPU become the keys and items that the coder sorts and writes.
#include <algorithm>

#include <spindrift/bitstream/encode/particle_cells.h>

#include "processor.h"

#if SPINDRIFT_HAS_VECTORS
#include <immintrin.h>
#endif

namespace spindrift::codec {
namespace {

struct Steps {
  float scale[3];
  std::int32_t last[3];
  std::int32_t cells_x, cells_y;
  std::int32_t speed;  ///< in 1 / 65536
  std::int32_t bits;
};

void quantize(const std::uint32_t* words, std::size_t count, const Steps& s, std::uint32_t* keys,
              std::uint64_t* items) {
  const std::int32_t low = s.bits - 1, mask = (1 << low) - 1;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t a = words[3 * i], b = words[3 * i + 1], c = words[3 * i + 2];
    const auto place = [&s](std::uint32_t word, int axis) {
      const auto at = static_cast<std::int32_t>(static_cast<float>(static_cast<std::int32_t>(word)) * s.scale[axis]);
      return at < s.last[axis] ? at : s.last[axis];
    };
    const std::int32_t x = place(a & 0xffffu, 0), y = place(b & 0xffffu, 1), z = place(a >> 16, 2);
    const std::int32_t cell = ((z >> s.bits) * s.cells_x + (x >> s.bits)) * s.cells_y + (y >> s.bits);
    keys[i] = static_cast<std::uint32_t>(cell << 3 | (x >> low & 1) << 2 | (z >> low & 1) << 1 | (y >> low & 1));
    const std::int32_t offsets = (x & mask) | (z & mask) << low | (y & mask) << (2 * low);
    const auto velocity = [&s](std::uint32_t word) {
      const std::int32_t speed = static_cast<std::int32_t>(word << 24) >> 24;
      return static_cast<std::uint32_t>((speed * s.speed + (1 << 15)) >> 16) & 0xffu;
    };
    const std::uint32_t foam = ((c >> 16 & 0xffu) * 3 + 128) * 257 >> 16;
    const std::uint32_t tint = ((c >> 8 & 0xffu) * 7 + 128) * 257 >> 16;
    const std::uint32_t attributes =
        velocity(b >> 16) | velocity(b >> 24) << 8 | velocity(c) << 16 | foam << 24 | tint << 26;
    items[i] = static_cast<std::uint32_t>(offsets) | std::uint64_t{attributes} << 32;
  }
}

#if SPINDRIFT_HAS_VECTORS
/// Extracts the words of one kind for eight particles from the 24 words of all kinds. `Kind`: index of the kind's first
/// word. The words of a kind are in different lanes of each of the three vectors.
template <int Kind>
SPINDRIFT_AVX2 __m256i wordsOf(__m256i v0, __m256i v1, __m256i v2) {
  constexpr int kEvery3[] = {0b01001001, 0b10010010, 0b00100100};  // lanes 0, 3, 6; 1, 4, 7; 2, 5
  constexpr int kSecond = kEvery3[(Kind + 1) % 3], kThird = kEvery3[(Kind + 2) % 3];
  const __m256i mixed = _mm256_blend_epi32(_mm256_blend_epi32(v0, v1, kSecond), v2, kThird);
  constexpr auto at = [](int particle) { return (3 * particle + Kind) % 8; };
  return _mm256_permutevar8x32_epi32(mixed, _mm256_setr_epi32(at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)));
}
/// Converts 16 bits to a number, times a scale, at most `last`.
SPINDRIFT_AVX2 __m256i placesOf(__m256i bits, float scale, std::int32_t last) {
  const __m256 scaled = _mm256_mul_ps(_mm256_cvtepi32_ps(bits), _mm256_set1_ps(scale));
  return _mm256_min_epi32(_mm256_cvttps_epi32(scaled), _mm256_set1_epi32(last));
}
/// Reads a signed byte in the highest bits.
SPINDRIFT_AVX2 __m256i velocitiesOf(__m256i words, __m256i speed) {
  const __m256i scaled = _mm256_mullo_epi32(_mm256_srai_epi32(words, 24), speed);
  const __m256i rounded = _mm256_srai_epi32(_mm256_add_epi32(scaled, _mm256_set1_epi32(1 << 15)), 16);
  return _mm256_and_si256(rounded, _mm256_set1_epi32(0xff));
}
/// Scales the byte at `Shift` to 0 .. factor. Products stay below 2^16 except the last one, whose high half is the
/// result.
template <int Shift>
SPINDRIFT_AVX2 __m256i levelsOf(__m256i words, int factor) {
  const __m256i byte = _mm256_and_si256(_mm256_srli_epi32(words, Shift), _mm256_set1_epi32(0xff));
  const __m256i scaled = _mm256_add_epi32(_mm256_mullo_epi16(byte, _mm256_set1_epi32(factor)), _mm256_set1_epi32(128));
  return _mm256_mulhi_epu16(scaled, _mm256_set1_epi32(257));
}

/// The same as the plain loop, eight particles at a time.
__attribute__((target("avx2"))) void quantizeEights(const std::uint32_t* words, std::size_t count, const Steps& s,
                                                    std::uint32_t* keys, std::uint64_t* items) {
  const __m256i low_16 = _mm256_set1_epi32(0xffff), one = _mm256_set1_epi32(1);
  const __m128i bits = _mm_cvtsi32_si128(s.bits), low = _mm_cvtsi32_si128(s.bits - 1),
                twice_low = _mm_cvtsi32_si128(2 * (s.bits - 1));
  const __m256i mask = _mm256_set1_epi32((1 << (s.bits - 1)) - 1), speed = _mm256_set1_epi32(s.speed);
  const __m256i cells_x = _mm256_set1_epi32(s.cells_x), cells_y = _mm256_set1_epi32(s.cells_y);
  std::size_t i = 0;
  for (; i + 8 <= count; i += 8) {
    const auto* from = reinterpret_cast<const __m256i*>(words + 3 * i);
    fetchAhead(from);
    fetchAhead(reinterpret_cast<const char*>(from) + 64);
    const __m256i v0 = _mm256_loadu_si256(from), v1 = _mm256_loadu_si256(from + 1), v2 = _mm256_loadu_si256(from + 2);
    const __m256i a = wordsOf<0>(v0, v1, v2), b = wordsOf<1>(v0, v1, v2), c = wordsOf<2>(v0, v1, v2);
    const __m256i x = placesOf(_mm256_and_si256(a, low_16), s.scale[0], s.last[0]);
    const __m256i y = placesOf(_mm256_and_si256(b, low_16), s.scale[1], s.last[1]);
    const __m256i z = placesOf(_mm256_srli_epi32(a, 16), s.scale[2], s.last[2]);

    const __m256i column =
        _mm256_add_epi32(_mm256_mullo_epi32(_mm256_sra_epi32(z, bits), cells_x), _mm256_sra_epi32(x, bits));
    const __m256i cell = _mm256_add_epi32(_mm256_mullo_epi32(column, cells_y), _mm256_sra_epi32(y, bits));
    const __m256i half_x = _mm256_and_si256(_mm256_sra_epi32(x, low), one);
    const __m256i half_y = _mm256_and_si256(_mm256_sra_epi32(y, low), one);
    const __m256i half_z = _mm256_and_si256(_mm256_sra_epi32(z, low), one);
    const __m256i eighth =
        _mm256_or_si256(_mm256_or_si256(_mm256_slli_epi32(half_x, 2), _mm256_slli_epi32(half_z, 1)), half_y);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(keys + i), _mm256_or_si256(_mm256_slli_epi32(cell, 3), eighth));

    const __m256i offsets =
        _mm256_or_si256(_mm256_or_si256(_mm256_and_si256(x, mask), _mm256_sll_epi32(_mm256_and_si256(z, mask), low)),
                        _mm256_sll_epi32(_mm256_and_si256(y, mask), twice_low));
    const __m256i velocity_x = velocitiesOf(_mm256_slli_epi32(b, 8), speed);
    const __m256i velocity_y = _mm256_slli_epi32(velocitiesOf(b, speed), 8);
    const __m256i velocity_z = _mm256_slli_epi32(velocitiesOf(_mm256_slli_epi32(c, 24), speed), 16);
    const __m256i foam = _mm256_slli_epi32(levelsOf<16>(c, 3), 24), tint = _mm256_slli_epi32(levelsOf<8>(c, 7), 26);
    const __m256i attributes = _mm256_or_si256(_mm256_or_si256(_mm256_or_si256(velocity_x, velocity_y), velocity_z),
                                               _mm256_or_si256(foam, tint));
    // Order of the lanes: particles 0, 1, 4, 5 and 2, 3, 6, 7.
    const __m256i first = _mm256_unpacklo_epi32(offsets, attributes),
                  second = _mm256_unpackhi_epi32(offsets, attributes);
    auto* to = reinterpret_cast<__m256i*>(items + i);
    _mm256_storeu_si256(to, _mm256_permute2x128_si256(first, second, 0x20));
    _mm256_storeu_si256(to + 1, _mm256_permute2x128_si256(first, second, 0x31));
  }
  quantize(words + 3 * i, count - i, s, keys + i, items + i);
}
#endif

}  // namespace

void quantizeParticles(std::span<const std::uint32_t> words, const ParticleScale& scale, const CellGrid& grid,
                       std::span<std::uint32_t> keys, std::span<std::uint64_t> items) {
  Steps steps{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    steps.scale[axis] = scale.place[axis];
    steps.last[axis] = static_cast<std::int32_t>((grid.cells_count[axis] << grid.offset_bits) - 1);
  }
  steps.cells_x = static_cast<std::int32_t>(grid.cells_count[0]);
  steps.cells_y = static_cast<std::int32_t>(grid.cells_count[1]);
  steps.speed = static_cast<std::int32_t>(std::clamp(scale.speed, 0.0f, 1.0f) * 65536.0f);
  steps.bits = static_cast<std::int32_t>(grid.offset_bits);
#if SPINDRIFT_HAS_VECTORS
  if (usesVectors()) return quantizeEights(words.data(), keys.size(), steps, keys.data(), items.data());
#endif
  quantize(words.data(), keys.size(), steps, keys.data(), items.data());
}

}  // namespace spindrift::codec
