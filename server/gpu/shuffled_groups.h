// Test mode: another order of work groups. Private to this module.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace spindrift::gpu {

/// The text of a compute shader in which the work groups of a dispatch are numbered g' = (a g + b) mod G along each
/// axis, G being the number of groups there and a without a common divisor with G, so that each number occurs once.
/// Lines keep their numbers. `seed` chooses a and b.
std::string shuffledGroups(std::string_view text, std::uint32_t seed);

}  // namespace spindrift::gpu
