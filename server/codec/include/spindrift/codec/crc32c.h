// CRC-32C (Castagnoli, polynomial 0x1EDC6F41 reflected), the checksum of every frame's payload.
#pragma once

#include <cstdint>

#include <spindrift/core/bytes.h>

namespace spindrift::codec {

/// Returns the checksum, computed with the processor's instruction if there is one. crc32c("123456789") = 0xE3069283.
std::uint32_t crc32c(core::ByteView bytes);

/// The same with tables (slicing by 8), on any processor.
std::uint32_t crc32cTable(core::ByteView bytes);

/// Returns whether this processor has the SSE4.2 instruction.
bool hasCrc32cInstruction();

/// The same with the instruction; call it only if hasCrc32cInstruction().
std::uint32_t crc32cInstruction(core::ByteView bytes);

}  // namespace spindrift::codec
