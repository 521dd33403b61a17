#include "particle_quanta.h"

#include <algorithm>

namespace spindrift::stream {
namespace {

struct Steps {
  float scale[3];
  std::int32_t last[3];
  std::int32_t cells_x, cells_y;
  std::int32_t speed;  ///< in 1 / 65536
  std::int32_t bits;
};

/// Plain arithmetic without branches, which compilers turn into vectors.
__attribute__((always_inline)) inline void quantize(const std::uint32_t* __restrict words, std::size_t count,
                                                    const Steps& steps, std::uint32_t* __restrict keys,
                                                    std::uint64_t* __restrict items) {
  const Steps s = steps;
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

#if defined(__x86_64__)
__attribute__((target("avx2"))) void quantizeWithAvx2(const std::uint32_t* words, std::size_t count, const Steps& steps,
                                                      std::uint32_t* keys, std::uint64_t* items) {
  quantize(words, count, steps, keys, items);
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
#if defined(__x86_64__)
  static const bool kHasAvx2 = __builtin_cpu_supports("avx2") != 0;
  if (kHasAvx2) return quantizeWithAvx2(words.data(), keys.size(), steps, keys.data(), items.data());
#endif
  quantize(words.data(), keys.size(), steps, keys.data(), items.data());
}

}  // namespace spindrift::stream
