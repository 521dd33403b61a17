// CRC-32C (Castagnoli, polynomial 0x1EDC6F41 reflected), the checksum of frames, logs and snapshots.
#pragma once

#include <cstdint>

#include <spindrift/core/bytes.h>

namespace spindrift::core {

/// Returns the checksum, computed with the processor's instruction if there is one. crc32c("123456789") = 0xE3069283.
std::uint32_t crc32c(ByteView bytes);

/// Returns the same with tables (slicing by 16), on any processor.
std::uint32_t crc32cTable(ByteView bytes);

/// Returns whether this processor has the SSE4.2 instruction.
bool hasCrc32cInstruction();

/// Returns the same with the instruction; call it only if hasCrc32cInstruction().
std::uint32_t crc32cInstruction(ByteView bytes);

}  // namespace spindrift::core
