// Planes in a row, each predicted from the two before it, both ways. A plane can be had in two forms: one that
// continues the row, and one that stands by itself and brings the plane before it along, so that a reader can go on
// from there.
#pragma once

#include <optional>

#include <spindrift/core/bytes.h>

#include "surface_predictor.h"

namespace spindrift::stream {

class PlaneChainEncoder {
 public:
  struct Form {
    SurfaceWeights weights;
    SurfaceWeights earlier_weights;  ///< of a whole form: of the plane before it
    core::Bytes payload;
  };
  struct Forms {
    std::optional<Form> continuing;  ///< absent at the beginning of a row
    std::optional<Form> whole;       ///< at the beginning of a row, or when it was wanted
  };
  /// The next plane. Another resolution begins a new row.
  Forms encode(SurfacePlane plane, bool wants_whole);
  /// The next plane begins a new row.
  void restart() { before_ = {}; }

 private:
  Form continuing(const SurfacePlane& now);
  Form whole(const SurfacePlane& now);

  SurfacePlane before_, earlier_;
  ResidualEncoder residuals_;
};

class PlaneChainDecoder {
 public:
  /// The payload of a whole form. False: it is damaged, and there is no row to continue any more.
  bool readWhole(core::ByteView payload, std::size_t resolution_count, const SurfaceWeights& weights,
                 const SurfaceWeights& earlier_weights);
  /// The payload of a form that continues the row; there has to be one. False as above.
  bool readContinuing(core::ByteView payload, const SurfaceWeights& weights);
  /// Forgets the row.
  void restart() { before_ = {}; }

  /// The plane read last; of resolution 0 where there is no row.
  [[nodiscard]] const SurfacePlane& plane() const { return before_; }

 private:
  SurfacePlane before_, earlier_;
};

}  // namespace spindrift::stream
