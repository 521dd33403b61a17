#include <algorithm>

#include <spindrift/bitstream/decode/floater_reader.h>

namespace spindrift::codec {
namespace {

/// Reads one number for each of `count` objects, in groups.
template <typename Use>
void readColumn(ResidualReader& in, std::uint32_t count, Use use) {
  ResidualGroup group;
  std::uint32_t group_class = 0;
  for (std::uint32_t begin = 0; begin < count; begin += kGroupMaxCount) {
    const std::uint32_t n = std::min<std::uint32_t>(kGroupMaxCount, count - begin);
    group_class = in.group(group, n, group_class, group_class);
    for (std::uint32_t i = 0; i < n; ++i) use(begin + i, std::int32_t{group.of[i]});
  }
}

constexpr bool isPlace(std::int64_t value) {
  return value >= -kFloaterMaxPlace && value <= kFloaterMaxPlace;
}

/// Computes the part that is not sent. False: the others are longer than a unit quaternion.
bool derive(FloaterRecord& record, std::uint32_t derived, std::uint32_t rotation_bits) {
  const std::int32_t part = derivedPart(record.turn, derived, rotation_bits);
  record.turn[derived] = static_cast<std::int16_t>(std::max(part, 0));
  return part >= 0;
}

}  // namespace

bool FloaterReader::readKeyframe(const std::uint8_t* payload, std::uint32_t byte_count, std::uint32_t count,
                                 std::uint32_t rotation_bits) {
  forget();
  if (!isAllowed(count, rotation_bits, 0)) return false;
  ResidualReader in(payload, byte_count);
  FloaterList& out = lists_[newest_];
  out.count = count;
  new_count_ = count;
  for (std::uint32_t i = 0; i < count; ++i) new_at_[i] = static_cast<std::uint16_t>(i);
  if (!readNew(in, out, rotation_bits)) return false;
  readMotions(in, out);
  has_list_ = in.isAtEnd();
  return has_list_;
}

bool FloaterReader::readDelta(const std::uint8_t* payload, std::uint32_t byte_count, std::uint32_t count,
                              std::uint32_t rotation_bits, std::uint32_t motion_weight) {
  if (!has_list_) return false;
  forget();
  if (!isAllowed(count, rotation_bits, motion_weight)) return false;
  ResidualReader in(payload, byte_count);
  const FloaterList& before = lists_[newest_];
  FloaterList& out = lists_[1 - newest_];
  out.count = count;
  if (!readChanges(in, before, count) || !readNew(in, out, rotation_bits) ||
      !readKept(in, before, out, rotation_bits, motion_weight))
    return false;
  newest_ = 1 - newest_;
  has_list_ = in.isAtEnd();
  return has_list_;
}

bool FloaterReader::readChanges(ResidualReader& in, const FloaterList& before, std::uint32_t count) {
  bool is_valid = true;
  std::uint32_t stay_count = 0;
  readColumn(in, before.count, [&](std::uint32_t i, std::int32_t is_gone) {
    is_valid = is_valid && (is_gone == 0 || is_gone == 1);
    if (is_gone == 0) kept_from_[stay_count++] = static_cast<std::uint16_t>(i);
  });
  new_count_ = kept_count_ = 0;
  readColumn(in, count, [&](std::uint32_t i, std::int32_t is_new) {
    is_valid = is_valid && (is_new == 0 || is_new == 1);
    if (is_new != 0)
      new_at_[new_count_++] = static_cast<std::uint16_t>(i);
    else
      kept_at_[kept_count_++] = static_cast<std::uint16_t>(i);
  });
  return is_valid && kept_count_ == stay_count;
}

bool FloaterReader::readNew(ResidualReader& in, FloaterList& out, std::uint32_t rotation_bits) {
  bool is_valid = true;
  const auto record = [&](std::uint32_t i) -> FloaterRecord& { return out.records[new_at_[i]]; };
  const auto column = [&](const auto& use) { readColumn(in, new_count_, use); };
  std::uint32_t id = 0;
  column([&](std::uint32_t i, std::int32_t low) { record(i).id = static_cast<std::uint32_t>(low); });
  column([&](std::uint32_t i, std::int32_t high) {
    id += 1 + record(i).id + (static_cast<std::uint32_t>(high) << 16);
    record(i).id = id;
    is_valid = is_valid && id != 0;
  });
  std::uint16_t size_cm = 0;
  column([&](std::uint32_t i, std::int32_t change) {
    record(i).size_cm = size_cm = static_cast<std::uint16_t>(size_cm + change);
  });
  std::int32_t kind = 0;
  column([&](std::uint32_t i, std::int32_t change) {
    kind += change;
    is_valid = is_valid && kind >= 1 && kind <= 255;
    record(i).kind = static_cast<std::uint8_t>(kind);
  });
  column([&](std::uint32_t i, std::int32_t flags) {
    is_valid = is_valid && flags >= 0 && flags <= 255;
    record(i).flags = static_cast<std::uint8_t>(flags);
  });
  for (std::size_t axis = 0; axis < 3; ++axis) {
    column([&](std::uint32_t i, std::int32_t low) { record(i).place[axis] = low; });
    column([&](std::uint32_t i, std::int32_t high) {
      const std::int64_t place = record(i).place[axis] + std::int64_t{high} * 65536;
      is_valid = is_valid && isPlace(place);
      record(i).place[axis] = static_cast<std::int32_t>(place);
    });
  }
  column([&](std::uint32_t i, std::int32_t derived) {
    is_valid = is_valid && derived >= 0 && derived <= 3;
    out.motions[new_at_[i]] = {.derived = static_cast<std::uint8_t>(derived & 3)};
  });
  for (std::uint32_t k = 0; k < 3; ++k) {
    column([&](std::uint32_t i, std::int32_t part) {
      record(i).turn[sentPart(k, out.motions[new_at_[i]].derived)] = static_cast<std::int16_t>(part);
    });
  }
  for (std::uint32_t i = 0; i < new_count_; ++i)
    is_valid = derive(record(i), out.motions[new_at_[i]].derived, rotation_bits) && is_valid;
  return is_valid;
}

void FloaterReader::readMotions(ResidualReader& in, FloaterList& out) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    readColumn(in, out.count, [&](std::uint32_t i, std::int32_t change) { out.motions[i].place[axis] = change; });
  for (std::size_t part = 0; part < 4; ++part) {
    readColumn(in, out.count, [&](std::uint32_t i, std::int32_t change) {
      out.motions[i].turn[part] = static_cast<std::int16_t>(change);
    });
  }
}

bool FloaterReader::readKept(ResidualReader& in, const FloaterList& before, FloaterList& out,
                             std::uint32_t rotation_bits, std::uint32_t motion_weight) {
  bool is_valid = true;
  const auto column = [&](const auto& use) {
    readColumn(in, kept_count_, [&](std::uint32_t i, std::int32_t value) { use(kept_from_[i], kept_at_[i], value); });
  };
  column([&](std::uint32_t from, std::uint32_t at, std::int32_t changed) {
    is_valid = is_valid && changed >= 0 && changed <= 255;
    out.records[at] = before.records[from];
    out.records[at].flags = static_cast<std::uint8_t>(before.records[from].flags ^ changed);
  });
  column([&](std::uint32_t from, std::uint32_t at, std::int32_t step) {
    is_valid = is_valid && step >= 0 && step <= 3;
    out.motions[at].derived = static_cast<std::uint8_t>((before.motions[from].derived + step) & 3);
  });
  for (std::size_t axis = 0; axis < 3; ++axis) {
    column([&](std::uint32_t from, std::uint32_t at, std::int32_t residual) {
      const std::int32_t last = before.records[from].place[axis];
      const std::int64_t place =
          std::int64_t{last} + shareOf(before.motions[from].place[axis], motion_weight) + residual;
      is_valid = is_valid && isPlace(place);
      out.records[at].place[axis] = isPlace(place) ? static_cast<std::int32_t>(place) : 0;
      out.motions[at].place[axis] = out.records[at].place[axis] - last;
    });
  }
  for (std::uint32_t k = 0; k < 3; ++k) {
    column([&](std::uint32_t from, std::uint32_t at, std::int32_t residual) {
      const std::uint32_t part = sentPart(k, out.motions[at].derived);
      const PredictedTurn predicted =
          predictTurn(before.records[from], before.motions[from], out.motions[at].derived, motion_weight);
      out.records[at].turn[part] = static_cast<std::int16_t>(predicted.turn[part] + residual);
    });
  }
  for (std::uint32_t i = 0; i < kept_count_; ++i) {
    const std::uint32_t at = kept_at_[i], from = kept_from_[i];
    FloaterMotion& motion = out.motions[at];
    is_valid = derive(out.records[at], motion.derived, rotation_bits) && is_valid;
    const PredictedTurn predicted = predictTurn(before.records[from], before.motions[from], motion.derived, 0);
    for (std::size_t part = 0; part < 4; ++part)
      motion.turn[part] = static_cast<std::int16_t>(out.records[at].turn[part] - predicted.from[part]);
  }
  return is_valid;
}

}  // namespace spindrift::codec
