// Queries of a linked OpenGL program. Private to this module.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include <spindrift/gpu/program.h>

namespace spindrift::gpu {

/// Returns uniform and storage blocks by the name after `uniform` or `buffer`, without those that the driver found
/// unused.
std::map<std::string, BlockLayout> blocksOf(std::uint32_t program_id);

/// Returns the texture unit of each used samplerBuffer, usamplerBuffer and isamplerBuffer, by name.
std::map<std::string, std::uint32_t> texelUnitsOf(std::uint32_t program_id);

}  // namespace spindrift::gpu
