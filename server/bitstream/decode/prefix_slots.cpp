#include "prefix_slots.h"

namespace spindrift::codec {

bool PrefixSlots::assign(std::span<const std::uint8_t> lengths) {
  return forEachCode(lengths, [this](std::size_t symbol, std::uint32_t code, std::uint32_t length) {
    for (std::size_t slot = code; slot < slots_.size(); slot += std::size_t{1} << length)
      slots_[slot] = {static_cast<std::uint8_t>(symbol), static_cast<std::uint8_t>(length)};
  });
}

bool PrefixSlots::read(std::size_t symbol_count, BitSource& in) {
  static_assert(kMaxSymbolCount * (1 + kLengthBits) <= BitSource::kRunMaxBits);
  in.prepare();
  std::array<std::uint8_t, kMaxSymbolCount> lengths{};
  for (std::size_t symbol = 0; symbol < symbol_count; ++symbol) {
    if (symbol < 2 || in.get(1) != 0) lengths[symbol] = static_cast<std::uint8_t>(in.get(kLengthBits));
  }
  return assign(std::span(lengths).first(symbol_count));
}

}  // namespace spindrift::codec
