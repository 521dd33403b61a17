// Encodes a sequence of frames of objects in the water, each predicted from the one before it. A frame has two forms: a
// delta, and a keyframe, which contains the motion of the objects as well, so that a client can continue from it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include <spindrift/bitstream/encode/residual_coder.h>
#include <spindrift/bitstream/format/floater_format.h>
#include <spindrift/core/bytes.h>

namespace spindrift::codec {

/// Precision of one level.
struct FloaterScale {
  double quantum_m = 0.001;
  std::uint32_t rotation_bits = kRotationMaxBits;
};

class FloaterChainEncoder {
 public:
  struct Forms {
    std::optional<core::Bytes> delta;     ///< absent for the first frame of a sequence
    std::optional<core::Bytes> keyframe;  ///< for the first frame of a sequence, or when wanted
    std::uint32_t motion_weight = 0;      ///< of the delta
  };

  /// Encodes objects given as in core::FloatersView, at most kFloaterMaxCount. `scale` stays the same in a sequence.
  Forms encode(std::span<const std::uint32_t> words, const FloaterScale& scale, bool wants_keyframe);
  /// Encodes a frame that was decoded, independent of any chain.
  static core::Bytes keyframeOf(const FloaterList& list, ResidualEncoder& residuals);

 private:
  /// Index of an object in the frame before; kNew: it was not there.
  static constexpr std::uint16_t kNew = 0xffff;

  /// Finds the objects of `next` in the frame before. `next` has no rotations yet.
  void match(FloaterList& next);
  [[nodiscard]] std::uint32_t fitWeight(const FloaterList& next) const;
  core::Bytes delta(const FloaterList& next, std::uint32_t motion_weight);

  std::array<FloaterList, 2> lists_;
  std::size_t newest_ = 0;
  bool has_list_ = false;
  std::array<std::uint16_t, kFloaterMaxCount> from_{};
  ResidualEncoder residuals_;
};

}  // namespace spindrift::codec
