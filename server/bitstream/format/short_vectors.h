// Vectors of 128 bits for both compilers and both targets (SSE2, WebAssembly): the compilers' own vector types, and the
// operations that they lack.
#pragma once

#include <cstdint>
#include <cstring>

#if defined(__wasm_simd128__)
#include <wasm_simd128.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace spindrift::codec {

using Shorts = std::int16_t __attribute__((vector_size(16)));
using Words = std::uint32_t __attribute__((vector_size(16)));
using SignedWords = std::int32_t __attribute__((vector_size(16)));

/// Load from and store to any address, without alignment.
template <typename Vector, typename Element>
Vector loadVector(const Element* from) {
  Vector out;
  std::memcpy(&out, from, sizeof out);
  return out;
}
template <typename Vector, typename Element>
void storeVector(Element* to, Vector vector) {
  std::memcpy(to, &vector, sizeof vector);
}

/// Writes the same number 64 times with plain stores: if the compiler knew the number, it would emit memory.fill or rep
/// stos, which are slow for so few bytes.
inline void fill64(std::int16_t* to, std::int16_t value) {
  asm("" : "+r"(value));
  const Shorts v{value, value, value, value, value, value, value, value};
  storeVector(to, v);
  storeVector(to + 8, v);
  storeVector(to + 16, v);
  storeVector(to + 24, v);
  storeVector(to + 32, v);
  storeVector(to + 40, v);
  storeVector(to + 48, v);
  storeVector(to + 56, v);
}

/// Returns a[0], b[0], a[1], b[1], ... of the lower or the upper halves.
inline Shorts interleaveLow(Shorts a, Shorts b) {
  return __builtin_shufflevector(a, b, 0, 8, 1, 9, 2, 10, 3, 11);
}
inline Shorts interleaveHigh(Shorts a, Shorts b) {
  return __builtin_shufflevector(a, b, 4, 12, 5, 13, 6, 14, 7, 15);
}
inline Words interleaveLow(Words a, Words b) {
  return __builtin_shufflevector(a, b, 0, 4, 1, 5);
}
inline Words interleaveHigh(Words a, Words b) {
  return __builtin_shufflevector(a, b, 2, 6, 3, 7);
}

/// Returns a[0] b[0] + a[1] b[1], a[2] b[2] + a[3] b[3], ...; wraps around at 32 bits.
inline Words sumsOfProducts(Shorts a, Shorts b) {
#if defined(__wasm_simd128__)
  return Words(wasm_i32x4_dot_i16x8(v128_t(a), v128_t(b)));
#elif defined(__SSE2__)
  return Words(_mm_madd_epi16(__m128i(a), __m128i(b)));
#else
  const auto low = [](Shorts v) { return Words(SignedWords(Words(v) << 16) >> 16); };
  const auto high = [](Shorts v) { return Words(SignedWords(v) >> 16); };
  return low(a) * low(b) + high(a) * high(b);
#endif
}

/// Returns the low halves of both, a before b; each value must be a sign-extended 16-bit number.
inline Shorts narrowed(SignedWords a, SignedWords b) {
#if defined(__wasm_simd128__)
  return Shorts(wasm_i16x8_narrow_i32x4(v128_t(a), v128_t(b)));
#elif defined(__SSE2__)
  return Shorts(_mm_packs_epi32(__m128i(a), __m128i(b)));
#else
  return __builtin_shufflevector(Shorts(a), Shorts(b), 0, 2, 4, 6, 8, 10, 12, 14);
#endif
}

/// Returns the magnitudes; that of -32768 counts as 32767.
inline Shorts magnitudesOf(Shorts v) {
#if defined(__SSE2__)
  return Shorts(_mm_max_epi16(__m128i(v), _mm_subs_epi16(_mm_setzero_si128(), __m128i(v))));
#else
  const Shorts below_zero = Shorts(v < Shorts{});
  return (v ^ below_zero) + (below_zero & Shorts(v > Shorts{} - 32767 - 1) & 1);
#endif
}

/// Bit k of 16: number k is negative; those of b follow those of a.
inline std::uint32_t signBitsOf(Shorts a, Shorts b) {
#if defined(__SSE2__)
  return static_cast<std::uint32_t>(_mm_movemask_epi8(_mm_packs_epi16(__m128i(a), __m128i(b))));
#else
  std::uint32_t bits = 0;
  for (int k = 0; k < 8; ++k) bits |= (a[k] < 0 ? 1u : 0u) << k | (b[k] < 0 ? 1u : 0u) << (k + 8);
  return bits;
#endif
}

}  // namespace spindrift::codec
