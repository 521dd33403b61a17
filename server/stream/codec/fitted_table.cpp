#include "fitted_table.h"

#include <algorithm>
#include <cmath>

namespace spindrift::stream {
namespace {

/// 0: the symbol is not there. 1..31: it counts 2^((level - 1) / 2), in units of 1/256 and rounded down.
constexpr int kLevelBits = 5;
constexpr std::uint32_t kMaxLevel = (1u << kLevelBits) - 1;
constexpr std::uint32_t kRootTwo256 = 362;  // 256 sqrt 2

std::uint64_t weightOf(std::uint32_t level) {
  return (std::uint64_t{level % 2 != 0 ? 256u : kRootTwo256}) << ((level - 1) / 2);
}

SymbolTable tableOf(std::span<const std::uint32_t> levels) {
  std::uint64_t sum = 0;
  for (const std::uint32_t level : levels) sum += level > 0 ? weightOf(level) : 0;
  // At most 256 symbols get a slot each; the rest is shared out by weight, and what rounding leaves goes to the first
  // of the heaviest.
  const std::uint32_t shared = kSlotCount - 256;
  std::vector<std::uint32_t> frequencies;
  std::uint32_t used = 0;
  for (const std::uint32_t level : levels) {
    frequencies.push_back(level > 0 ? 1 + static_cast<std::uint32_t>(weightOf(level) * shared / sum) : 0);
    used += frequencies.back();
  }
  *std::ranges::max_element(frequencies) += kSlotCount - used;
  return SymbolTable(frequencies);
}

}  // namespace

SymbolTable putFittedTable(std::span<const std::uint32_t> counts, ResidualEncoder& out) {
  const double most = *std::ranges::max_element(counts);
  std::vector<std::uint32_t> levels;
  for (std::size_t symbol = 0; symbol < counts.size(); ++symbol) {
    const double level = counts[symbol] > 0 ? kMaxLevel + std::round(2 * std::log2(counts[symbol] / most)) : 0;
    levels.push_back(counts[symbol] > 0 || symbol < 2 ? static_cast<std::uint32_t>(std::max(level, 1.0)) : 0);
    if (symbol >= 2) out.putRaw(levels.back() > 0 ? 1 : 0, 1);
    if (levels.back() > 0) out.putRaw(levels.back(), kLevelBits);
  }
  return tableOf(levels);
}

SymbolTable getFittedTable(std::size_t symbol_count, ResidualDecoder& in) {
  std::vector<std::uint32_t> levels;
  for (std::size_t symbol = 0; symbol < symbol_count; ++symbol) {
    const bool is_there = symbol < 2 || in.getRaw(1) != 0;
    levels.push_back(is_there ? std::max(in.getRaw(kLevelBits), 1u) : 0);
  }
  return tableOf(levels);
}

}  // namespace spindrift::stream
