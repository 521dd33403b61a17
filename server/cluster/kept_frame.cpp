#include "kept_frame.h"

#include <utility>

namespace spindrift::cluster {

void KeptFrame::takeKeyframe(core::SharedBytes keyframe) {
  keyframe_ = std::move(keyframe);
  planes_.reset();
}

void KeptFrame::takeDelta(const core::SharedBytes& delta, bool follows_planes) {
  const core::SharedBytes base = std::exchange(keyframe_, nullptr);
  if (!follows_planes) return planes_.reset();
  if (!planes_ && base) {
    planes_ = std::make_unique<codec::PlaneKeeper>();
    if (!planes_->take(*base)) planes_.reset();
  }
  if (planes_ && !planes_->take(*delta)) planes_.reset();
}

void KeptFrame::forget() {
  keyframe_.reset();
  planes_.reset();
}

core::SharedBytes KeptFrame::keyframe() {
  if (!keyframe_ && planes_) keyframe_ = planes_->keyframe();
  return keyframe_;
}

}  // namespace spindrift::cluster
