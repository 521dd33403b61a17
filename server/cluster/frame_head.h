// The head of a frame on the bus, before its keyframe and its delta: 32 bytes, little endian.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <spindrift/core/bytes.h>
#include <spindrift/core/level.h>

namespace spindrift::cluster {

struct FrameHead {
  std::uint64_t run = 0;            ///< of the room
  std::uint64_t sequence = 0;       ///< of this stream and level in this run: a delta builds on the frame before
  std::uint16_t reduced_count = 0;  ///< core::FrameLevels::reduced_count
  core::LevelSet due = core::LevelSet::all();  ///< core::FrameLevels::due
  std::uint32_t keyframe_bytes = 0;            ///< 0: no keyframe follows
  std::uint32_t delta_bytes = 0;               ///< likewise
};
inline constexpr std::size_t kFrameHeadBytes = 32;

std::array<std::uint8_t, kFrameHeadBytes> toBytes(const FrameHead& head);

struct FrameParts {
  FrameHead head;
  core::ByteView keyframe;  ///< empty: not sent
  core::ByteView delta;
};
/// Views into `message`; nullopt for bytes that are not a frame.
std::optional<FrameParts> readFrame(core::ByteView message);

}  // namespace spindrift::cluster
