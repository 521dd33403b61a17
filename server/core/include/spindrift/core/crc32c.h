// CRC-32C (Castagnoli, polynomial 0x1EDC6F41 reflected), the checksum of frames, logs and snapshots.
#pragma once

#include <cstdint>

#include <spindrift/core/bytes.h>

namespace spindrift::core {

/// Returns the checksum, computed with the processor's instruction if there is one. crc32c("123456789") = 0xE3069283.
std::uint32_t crc32c(ByteView bytes);

}  // namespace spindrift::core
