// Planes in a row, each predicted from the two before it. A plane can be had in two forms: one that
// continues the row, and one that stands by itself and brings the plane before it along, so that a reader can go on
// from there.
#pragma once

#include <optional>

#include <spindrift/core/bytes.h>

#include "surface_predictor.h"

namespace spindrift::codec {

class PlaneChainEncoder {
 public:
  struct Form {
    SurfaceWeights weights;
    SurfaceWeights earlier_weights;  ///< of a keyframe: of the plane before it
    core::Bytes payload;
  };
  struct Forms {
    std::optional<Form> delta;     ///< absent at the beginning of a row
    std::optional<Form> keyframe;  ///< at the beginning of a row, or when it was wanted
  };
  /// Where the next plane's samples go.
  SurfacePlane& next() { return next_; }
  /// The forms of the plane that was put there. Another resolution begins a new row.
  Forms encode(bool wants_keyframe);
  /// The next plane begins a new row.
  void restart() { before_.resize(0); }

 private:
  Form delta();
  Form keyframe();

  SurfacePlane next_, before_, earlier_;
  ResidualEncoder residuals_;
};

}  // namespace spindrift::codec
