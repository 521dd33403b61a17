// CRC-32C with tables, sixteen bytes per step: for processors without an instruction for it, WebAssembly among them.
#pragma once

#include <cstddef>
#include <cstdint>

namespace spindrift::core {

/// Returns the CRC of Castagnoli's polynomial, reflected; the checksum of "123456789" is 0xE3069283.
std::uint32_t crc32cByTables(const std::uint8_t* bytes, std::size_t byte_count);

}  // namespace spindrift::core
