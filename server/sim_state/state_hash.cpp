#include <algorithm>
#include <bit>
#include <cstdint>
#include <ranges>
#include <type_traits>
#include <variant>

#include <boost/pfr/core.hpp>

#include <spindrift/sim_state/saved_state.h>

namespace spindrift::sim {
namespace {

bool everHadFloaters(const HostState& host) {
  return host.floaters.next_id > 1;
}

/// 64-bit FNV-1a over 32-bit words. Visits every field of a plain struct, so that none can be forgotten.
class Hash {
  /// Fields that count only where they are used, so that states without them keep the hash that they had before.
  template <typename T>
  static bool omits(const T&, std::size_t) {
    return false;
  }
  static bool omits(const core::BreakingWave& wave, std::size_t field) { return wave.width_m <= 0.0 && field >= 6; }
  static bool omits(const Stroke& stroke, std::size_t field) {
    return stroke.tool == StrokeTool::kFinger && field == 2;
  }
  static bool omits(const BoatPlace& place, std::size_t field) { return place.moved_left_s == 0.0 && field == 2; }
  static bool omits(const HostState& host, std::size_t field) { return !everHadFloaters(host) && field == 2; }

 public:
  template <typename T>
  void operator()(const T& value) {
    if constexpr (std::is_same_v<T, Effects>) {
      (*this)(value.active());
      if (const auto& strokes = value.strokes().active(); !strokes.empty()) (*this)(strokes);
    } else if constexpr (std::is_same_v<T, double>) {
      add(std::bit_cast<std::uint64_t>(value));
    } else if constexpr (std::is_integral_v<T> || std::is_enum_v<T>) {
      add(static_cast<std::uint64_t>(value));
    } else if constexpr (std::ranges::range<T>) {
      add(std::ranges::size(value));
      for (const auto& each : value) (*this)(each);
    } else if constexpr (requires { value.has_value(); }) {
      (*this)(value.has_value());
      if (value) (*this)(*value);
    } else if constexpr (requires { value.valueless_by_exception(); }) {
      (*this)(value.index());
      std::visit([this](const auto& held) { (*this)(held); }, value);
    } else {
      boost::pfr::for_each_field(value, [&](const auto& field, std::size_t k) {
        if (!omits(value, k)) (*this)(field);
      });
    }
  }
  void operator()(std::uint32_t word) { hash_ = (hash_ ^ word) * 0x100000001b3ull; }
  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  void add(std::uint64_t value) {
    (*this)(static_cast<std::uint32_t>(value));
    (*this)(static_cast<std::uint32_t>(value >> 32));
  }

  std::uint64_t hash_ = 0xcbf29ce484222325ull;
};

}  // namespace

std::uint64_t hashOf(const SavedState& state) {
  const auto is_floaters = [](const SavedBuffer& buffer) { return buffer.name == "floaters"; };
  if (!everHadFloaters(state.host) && std::ranges::any_of(state.buffers, is_floaters)) {
    SavedState without = state;
    std::erase_if(without.buffers, is_floaters);
    return hashOf(without);
  }
  Hash hash;
  hash(state);
  return hash.value();
}

}  // namespace spindrift::sim
