// A symbol table for one frame, sent along with it: each symbol that occurs, and how often in steps of a factor of
// sqrt 2.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rans.h"
#include "residual_coder.h"

namespace spindrift::stream {

/// counts[s]: how often symbol s is about to be written, at most 256 symbols. Symbols 0 and 1 are in the table in any
/// case, so that no symbol ever has all slots. Writes the table to the raw bits.
SymbolTable putFittedTable(std::span<const std::uint32_t> counts, ResidualEncoder& out);

/// The same table, from the raw bits; symbols that are not in it are never read.
SymbolTable getFittedTable(std::size_t symbol_count, ResidualDecoder& in);

}  // namespace spindrift::stream
