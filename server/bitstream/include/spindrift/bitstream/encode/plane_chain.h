// Encodes a sequence of planes, each predicted from the two before it. A plane has two forms: a delta, and a keyframe,
// which contains the previous plane as well, so that a client can continue from it.
#pragma once

#include <optional>

#include <spindrift/bitstream/encode/surface_predictor.h>
#include <spindrift/core/bytes.h>

namespace spindrift::codec {

class PlaneChainEncoder {
 public:
  struct Form {
    SurfaceWeights weights;
    SurfaceWeights earlier_weights;  ///< keyframe only: of the previous plane
    core::Bytes payload;
  };
  struct Forms {
    std::optional<Form> delta;     ///< absent for the first plane of a sequence
    std::optional<Form> keyframe;  ///< for the first plane of a sequence, or when wanted
  };
  /// A keyframe of the plane `newest`, with `before` as the plane before it, independent of any chain.
  static Form keyframeOf(const SurfacePlane& newest, const SurfacePlane& before, ResidualEncoder& residuals);

  /// The plane that the caller fills with the next samples.
  SurfacePlane& next() { return next_; }
  /// Encodes the plane in next(). Another size begins a new sequence.
  Forms encode(bool wants_keyframe);
  /// The next plane begins a new sequence.
  void restart() { before_.resize({}); }

 private:
  SurfacePlane next_, before_, earlier_;
  ResidualEncoder residuals_;
  std::optional<SurfaceWeights> guess_;  ///< weights of the newest delta
};

}  // namespace spindrift::codec
