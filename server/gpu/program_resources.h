// What OpenGL tells of a linked program. Private to this module.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include <spindrift/gpu/program.h>

namespace spindrift::gpu {

/// Uniform and storage blocks by the name after `uniform` or `buffer`; without those that the driver found unused.
std::map<std::string, BlockLayout> blocksOf(std::uint32_t program_id);

/// Texture unit of each samplerBuffer, usamplerBuffer and isamplerBuffer that is used, by name.
std::map<std::string, std::uint32_t> texelUnitsOf(std::uint32_t program_id);

}  // namespace spindrift::gpu
