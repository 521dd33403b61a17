#include <algorithm>
#include <bit>
#include <cmath>

#include <spindrift/bitstream/encode/floater_chain.h>

#include "group_writer.h"

namespace spindrift::codec {
namespace {

constexpr std::size_t kWordsPerFloater = 7;
constexpr double kPlainQuantum_m = 0.001;
/// A part stays the one that is not sent while it is at least so large; the largest is at least 1/2.
constexpr double kDerivedMin = 0.45;

bool fits(std::int64_t value) {
  return value >= INT16_MIN && value <= INT16_MAX;
}

/// Writes one number for each of `count` objects, in groups.
template <typename ValueOf>
void putColumn(ResidualEncoder& residuals, std::uint32_t count, const ValueOf& valueOf) {
  GroupWriter out = residuals.begin((count + kGroupMaxCount - 1) / kGroupMaxCount);
  std::uint32_t group_class = 0;
  for (std::uint32_t begin = 0; begin < count; begin += kGroupMaxCount) {
    const std::uint32_t n = std::min<std::uint32_t>(kGroupMaxCount, count - begin);
    ResidualGroup group;
    for (std::uint32_t i = 0; i < n; ++i) group.of[i] = static_cast<std::int16_t>(valueOf(begin + i));
    group_class = out.putGroup(GroupRows(group.of.data()), n, group_class, group_class);
  }
  residuals.end(out);
}

/// Writes the objects at these indices as ones that the frame before does not have.
void putNew(ResidualEncoder& residuals, const FloaterList& list, std::span<const std::uint16_t> at) {
  const auto record = [&](std::uint32_t i) -> const FloaterRecord& { return list.records[at[i]]; };
  const auto column = [&](const auto& valueOf) {
    putColumn(residuals, static_cast<std::uint32_t>(at.size()), valueOf);
  };
  const auto low = [](std::int32_t value) { return std::int32_t{static_cast<std::int16_t>(value)}; };
  const auto high = [&](std::int32_t value) {
    return static_cast<std::int32_t>((std::int64_t{value} - low(value)) >> 16);
  };
  const auto idStep = [&](std::uint32_t i) {
    return static_cast<std::int32_t>(record(i).id - (i > 0 ? record(i - 1).id : 0) - 1);
  };
  column([&](std::uint32_t i) { return low(idStep(i)); });
  column([&](std::uint32_t i) { return high(idStep(i)); });
  column([&](std::uint32_t i) { return record(i).size_cm - (i > 0 ? record(i - 1).size_cm : 0); });
  column([&](std::uint32_t i) { return record(i).kind - (i > 0 ? record(i - 1).kind : 0); });
  column([&](std::uint32_t i) { return record(i).flags; });
  for (std::size_t axis = 0; axis < 3; ++axis) {
    column([&](std::uint32_t i) { return low(record(i).place[axis]); });
    column([&](std::uint32_t i) { return high(record(i).place[axis]); });
  }
  column([&](std::uint32_t i) { return list.motions[at[i]].derived; });
  for (std::uint32_t k = 0; k < 3; ++k)
    column([&](std::uint32_t i) { return record(i).turn[sentPart(k, list.motions[at[i]].derived)]; });
}

/// Returns a unit quaternion, or no rotation for one without a length.
std::array<double, 4> unitTurn(const FloaterRecord& plain) {
  double square = 0.0;
  for (const std::int16_t part : plain.turn) square += static_cast<double>(part) * part;
  if (square < 1.0) return {0, 0, 0, 1};
  std::array<double, 4> out;
  std::ranges::transform(plain.turn, out.begin(), [&](std::int16_t part) { return part / std::sqrt(square); });
  return out;
}

/// Quantizes a rotation. `derived`: of the same object in the frame before.
void setTurn(const std::array<double, 4>& turn, std::uint8_t derived, std::uint32_t rotation_bits,
             FloaterRecord& record, FloaterMotion& motion) {
  const auto size = [&](std::size_t part) { return std::abs(turn[part]); };
  if (size(derived) < kDerivedMin) {
    derived = 0;
    for (std::uint8_t part = 1; part < 4; ++part) derived = size(part) > size(derived) ? part : derived;
  }
  const double unit = std::copysign(1 << rotation_bits, turn[derived]);
  for (std::uint32_t k = 0; k < 3; ++k) {
    const std::uint32_t part = sentPart(k, derived);
    record.turn[part] = static_cast<std::int16_t>(std::lround(unit * turn[part]));
  }
  record.turn[derived] = static_cast<std::int16_t>(derivedPart(record.turn, derived, rotation_bits));
  motion.derived = derived;
}

}  // namespace

FloaterChainEncoder::Forms FloaterChainEncoder::encode(std::span<const std::uint32_t> words, const FloaterScale& scale,
                                                       bool wants_keyframe) {
  FloaterList& before = lists_[newest_];
  FloaterList& next = lists_[1 - newest_];
  if (!has_list_) before.count = 0;
  next.count = static_cast<std::uint32_t>(std::min<std::size_t>(words.size() / kWordsPerFloater, kFloaterMaxCount));
  const double quanta = kPlainQuantum_m / scale.quantum_m;
  for (std::uint32_t i = 0; i < next.count; ++i) {
    std::array<std::uint32_t, kWordsPerFloater> plain;
    std::ranges::copy(words.subspan(i * kWordsPerFloater, kWordsPerFloater), plain.begin());
    FloaterRecord& record = next.records[i] = std::bit_cast<FloaterRecord>(plain);
    for (std::int32_t& place : record.place) {
      const double limit = kFloaterMaxPlace;
      place = static_cast<std::int32_t>(std::lround(std::clamp(place * quanta, -limit, limit)));
    }
  }
  match(next);
  for (std::uint32_t i = 0; i < next.count; ++i) {
    FloaterRecord& record = next.records[i];
    FloaterMotion& motion = next.motions[i] = {};
    const std::uint16_t from = from_[i];
    const std::array<double, 4> turn = unitTurn(record);
    setTurn(turn, from == kNew ? 3 : before.motions[from].derived, scale.rotation_bits, record, motion);
    if (from == kNew) continue;
    const PredictedTurn predicted = predictTurn(before.records[from], before.motions[from], motion.derived, 0);
    for (std::size_t part = 0; part < 4; ++part)
      motion.turn[part] = static_cast<std::int16_t>(record.turn[part] - predicted.from[part]);
    for (std::size_t axis = 0; axis < 3; ++axis)
      motion.place[axis] = record.place[axis] - before.records[from].place[axis];
  }
  Forms out;
  if (has_list_) {
    out.motion_weight = fitWeight(next);
    out.delta = delta(next, out.motion_weight);
  }
  if (!has_list_ || wants_keyframe) out.keyframe = keyframeOf(next, residuals_);
  newest_ = 1 - newest_;
  has_list_ = true;
  return out;
}

core::Bytes FloaterChainEncoder::keyframeOf(const FloaterList& list, ResidualEncoder& residuals) {
  std::array<std::uint16_t, kFloaterMaxCount> all;
  for (std::uint32_t i = 0; i < list.count; ++i) all[i] = static_cast<std::uint16_t>(i);
  putNew(residuals, list, std::span(all).first(list.count));
  for (std::size_t axis = 0; axis < 3; ++axis)
    putColumn(residuals, list.count, [&](std::uint32_t i) { return list.motions[i].place[axis]; });
  for (std::size_t part = 0; part < 4; ++part)
    putColumn(residuals, list.count, [&](std::uint32_t i) { return list.motions[i].turn[part]; });
  core::Bytes payload;
  residuals.finish(payload);
  return payload;
}

void FloaterChainEncoder::match(FloaterList& next) {
  const FloaterList& before = lists_[newest_];
  // Objects keep their order. One whose place changes by more than a residual holds counts as new.
  std::uint32_t first = 0;
  for (std::uint32_t i = 0; i < next.count; ++i) {
    const FloaterRecord& record = next.records[i];
    const auto isSame = [&](const FloaterRecord& other) { return other.id == record.id; };
    const auto end = before.records.begin() + before.count;
    const auto found = std::find_if(before.records.begin() + first, end, isSame);
    from_[i] = kNew;
    if (found == end) continue;
    const auto at = static_cast<std::uint32_t>(found - before.records.begin());
    bool is_kept = found->size_cm == record.size_cm && found->kind == record.kind;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int64_t change = std::int64_t{record.place[axis]} - found->place[axis];
      is_kept = is_kept && fits(change) && fits(change - 2 * std::int64_t{before.motions[at].place[axis]});
    }
    first = at + 1;
    if (is_kept) from_[i] = static_cast<std::uint16_t>(at);
  }
}

std::uint32_t FloaterChainEncoder::fitWeight(const FloaterList& next) const {
  const FloaterList& before = lists_[newest_];
  double product = 0.0, square = 0.0;
  for (std::uint32_t i = 0; i < next.count; ++i) {
    if (from_[i] == kNew) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double last = before.motions[from_[i]].place[axis], now = next.motions[i].place[axis];
      product += last * now;
      square += last * last;
    }
  }
  const double weight = square > 0.0 ? 256.0 * product / square : 0.0;
  return static_cast<std::uint32_t>(std::lround(std::clamp<double>(weight, 0.0, kMotionWeightMax)));
}

core::Bytes FloaterChainEncoder::delta(const FloaterList& next, std::uint32_t motion_weight) {
  const FloaterList& before = lists_[newest_];
  std::array<std::uint16_t, kFloaterMaxCount> new_at, kept_at;
  std::array<bool, kFloaterMaxCount> stays{};
  std::uint32_t new_count = 0, kept_count = 0;
  for (std::uint32_t i = 0; i < next.count; ++i) {
    if (from_[i] == kNew) {
      new_at[new_count++] = static_cast<std::uint16_t>(i);
    } else {
      kept_at[kept_count++] = static_cast<std::uint16_t>(i);
      stays[from_[i]] = true;
    }
  }
  putColumn(residuals_, before.count, [&](std::uint32_t i) { return stays[i] ? 0 : 1; });
  putColumn(residuals_, next.count, [&](std::uint32_t i) { return from_[i] == kNew ? 1 : 0; });
  putNew(residuals_, next, std::span(new_at).first(new_count));

  const auto column = [&](const auto& valueOf) {
    putColumn(residuals_, kept_count, [&](std::uint32_t i) { return valueOf(from_[kept_at[i]], kept_at[i]); });
  };
  column([&](std::uint32_t from, std::uint32_t at) { return before.records[from].flags ^ next.records[at].flags; });
  column([&](std::uint32_t from, std::uint32_t at) {
    return (next.motions[at].derived - before.motions[from].derived) & 3;
  });
  for (std::size_t axis = 0; axis < 3; ++axis) {
    column([&](std::uint32_t from, std::uint32_t at) {
      return next.motions[at].place[axis] - shareOf(before.motions[from].place[axis], motion_weight);
    });
  }
  for (std::uint32_t k = 0; k < 3; ++k) {
    column([&](std::uint32_t from, std::uint32_t at) {
      const std::uint8_t derived = next.motions[at].derived;
      const std::uint32_t part = sentPart(k, derived);
      const PredictedTurn predicted = predictTurn(before.records[from], before.motions[from], derived, motion_weight);
      return next.records[at].turn[part] - predicted.turn[part];
    });
  }
  core::Bytes payload;
  residuals_.finish(payload);
  return payload;
}

}  // namespace spindrift::codec
