// The surface's packed form, both ways: SurfacePredicted in wire.proto.
#include <cassert>
#include <cstring>
#include <utility>

#include <spindrift/stream/frame_decoder.h>
#include <spindrift/stream/frame_encoder.h>

#include "codec/surface_predictor.h"
#include "frame_checks.h"
#include "frame_message.h"

namespace spindrift::stream {
namespace {

std::span<const std::int16_t> samplesOf(const core::SurfaceView& surface) {
  return {reinterpret_cast<const std::int16_t*>(surface.words.data()), 2 * surface.words.size()};
}

template <typename Field>
void putWeights(const SurfaceWeights& weights, Field& field) {
  field.Add(weights.of.begin(), weights.of.end());
}

class SurfacePredictedCodec final : public LayerCodec {
 public:
  v1::Layer layer() const override { return v1::LAYER_SURFACE; }
  v1::Packing packing() const override { return v1::PACKING_PACKED; }

  EncodedFrame encode(const core::FrameView& frame, bool wants_whole) override {
    if (!frame.surface) return {};
    const core::SurfaceView& surface = *frame.surface;
    const bool is_first = before_.resolution() != surface.resolution_count || side_m_ != surface.side_m ||
                          quantum_m_ != surface.quantum_m;
    side_m_ = surface.side_m;
    quantum_m_ = surface.quantum_m;
    now_ = SurfacePlane(surface.resolution_count);
    now_.assign(samplesOf(surface));
    if (is_first) before_ = earlier_ = now_;
    EncodedFrame out;
    if (!is_first) out.continuing = continuing(frame);
    if (is_first || wants_whole) out.whole = whole(frame);
    earlier_ = std::exchange(before_, std::move(now_));
    tick_ = frame.tick;
    return out;
  }

 private:
  v1::LayerFrame headerOf(const core::SurfaceView& surface) const {
    v1::LayerFrame codec;
    v1::SurfacePredicted& header = *codec.mutable_surface_predicted();
    header.set_resolution_count(surface.resolution_count);
    header.set_side_m(surface.side_m);
    header.set_quantum_m(surface.quantum_m);
    return codec;
  }

  core::SharedBytes continuing(const core::FrameView& frame) {
    v1::LayerFrame codec = headerOf(*frame.surface);
    const SurfaceHistory history{&before_, &earlier_};
    const SurfaceWeights weights = fitWeights(now_, history);
    putWeights(weights, *codec.mutable_surface_predicted()->mutable_weights());
    encodePlane(now_, history, weights, residuals_);
    return finish(frame, tick_, codec);
  }

  /// This frame by itself, then the one before it from this one.
  core::SharedBytes whole(const core::FrameView& frame) {
    v1::LayerFrame codec = headerOf(*frame.surface);
    v1::SurfacePredicted& header = *codec.mutable_surface_predicted();
    const SurfaceWeights weights = fitWeights(now_, {});
    putWeights(weights, *header.mutable_weights());
    encodePlane(now_, {}, weights, residuals_);
    const SurfaceHistory history{&now_, nullptr};
    const SurfaceWeights earlier_weights = fitWeights(before_, history);
    putWeights(earlier_weights, *header.mutable_earlier_weights());
    encodePlane(before_, history, earlier_weights, residuals_);
    return finish(frame, std::nullopt, codec);
  }

  core::SharedBytes finish(const core::FrameView& frame, std::optional<std::uint64_t> base_tick,
                           const v1::LayerFrame& codec) {
    payload_.clear();
    residuals_.finish(payload_);
    return serializeFrame(frame, v1::LAYER_SURFACE, base_tick, codec, payload_);
  }

  SurfacePlane now_, before_, earlier_;
  double side_m_ = 0.0;
  double quantum_m_ = 0.0;
  std::uint64_t tick_ = 0;  ///< of before_
  ResidualEncoder residuals_;
  core::Bytes payload_;
};

/// False: not as many as there have to be.
template <typename Field>
bool takeWeights(const Field& field, SurfaceWeights& weights) {
  if (field.size() != static_cast<int>(weights.of.size())) return false;
  std::copy(field.begin(), field.end(), weights.of.begin());
  return true;
}

}  // namespace

std::unique_ptr<LayerCodec> makeSurfacePredictedCodec() {
  return std::make_unique<SurfacePredictedCodec>();
}

struct PackedSurfaceDecoder::History {
  SurfacePlane before, earlier;
  double side_m = 0.0;
  double quantum_m = 0.0;
  std::uint64_t tick = 0;
  bool is_there = false;
};

PackedSurfaceDecoder::PackedSurfaceDecoder() : history_(std::make_unique<History>()) {}
PackedSurfaceDecoder::~PackedSurfaceDecoder() = default;

core::Result<SurfaceSamples> PackedSurfaceDecoder::decode(const v1::LayerFrame& frame) {
  History& h = *history_;
  const bool was_there = std::exchange(h.is_there, false);  // until this frame has proved good
  if (!frame.has_surface_predicted()) return invalid("codec: not surface_predicted");
  const v1::SurfacePredicted& header = frame.surface_predicted();
  if (auto error = checkResolution(header.resolution_count())) return *error;
  if (auto error = checkRange("side_m", header.side_m(), 1e-6)) return *error;
  if (auto error = checkRange("quantum_m", header.quantum_m(), 1e-9)) return *error;
  if (auto error = checkFrame(frame, v1::LAYER_SURFACE)) return *error;
  SurfaceWeights weights, earlier_weights;
  if (!takeWeights(header.weights(), weights)) {
    return invalid("weights: " + std::to_string(header.weights_size()) + ", there have to be 10");
  }
  ResidualDecoder residuals(viewOf(frame.payload()));
  SurfacePlane now(header.resolution_count());
  if (frame.keyframe()) {
    if (!takeWeights(header.earlier_weights(), earlier_weights)) {
      return invalid("earlier_weights: " + std::to_string(header.earlier_weights_size()) + ", there have to be 10");
    }
    decodePlane(residuals, {}, weights, now);
    h.earlier = SurfacePlane(header.resolution_count());
    decodePlane(residuals, {&now, nullptr}, earlier_weights, h.earlier);
  } else {
    if (!was_there || frame.base_tick() != h.tick || now.resolution() != h.before.resolution() ||
        header.side_m() != h.side_m || header.quantum_m() != h.quantum_m) {
      return core::Error{core::ErrorCode::kUnavailable, "base_tick: the frame builds on tick " +
                                                            std::to_string(frame.base_tick()) +
                                                            ", which is not here: subscribe again for a keyframe"};
    }
    decodePlane(residuals, {&h.before, &h.earlier}, weights, now);
    h.earlier = std::move(h.before);
  }
  if (!residuals.isAtEnd()) return invalid("payload: its end does not fit its beginning; the frame is damaged");
  h.before = std::move(now);
  h.side_m = header.side_m();
  h.quantum_m = header.quantum_m();
  h.tick = frame.tick();
  h.is_there = true;

  SurfaceSamples out;
  out.resolution_count = header.resolution_count();
  out.side_m = header.side_m();
  out.quantum_m = header.quantum_m();
  const std::size_t n = h.before.resolution();
  out.elevation_m.reserve(n * n);
  for (std::size_t z = 0; z < n; ++z) {
    const std::int16_t* row = h.before.row(static_cast<std::ptrdiff_t>(z));
    for (std::size_t x = 0; x < n; ++x) out.elevation_m.push_back(static_cast<float>(row[x] * header.quantum_m()));
  }
  return out;
}

}  // namespace spindrift::stream
