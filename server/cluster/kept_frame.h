// The newest frame of one stream at one level, in a form that a session which comes between two frames can begin with.
#pragma once

#include <memory>

#include <spindrift/codec/frame_decoder.h>
#include <spindrift/core/bytes.h>

namespace spindrift::cluster {

/// Memory: one keyframe and what a FrameKeeper keeps. Not thread-safe.
class KeptFrame {
 public:
  void takeKeyframe(core::SharedBytes keyframe);
  /// `follows`: decode the delta, so that the frame can be kept.
  /// Otherwise nothing is kept until the next keyframe.
  void takeDelta(const core::SharedBytes& delta, bool follows);
  void forget();

  /// Returns whether keyframe() is there.
  [[nodiscard]] bool isWhole() const { return keyframe_ || keeper_; }
  /// Returns the newest frame as a keyframe: a session that has it can use the next delta. Null if it is not known.
  /// Made at the first call where the frame came as a delta.
  [[nodiscard]] core::SharedBytes keyframe();

 private:
  core::SharedBytes keyframe_;
  std::unique_ptr<codec::FrameKeeper> keeper_;  ///< since the first delta after a keyframe
};

}  // namespace spindrift::cluster
