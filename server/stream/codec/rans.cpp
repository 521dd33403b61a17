#include "rans.h"

#include <algorithm>
#include <cassert>

namespace spindrift::stream {
namespace {

void appendWord(core::Bytes& out, std::uint32_t word) {
  out.push_back(static_cast<std::uint8_t>(word));
  out.push_back(static_cast<std::uint8_t>(word >> 8));
}

/// ceil(2^44 / f): x / f = x * it >> 44 for every x < 2^20 f. The product stays below 2^64 and what rounding up adds to
/// it below 2^44, as f^2 < 2^24.
struct Reciprocals {
  std::array<std::uint64_t, kSlotCount> of{};
  constexpr Reciprocals() {
    for (std::uint64_t f = 1; f < kSlotCount; ++f) of[f] = ((std::uint64_t{1} << 44) + f - 1) / f;
  }
};
constexpr Reciprocals kReciprocals;

}  // namespace

SymbolTable::SymbolTable(std::span<const std::uint32_t> frequencies) : slots_{} {
  assert(frequencies.size() <= 256);
  std::uint32_t start = 0;
  for (std::size_t symbol = 0; symbol < frequencies.size(); ++symbol) {
    const std::uint32_t frequency = frequencies[symbol];
    assert(frequency < kSlotCount && start + frequency <= kSlotCount);
    ranges_.push_back({start, frequency});
    for (std::uint32_t k = 0; k < frequency; ++k)
      slots_[start + k] = static_cast<std::uint32_t>(symbol) | frequency << 8 | k << 20;
    start += frequency;
  }
  assert(start == kSlotCount);
}

void RansEncoder::finish(core::Bytes& out) {
  words_.clear();
  std::array<std::uint32_t, kLaneCount> states;
  states.fill(RansDecoder::kLow);
  for (std::size_t i = symbols_.size(); i-- > 0;) {
    const std::uint32_t symbol = symbols_[i];
    const std::uint32_t frequency = symbol & (kSlotCount - 1);
    const std::uint32_t start = symbol >> 12 & (kSlotCount - 1);
    std::uint32_t& x = states[symbol >> 24];
    if (x >= std::uint64_t{frequency} << 20) {
      words_.push_back(static_cast<std::uint16_t>(x));
      x >>= 16;
    }
    const auto quotient = static_cast<std::uint32_t>(kReciprocals.of[frequency] * x >> 44);
    x = quotient * kSlotCount + (x - quotient * frequency) + start;
  }
  out.reserve(out.size() + 8 + 2 * words_.size());
  for (const std::uint32_t x : states) {
    appendWord(out, x);
    appendWord(out, x >> 16);
  }
  for (std::size_t i = words_.size(); i-- > 0;) appendWord(out, words_[i]);
  symbols_.clear();
}

RansDecoder::RansDecoder(core::ByteView stream) : stream_(stream) {
  for (std::uint32_t& x : states_) {
    x = nextWord();
    x |= nextWord() << 16;
  }
}

bool RansDecoder::isAtEnd() const {
  return at_ == stream_.size() && std::ranges::all_of(states_, [](std::uint32_t x) { return x == kLow; });
}

std::uint32_t RansDecoder::nextWord() {
  const std::size_t at = at_;
  at_ += 2;
  return at_ <= stream_.size() ? stream_[at] | std::uint32_t{stream_[at + 1]} << 8 : 0;
}

}  // namespace spindrift::stream
