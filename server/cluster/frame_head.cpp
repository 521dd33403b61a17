#include "frame_head.h"

namespace spindrift::cluster {
namespace {

constexpr std::uint32_t kMark = 0x53504631;  // "SPF1"

template <typename Number>
std::uint8_t* write(Number value, std::uint8_t* out) {
  for (std::size_t k = 0; k < sizeof(Number); ++k) *out++ = static_cast<std::uint8_t>(value >> (8 * k));
  return out;
}

template <typename Number>
Number read(const std::uint8_t*& bytes) {
  Number value = 0;
  for (std::size_t k = 0; k < sizeof(Number); ++k) value |= static_cast<Number>(Number{*bytes++} << (8 * k));
  return value;
}

}  // namespace

std::array<std::uint8_t, kFrameHeadBytes> toBytes(const FrameHead& head) {
  std::array<std::uint8_t, kFrameHeadBytes> out{};
  std::uint8_t* at = write(kMark, out.data());
  at = write(head.run, at);
  at = write(head.sequence, at);
  at = write(head.reduced_count, at);
  at = write(static_cast<std::uint16_t>(head.due.bits()), at);
  at = write(head.keyframe_bytes, at);
  write(head.delta_bytes, at);
  return out;
}

std::optional<FrameParts> readFrame(core::ByteView message) {
  if (message.size() < kFrameHeadBytes) return std::nullopt;
  const std::uint8_t* at = message.data();
  if (read<std::uint32_t>(at) != kMark) return std::nullopt;
  FrameParts out;
  out.head.run = read<std::uint64_t>(at);
  out.head.sequence = read<std::uint64_t>(at);
  out.head.reduced_count = read<std::uint16_t>(at);
  const std::uint16_t due_bits = read<std::uint16_t>(at);
  out.head.due = core::LevelSet::fromBits(due_bits);
  if (out.head.due.bits() != due_bits) return std::nullopt;
  out.head.keyframe_bytes = read<std::uint32_t>(at);
  out.head.delta_bytes = read<std::uint32_t>(at);
  const core::ByteView content = message.subspan(kFrameHeadBytes);
  const std::uint64_t size = std::uint64_t{out.head.keyframe_bytes} + out.head.delta_bytes;
  if (size != content.size() || size == 0) return std::nullopt;
  out.keyframe = content.first(out.head.keyframe_bytes);
  out.delta = content.subspan(out.head.keyframe_bytes);
  return out;
}

}  // namespace spindrift::cluster
