// Messages larger than a NATS server takes, sent in parts. Each part begins with a head of 16 bytes, little endian:
// u64 number of the message (unique per sender), u32 number of the part, u32 number of parts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include <spindrift/core/bytes.h>

namespace spindrift::bus {

inline constexpr std::size_t kPartHeadBytes = 16;
/// Below the 1 MiB that NATS servers take by default.
inline constexpr std::size_t kPartMaxBytes = 768 * 1024;
/// A message has at most this many parts: 48 MiB.
inline constexpr std::uint32_t kPartMaxCount = 64;

struct PartHead {
  std::uint64_t message = 0;
  std::uint32_t part = 0;
  std::uint32_t part_count = 1;
};

void writePartHead(const PartHead& head, std::uint8_t* out);
/// nullopt for bytes that are not a part.
std::optional<PartHead> readPartHead(core::ByteView part);

/// Puts the parts of one subscription together. Keeps at most kOpenMaxCount incomplete messages, one per sender: parts
/// of a message arrive in order, so an older incomplete one never becomes complete.
class PartCollector {
 public:
  static constexpr std::size_t kOpenMaxCount = 64;

  /// Returns the message, which is valid until the next call, if this part completes it. `lost`: counts messages that
  /// were given up.
  std::optional<core::ByteView> take(core::ByteView part, std::uint64_t& lost);

 private:
  struct Open {
    std::uint64_t message = 0;
    std::uint32_t next_part = 0;
    std::uint32_t part_count = 0;
    core::Bytes bytes{};
  };
  std::deque<Open> open_;
  core::Bytes complete_;
};

}  // namespace spindrift::bus
