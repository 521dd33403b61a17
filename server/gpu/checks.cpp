#include <charconv>
#include <cstdlib>
#include <string>

#include <spindrift/gpu/checks.h>

namespace spindrift::gpu {
namespace {

constexpr std::uint32_t kMaxSeed = 1'000'000;
constexpr std::uint32_t kMaxLag = 10'000;
constexpr std::uint32_t kMaxMemory_MiB = 1'000'000;

/// Reads "NAME=NUMBER" into `value`; false when `word` does not begin with `name` or the number is out of range.
bool readNumber(std::string_view word, std::string_view name, std::uint32_t least, std::uint32_t most,
                std::uint32_t& value) {
  if (!word.starts_with(name) || word.size() <= name.size() || word[name.size()] != '=') return false;
  const char* const begin = word.data() + name.size() + 1;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(begin, end, value);
  return error == std::errc() && stop == end && begin != end && value >= least && value <= most;
}

}  // namespace

core::Result<Checks> parseChecks(std::string_view text) {
  Checks checks;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(','), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (word == "barriers") {
      checks.barriers = true;
    } else if (word == "poison") {
      checks.poison = true;
    } else if (word == "times") {
      checks.times = true;
    } else if (!readNumber(word, "shuffle", 1, kMaxSeed, checks.shuffle_seed) &&
               !readNumber(word, "lag", 0, kMaxLag, checks.lag_fences_count) &&
               !readNumber(word, "memory", 1, kMaxMemory_MiB, checks.memory_mib)) {
      return core::invalid("SPINDRIFT_GPU_CHECKS: \"" + std::string(word) +
                           "\" is not barriers, poison, times, shuffle=1…" + std::to_string(kMaxSeed) + ", lag=0…" +
                           std::to_string(kMaxLag) + " or memory=1…" + std::to_string(kMaxMemory_MiB));
    }
  }
  return checks;
}

core::Result<Checks> checksFromEnvironment() {
  const char* const text = std::getenv("SPINDRIFT_GPU_CHECKS");
  return parseChecks(text ? text : "");
}

}  // namespace spindrift::gpu
