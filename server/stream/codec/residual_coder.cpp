#include "residual_coder.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdlib>
#include <vector>

namespace spindrift::stream {
namespace {

constexpr int kRawResidualBits = 16;
constexpr std::uint32_t kFirstShiftedClass = 18;

/// Of a class with its own table: 2^32 times the weight of 1 over that of 0, and the largest value in the table.
struct Normal {
  std::uint32_t weight_ratio;
  int largest;
};
constexpr Normal kNormals[] = {{33048663, 4},    {47037629, 4},   {67129970, 4},   {96180043, 4},   {138583811, 4},
                               {201340740, 4},   {296102537, 4},  {443370733, 4},  {681172609, 4},  {1077842265, 4},
                               {1704127699, 4},  {2475875289, 4}, {3169595364, 6}, {3659567669, 8}, {3955829142, 12},
                               {4119551104, 16}, {4205730481, 24}};
constexpr std::size_t kNormalCount = std::size(kNormals);

/// weights[k] / 2^32 = ratio^(k^2), or ratio^(k^2 + k) half-way between whole numbers.
std::vector<std::uint64_t> weightsOf(const Normal& normal, bool is_halfway) {
  const std::uint64_t ratio = normal.weight_ratio;
  const std::uint64_t squared = ratio * ratio >> 32;
  std::vector<std::uint64_t> weights = {std::uint64_t{1} << 32};
  for (std::uint64_t step = is_halfway ? squared : ratio; weights.size() <= static_cast<std::size_t>(normal.largest);
       step = step * squared >> 32)
    weights.push_back(weights.back() * step >> 32);
  return weights;
}

/// Values -largest..largest (half-way: one more below), then the escape.
SymbolTable tableOf(const Normal& normal, bool is_halfway) {
  const std::vector<std::uint64_t> weights = weightsOf(normal, is_halfway);
  std::vector<std::uint64_t> by_symbol;
  for (int k = normal.largest; k >= (is_halfway ? 0 : 1); --k)
    by_symbol.push_back(weights[static_cast<std::size_t>(k)]);
  by_symbol.insert(by_symbol.end(), weights.begin(), weights.end());
  std::uint64_t sum = 0;
  for (const std::uint64_t weight : by_symbol) sum += weight;
  std::vector<std::uint32_t> frequencies;
  std::uint32_t used = 0;
  for (const std::uint64_t weight : by_symbol) {
    frequencies.push_back(std::max(static_cast<std::uint32_t>((weight * (2 * kSlotCount) + sum) / (2 * sum)), 1u));
    used += frequencies.back();
  }
  frequencies.push_back(1);
  // What rounding left over or took too much goes to the most frequent value.
  frequencies[static_cast<std::size_t>(normal.largest) + (is_halfway ? 1 : 0)] += kSlotCount - used - 1;
  return SymbolTable(frequencies);
}

/// How the residuals of a class are coded.
struct ClassCode {
  const SymbolTable* table;
  int shift;   ///< low bits that stand raw
  int offset;  ///< symbol = (residual >> shift) + offset
  std::size_t escape;
};

class ClassCodes {
 public:
  ClassCodes() {
    tables_.reserve(kNormalCount + 2);
    for (const Normal& normal : kNormals) tables_.push_back(tableOf(normal, false));
    for (const std::size_t k : {kNormalCount - 2, kNormalCount - 1}) tables_.push_back(tableOf(kNormals[k], true));
    codes_.push_back({});
    for (std::size_t k = 0; k < kNormalCount; ++k) {
      const int largest = kNormals[k].largest;
      codes_.push_back({&tables_[k], 0, largest, static_cast<std::size_t>(2 * largest + 1)});
    }
    for (std::uint32_t c = kFirstShiftedClass; c < kResidualClassCount; ++c) {
      const std::size_t k = kNormalCount - 2 + c % 2;
      const int largest = kNormals[k].largest;
      codes_.push_back(
          {&tables_[k + 2], static_cast<int>(c - 16) / 2, largest + 1, static_cast<std::size_t>(2 * largest + 2)});
    }
  }
  const ClassCode& operator[](std::uint32_t group_class) const { return codes_[group_class]; }

 private:
  std::vector<SymbolTable> tables_;
  std::vector<ClassCode> codes_;
};

const ClassCodes& classCodes() {
  static const ClassCodes codes;
  return codes;
}

/// A group's class is coded as its difference from the expected one, with the table of a class.
struct ClassExpectation {
  int expected;
  std::uint32_t coded_as;
};
ClassExpectation expectClass(std::uint32_t left, std::uint32_t above) {
  if (left == 0 && above == 0) return {0, 7};
  if (left == 0 || above == 0) return {static_cast<int>(left + above) / 2, 16};
  return {static_cast<int>(left + above + 1) / 2, 13};
}

/// The class whose mean magnitude is nearest to sum / count.
std::uint32_t classOf(std::uint32_t sum, std::size_t count) {
  if (sum == 0) return 0;
  const std::uint64_t scaled = std::uint64_t{sum} * 1024 * kGroupMaxCount / count;  // 1024 * 64 * mean
  const int bits = static_cast<int>(std::bit_width(scaled)) - 1;
  const double mantissa = static_cast<double>(scaled) / static_cast<double>(std::uint64_t{1} << bits);
  const int doubled_log2 = 2 * bits + (mantissa > 1.189 ? 1 : 0) + (mantissa > 1.682 ? 1 : 0) - 2 * 16;
  return static_cast<std::uint32_t>(std::clamp(doubled_log2 + 13, 1, static_cast<int>(kResidualClassCount) - 1));
}

}  // namespace

std::uint32_t ResidualEncoder::putGroup(std::span<const std::int16_t> residuals, std::uint32_t left,
                                        std::uint32_t above) {
  assert(!residuals.empty() && residuals.size() <= kGroupMaxCount);
  std::uint32_t sum = 0;
  for (const std::int16_t r : residuals) sum += static_cast<std::uint32_t>(std::abs(static_cast<int>(r)));
  const std::uint32_t group_class = classOf(sum, residuals.size());
  putClass(group_class, left, above);
  if (group_class == 0) return 0;
  const ClassCode& code = classCodes()[group_class];
  std::uint32_t lane = 0;
  for (const std::int16_t r : residuals) {
    const auto symbol = static_cast<std::size_t>((r >> code.shift) + code.offset);
    if (symbol < code.escape) {
      coder_.put(*code.table, symbol, lane);
      if (code.shift > 0) raw_.put(static_cast<std::uint32_t>(r) & ((1u << code.shift) - 1), code.shift);
    } else {
      coder_.put(*code.table, code.escape, lane);
      raw_.put(static_cast<std::uint16_t>(r), kRawResidualBits);
    }
    lane = (lane + 1) % kLaneCount;
  }
  return group_class;
}

void ResidualEncoder::putClass(std::uint32_t group_class, std::uint32_t left, std::uint32_t above) {
  const ClassExpectation expectation = expectClass(left, above);
  const ClassCode& code = classCodes()[expectation.coded_as];
  const auto symbol = static_cast<std::size_t>(static_cast<int>(group_class) - expectation.expected + code.offset);
  if (symbol < code.escape) {
    coder_.put(*code.table, symbol, 0);
  } else {
    coder_.put(*code.table, code.escape, 0);
    raw_.put(group_class, 6);
  }
}

void ResidualEncoder::finish(core::Bytes& out) {
  const std::size_t length_at = out.size();
  out.resize(length_at + 4);
  coder_.finish(out);
  const std::size_t coded_bytes = out.size() - length_at - 4;
  for (std::size_t i = 0; i < 4; ++i) out[length_at + i] = static_cast<std::uint8_t>(coded_bytes >> (8 * i));
  const core::Bytes raw = raw_.take();
  out.insert(out.end(), raw.begin(), raw.end());
}

ResidualDecoder::ResidualDecoder(core::ByteView bytes) : ResidualDecoder(split(bytes)) {}

ResidualDecoder::Parts ResidualDecoder::split(core::ByteView bytes) {
  if (bytes.size() < 4) return {};
  std::size_t coded_bytes = 0;
  for (std::size_t i = 0; i < 4; ++i) coded_bytes |= std::size_t{bytes[i]} << (8 * i);
  if (coded_bytes > bytes.size() - 4) return {};
  return {bytes.subspan(4, coded_bytes), bytes.subspan(4 + coded_bytes)};
}

std::uint32_t ResidualDecoder::getGroup(std::span<std::int16_t> residuals, std::uint32_t left, std::uint32_t above) {
  const std::uint32_t group_class = getClass(left, above);
  if (group_class == 0) {
    std::ranges::fill(residuals, std::int16_t{0});
    return 0;
  }
  const ClassCode& code = classCodes()[group_class];
  std::uint32_t lane = 0;
  for (std::int16_t& r : residuals) {
    const std::uint32_t symbol = coder_.get(*code.table, lane);
    if (symbol < code.escape) {
      const auto high = static_cast<std::uint32_t>(static_cast<int>(symbol) - code.offset) << code.shift;
      r = static_cast<std::int16_t>(code.shift > 0 ? high | raw_.get(code.shift) : high);
    } else {
      r = static_cast<std::int16_t>(raw_.get(kRawResidualBits));
    }
    lane = (lane + 1) % kLaneCount;
  }
  return group_class;
}

std::uint32_t ResidualDecoder::getClass(std::uint32_t left, std::uint32_t above) {
  const ClassExpectation expectation = expectClass(left, above);
  const ClassCode& code = classCodes()[expectation.coded_as];
  const std::uint32_t symbol = coder_.get(*code.table, 0);
  if (symbol >= code.escape) return std::min(raw_.get(6), kResidualClassCount - 1);
  const int group_class = static_cast<int>(symbol) - code.offset + expectation.expected;
  return static_cast<std::uint32_t>(std::clamp(group_class, 0, static_cast<int>(kResidualClassCount) - 1));
}

}  // namespace spindrift::stream
