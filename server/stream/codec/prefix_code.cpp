#include "prefix_code.h"

#include <algorithm>
#include <cassert>
#include <vector>

namespace spindrift::stream {
namespace {

constexpr std::uint32_t kLengthBits = 4;

/// Calls use(symbol, code, length) for each symbol of a code, the code with its highest bit lowest. False: the lengths
/// belong to no complete code.
template <typename Use>
bool forEachCode(std::span<const std::uint8_t> lengths, Use use) {
  std::array<std::uint32_t, kMaxCodeBits + 1> count_of{};
  for (const std::uint8_t length : lengths) {
    if (length > kMaxCodeBits) return false;
    ++count_of[length];
  }
  std::array<std::uint32_t, kMaxCodeBits + 1> next{};
  std::uint32_t code = 0;
  count_of[0] = 0;
  for (std::uint32_t length = 1; length <= kMaxCodeBits; ++length) {
    code = (code + count_of[length - 1]) << 1;
    next[length] = code;
  }
  if (code + count_of[kMaxCodeBits] != 1u << kMaxCodeBits) return false;
  for (std::size_t symbol = 0; symbol < lengths.size(); ++symbol) {
    const std::uint32_t length = lengths[symbol];
    if (length == 0) continue;
    std::uint32_t reversed = 0;
    for (std::uint32_t bit = 0, c = next[length]++; bit < length; ++bit, c >>= 1) reversed = reversed << 1 | (c & 1u);
    use(symbol, reversed, length);
  }
  return true;
}

}  // namespace

PrefixWriter::PrefixWriter(std::span<const std::uint8_t> lengths) {
  assert(lengths.size() <= kMaxSymbolCount);
  [[maybe_unused]] const bool is_complete = forEachCode(
      lengths,
      [&](std::size_t symbol, std::uint32_t code, std::uint32_t length) { words_[symbol] = code | length << 16; });
  assert(is_complete);
}

std::optional<PrefixReader> PrefixReader::create(std::span<const std::uint8_t> lengths) {
  PrefixReader reader;
  const bool is_complete = forEachCode(lengths, [&](std::size_t symbol, std::uint32_t code, std::uint32_t length) {
    for (std::uint32_t slot = code; slot < reader.slots_.size(); slot += 1u << length)
      reader.slots_[slot] = static_cast<std::uint16_t>(symbol | length << 8);
  });
  if (!is_complete) return std::nullopt;
  return reader;
}

// Huffman's code, two queues instead of a heap; lengths above the limit are cut, and what that costs in code space is
// taken from the longest codes below it.
void fitLengths(std::span<const std::uint32_t> counts, std::span<std::uint8_t> lengths) {
  assert(counts.size() <= kMaxSymbolCount && lengths.size() == counts.size());
  std::array<std::uint64_t, kMaxSymbolCount> order;  // count << 8 | symbol, rising
  std::size_t n = 0;
  for (std::size_t symbol = 0; symbol < counts.size(); ++symbol) {
    lengths[symbol] = 0;
    if (counts[symbol] > 0) order[n++] = std::uint64_t{counts[symbol]} << 8 | symbol;
  }
  assert(n >= 2);
  std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(n));
  // Nodes 0..n-1 are the symbols, the others in the order of their making.
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
  // Parts of 2^11 that the codes take up; the symbols are in rising order of counts, so in falling one of lengths.
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

std::optional<PrefixReader> getFittedCode(std::size_t symbol_count, BitReader& in) {
  std::vector<std::uint8_t> lengths(symbol_count);
  for (std::size_t symbol = 0; symbol < symbol_count; ++symbol) {
    if (symbol < 2 || in.get(1) != 0) lengths[symbol] = static_cast<std::uint8_t>(in.get(kLengthBits));
  }
  return PrefixReader::create(lengths);
}

}  // namespace spindrift::stream
