#include "frame_head.h"

#include <bit>
#include <cstring>

#include <boost/endian/arithmetic.hpp>

namespace spindrift::cluster {
namespace {

constexpr std::uint32_t kMark = 0x53504631;  // "SPF1"

/// A head as it lies in the message.
struct Layout {
  boost::endian::little_uint32_t mark;
  boost::endian::little_uint64_t run;
  boost::endian::little_uint64_t sequence;
  boost::endian::little_uint16_t reduced_count;
  boost::endian::little_uint16_t due_bits;
  boost::endian::little_uint32_t keyframe_bytes;
  boost::endian::little_uint32_t delta_bytes;
};
static_assert(sizeof(Layout) == kFrameHeadBytes);

}  // namespace

std::array<std::uint8_t, kFrameHeadBytes> toBytes(const FrameHead& head) {
  return std::bit_cast<std::array<std::uint8_t, kFrameHeadBytes>>(
      Layout{.mark = kMark,
             .run = head.run,
             .sequence = head.sequence,
             .reduced_count = head.reduced_count,
             .due_bits = static_cast<std::uint16_t>(head.due.bits()),
             .keyframe_bytes = head.keyframe_bytes,
             .delta_bytes = head.delta_bytes});
}

std::optional<FrameParts> readFrame(core::ByteView message) {
  if (message.size() < kFrameHeadBytes) return std::nullopt;
  Layout layout{};
  std::memcpy(&layout, message.data(), sizeof layout);
  const core::LevelSet due = core::LevelSet::fromBits(layout.due_bits);
  if (layout.mark != kMark || due.bits() != layout.due_bits) return std::nullopt;
  const core::ByteView content = message.subspan(kFrameHeadBytes);
  const std::uint64_t size = std::uint64_t{layout.keyframe_bytes} + layout.delta_bytes;
  if (size != content.size() || size == 0) return std::nullopt;
  return FrameParts{.head = {.run = layout.run,
                             .sequence = layout.sequence,
                             .reduced_count = layout.reduced_count,
                             .due = due,
                             .keyframe_bytes = layout.keyframe_bytes,
                             .delta_bytes = layout.delta_bytes},
                    .keyframe = content.first(layout.keyframe_bytes),
                    .delta = content.subspan(layout.keyframe_bytes)};
}

}  // namespace spindrift::cluster
