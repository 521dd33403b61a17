// Test mode: a permuted order of work groups. Private to this module.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace spindrift::gpu {

/// Returns the text of a compute shader with permuted work groups: g' = (a g + b) mod G along each axis, where G is the
/// number of groups and a has no common divisor with G, so that each number occurs once. Line numbers stay the same.
/// `seed` chooses a and b.
std::string shuffledGroups(std::string_view text, std::uint32_t seed);

}  // namespace spindrift::gpu
