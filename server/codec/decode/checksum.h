// CRC-32C by tables, sixteen bytes a turn: where the machine has no instruction for it.
#pragma once

#include <cstddef>
#include <cstdint>

namespace spindrift::codec {

/// Castagnoli's polynomial, reflected; of "123456789" it is 0xE3069283.
std::uint32_t crc32cByTables(const std::uint8_t* bytes, std::size_t byte_count);

}  // namespace spindrift::codec
