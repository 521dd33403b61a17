#include "prefix_code.h"

#include <algorithm>
#include <cassert>

namespace spindrift::codec {
namespace {

/// Computes lengths for the counts, of which at least two are above 0, with Huffman's algorithm and two queues instead
/// of a heap. Lengths above the limit are cut; the longest codes below the limit are lengthened to pay for it.
void fitLengths(std::span<const std::uint32_t> counts, std::span<std::uint8_t> lengths) {
  assert(counts.size() <= kMaxSymbolCount && lengths.size() == counts.size());
  std::array<std::uint64_t, kMaxSymbolCount> order;  // count << 8 | symbol, ascending
  std::size_t n = 0;
  for (std::size_t symbol = 0; symbol < counts.size(); ++symbol) {
    lengths[symbol] = 0;
    if (counts[symbol] > 0) order[n++] = std::uint64_t{counts[symbol]} << 8 | symbol;
  }
  assert(n >= 2);
  std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(n));
  // Nodes 0..n-1 are the symbols, the others follow in order of creation.
  std::array<std::uint64_t, 2 * kMaxSymbolCount> weight;
  std::array<std::size_t, 2 * kMaxSymbolCount> parent;
  for (std::size_t i = 0; i < n; ++i) weight[i] = order[i] >> 8;
  std::size_t leaf = 0, inner = n;
  for (std::size_t made = n; made < 2 * n - 1; ++made) {
    weight[made] = 0;
    for (int child = 0; child < 2; ++child) {
      const bool takes_leaf = leaf < n && (inner == made || weight[leaf] <= weight[inner]);
      const std::size_t taken = takes_leaf ? leaf++ : inner++;
      weight[made] += weight[taken];
      parent[taken] = made;
    }
  }
  std::array<std::uint32_t, 2 * kMaxSymbolCount> depth;
  depth[2 * n - 2] = 0;
  for (std::size_t i = 2 * n - 2; i-- > 0;) depth[i] = depth[parent[i]] + 1;
  // Code space in use, in units of 2^-11. Symbols are in ascending order of counts, so in descending order of lengths.
  std::uint32_t used = 0;
  for (std::size_t i = 0; i < n; ++i) {
    depth[i] = std::min(depth[i], kMaxCodeBits);
    used += 1u << (kMaxCodeBits - depth[i]);
  }
  for (std::size_t i = 0; used > 1u << kMaxCodeBits; i = (i + 1) % n) {
    if (depth[i] == kMaxCodeBits) continue;
    ++depth[i];
    used -= 1u << (kMaxCodeBits - depth[i]);
  }
  for (std::size_t i = n; i-- > 0;) {
    while (depth[i] > 1 && used + (1u << (kMaxCodeBits - depth[i])) <= 1u << kMaxCodeBits) {
      used += 1u << (kMaxCodeBits - depth[i]);
      --depth[i];
    }
  }
  for (std::size_t i = 0; i < n; ++i) lengths[order[i] & 0xffu] = static_cast<std::uint8_t>(depth[i]);
}

}  // namespace

PrefixWriter::PrefixWriter(std::span<const std::uint8_t> lengths) {
  assert(lengths.size() <= kMaxSymbolCount);
  [[maybe_unused]] const bool is_complete = forEachCode(
      lengths,
      [&](std::size_t symbol, std::uint32_t code, std::uint32_t length) { words_[symbol] = code | length << 16; });
  assert(is_complete);
}

PrefixWriter putFittedCode(std::span<const std::uint32_t> counts, BitWriter& out) {
  std::array<std::uint32_t, kMaxSymbolCount> wanted{};
  std::ranges::copy(counts, wanted.begin());
  wanted[0] = std::max(wanted[0], 1u);
  wanted[1] = std::max(wanted[1], 1u);
  std::array<std::uint8_t, kMaxSymbolCount> all_lengths;
  const std::span lengths = std::span(all_lengths).first(counts.size());
  fitLengths(std::span(wanted).first(counts.size()), lengths);
  BitCursor cursor = out.begin(counts.size());
  for (std::size_t symbol = 0; symbol < counts.size(); ++symbol) {
    if (symbol >= 2) cursor.put(lengths[symbol] > 0 ? 1 : 0, 1);
    if (lengths[symbol] > 0) cursor.put(lengths[symbol], kLengthBits);
    cursor.flush();
  }
  out.end(cursor);
  return PrefixWriter(lengths);
}

}  // namespace spindrift::codec
