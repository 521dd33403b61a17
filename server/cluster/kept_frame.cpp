#include "kept_frame.h"

#include <utility>

namespace spindrift::cluster {

void KeptFrame::takeKeyframe(core::SharedBytes keyframe) {
  keyframe_ = std::move(keyframe);
  keeper_.reset();
}

void KeptFrame::takeDelta(const core::SharedBytes& delta, bool follows) {
  const core::SharedBytes base = std::exchange(keyframe_, nullptr);
  if (!follows) return keeper_.reset();
  if (!keeper_ && base) {
    keeper_ = std::make_unique<codec::FrameKeeper>();
    if (!keeper_->take(*base)) keeper_.reset();
  }
  if (keeper_ && !keeper_->take(*delta)) keeper_.reset();
}

void KeptFrame::forget() {
  keyframe_.reset();
  keeper_.reset();
}

core::SharedBytes KeptFrame::keyframe() {
  if (!keyframe_ && keeper_) keyframe_ = keeper_->keyframe();
  return keyframe_;
}

}  // namespace spindrift::cluster
