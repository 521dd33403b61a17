#include "shuffled_groups.h"

#include <array>
#include <cctype>

namespace spindrift::gpu {
namespace {

/// Primes whose product with 65,535, the largest group count that every device must allow, fits 32 bits. If the number
/// of groups is a multiple of the chosen prime, the shader uses 1 instead.
constexpr std::array<std::uint32_t, 8> kFactors = {7919, 10007, 20011, 30011, 40009, 50021, 60013, 65521};

void replaceWord(std::string& text, std::string_view from, std::string_view to) {
  const auto isWord = [](char c) { return c == '_' || std::isalnum(static_cast<unsigned char>(c)) != 0; };
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
    const std::size_t end = at + from.size();
    if ((at > 0 && isWord(text[at - 1])) || (end < text.size() && isWord(text[end]))) {
      at = end;
      continue;
    }
    text.replace(at, from.size(), to);
    at += to.size();
  }
}

}  // namespace

std::string shuffledGroups(std::string_view text, std::uint32_t seed) {
  std::string shader(text);
  replaceWord(shader, "gl_WorkGroupID", "shuffledGroup()");
  replaceWord(shader, "gl_GlobalInvocationID", "shuffledInvocation()");
  const std::string a = std::to_string(kFactors[seed % kFactors.size()]) + "u";
  const std::string b = std::to_string(seed % 65521) + "u";
  // Afterwards the line count restarts, so that driver messages name the right line. A prime has a common divisor with
  // the group count only if it divides the count.
  std::string head = "uint shuffledAxis(uint g, uint count) { return ((count % " + a + " == 0u ? 1u : " + a +
                     ") % count * g + " + b + " % count) % count; } ";
  head +=
      "uvec3 shuffledGroup() { return uvec3(shuffledAxis(gl_WorkGroupID.x, gl_NumWorkGroups.x), "
      "shuffledAxis(gl_WorkGroupID.y, gl_NumWorkGroups.y), shuffledAxis(gl_WorkGroupID.z, gl_NumWorkGroups.z)); } ";
  // A macro, because gl_WorkGroupSize may only be named after the shader has declared it.
  head += "\n#define shuffledInvocation() (shuffledGroup() * gl_WorkGroupSize + gl_LocalInvocationID)\n#line 1\n";
  return head + shader;
}

}  // namespace spindrift::gpu
