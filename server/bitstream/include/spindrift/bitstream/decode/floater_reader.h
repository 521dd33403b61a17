// Decodes a sequence of frames of objects in the water, each predicted from the one before it. The decoder for
// codec/floater_chain. It allocates no memory.
#pragma once

#include <array>
#include <cstdint>

#include <spindrift/bitstream/decode/residual_reader.h>
#include <spindrift/bitstream/format/floater_format.h>

namespace spindrift::codec {

class FloaterReader {
 public:
  /// Bounds of what the header of a frame says; a frame outside of them cannot be read.
  [[nodiscard]] static constexpr bool isAllowed(std::uint32_t count, std::uint32_t rotation_bits,
                                                std::uint32_t motion_weight) {
    return count <= kFloaterMaxCount && rotation_bits >= kRotationMinBits && rotation_bits <= kRotationMaxBits &&
           motion_weight <= kMotionWeightMax;
  }

  /// Decodes the payload of a keyframe, which BitSource::kSlackBytes of 0 must follow. False: it is damaged, and the
  /// objects are forgotten.
  bool readKeyframe(const std::uint8_t* payload, std::uint32_t byte_count, std::uint32_t count,
                    std::uint32_t rotation_bits);
  /// Decodes the payload of a delta. False: it is damaged (as above), or there is no frame before it.
  bool readDelta(const std::uint8_t* payload, std::uint32_t byte_count, std::uint32_t count,
                 std::uint32_t rotation_bits, std::uint32_t motion_weight);
  /// Forgets the objects, so that only a keyframe can follow.
  void forget() { has_list_ = false; }

  /// Returns whether there is a frame; then list() has the objects of the newest one.
  [[nodiscard]] bool hasList() const { return has_list_; }
  [[nodiscard]] const FloaterList& list() const { return lists_[newest_]; }

 private:
  using Indices = std::array<std::uint16_t, kFloaterMaxCount>;

  /// Reads which objects of the frame before stay, and which ones come. False: damaged.
  bool readChanges(ResidualReader& in, const FloaterList& before, std::uint32_t count);
  /// Reads the objects that are not in the frame before. False: damaged.
  bool readNew(ResidualReader& in, FloaterList& out, std::uint32_t rotation_bits);
  void readMotions(ResidualReader& in, FloaterList& out);
  bool readKept(ResidualReader& in, const FloaterList& before, FloaterList& out, std::uint32_t rotation_bits,
                std::uint32_t motion_weight);

  std::array<FloaterList, 2> lists_;
  std::size_t newest_ = 0;
  bool has_list_ = false;
  // Of the frame that is read: the objects that are new, and those that stay with their index in the frame before.
  std::uint32_t new_count_ = 0;
  std::uint32_t kept_count_ = 0;
  Indices new_at_{};
  Indices kept_at_{};
  Indices kept_from_{};
};

}  // namespace spindrift::codec
