// Encoder and decoder of packed planes: SurfacePredicted and FoamPredicted in wire.proto.
#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <spindrift/codec/frame_decoder.h>
#include <spindrift/core/crc32c.h>

#include "layer_encoders.h"
#include "packed_payload.h"

namespace spindrift::codec {
namespace {

constexpr double kFoamQuantum = 1.0;

/// A plane's quantum is in the header of a surface, and fixed for foam.
template <typename Header>
double quantumOf(const Header& header) {
  if constexpr (requires { header.quantum_m(); }) return header.quantum_m();
  return kFoamQuantum;
}

/// False: the number of weights is wrong.
template <typename Field>
bool takeWeights(const Field& field, SurfaceWeights& weights) {
  if (field.size() != static_cast<int>(weights.of.size())) return false;
  std::ranges::copy(field, weights.of.begin());
  return true;
}

/// Returns the converted samples of a plane; `row`: which plane.
template <typename Value, typename Convert = std::identity>
std::vector<Value> valuesOf(const PlaneRow& planes, const std::int16_t* (PlaneRow::*row)(std::size_t) const,
                            Convert convert = {}) {
  std::vector<Value> out(planes.countX() * planes.countZ());
  for (std::size_t z = 0; z < planes.countZ(); ++z) {
    const std::int16_t* const first = (planes.*row)(z);
    std::transform(first, first + planes.countX(), out.data() + z * planes.countX(), convert);
  }
  return out;
}

}  // namespace

template <typename Sample, typename View, typename Header>
EncodedFrame PackedPlanes::encode(const core::FrameView& frame, v1::Layer layer, core::Level level, bool wants_keyframe,
                                  const View& view, double quantum_m, Header* (v1::LayerFrame::*header_of)()) {
  const PlaneExtents extents{view.count, view.length_m, view.width_m};
  if (extents_ != extents || quantum_m_ != quantum_m) chain_.restart();
  extents_ = extents;
  quantum_m_ = quantum_m;
  chain_.next().resize(view.count);
  chain_.next().assign(std::span(reinterpret_cast<const Sample*>(view.words.data()), view.count.total()));
  const PlaneChainEncoder::Forms forms = chain_.encode(wants_keyframe);
  const auto message = [&](const std::optional<PlaneChainEncoder::Form>& form,
                           std::optional<std::uint64_t> base_tick) -> core::SharedBytes {
    if (!form) return nullptr;
    v1::LayerFrame codec;
    Header& header = *(codec.*header_of)();
    setExtents(extents, header);
    if constexpr (requires { header.set_quantum_m(quantum_m); }) header.set_quantum_m(quantum_m);
    header.mutable_weights()->Add(form->weights.of.begin(), form->weights.of.end());
    if (!base_tick)
      header.mutable_earlier_weights()->Add(form->earlier_weights.of.begin(), form->earlier_weights.of.end());
    return serializeFrame(frame, layer, level, base_tick, codec, form->payload);
  };
  EncodedFrame out{.keyframe = message(forms.keyframe, std::nullopt), .delta = message(forms.delta, tick_)};
  tick_ = frame.tick;
  return out;
}

EncodedFrame PackedPlanes::encode(const core::FrameView& frame, v1::Layer layer, core::Level level,
                                  bool wants_keyframe) {
  const auto& at = frame.at(level);
  if (layer == v1::LAYER_SURFACE && at.surface) {
    return encode<std::int16_t>(frame, layer, level, wants_keyframe, *at.surface, at.surface->quantum_m,
                                &v1::LayerFrame::mutable_surface_predicted);
  }
  if (layer == v1::LAYER_FOAM && at.foam) {
    return encode<std::uint8_t>(frame, layer, level, wants_keyframe, *at.foam, kFoamQuantum,
                                &v1::LayerFrame::mutable_foam_predicted);
  }
  return {};
}

/// The planes that a client has decoded, and their header values.
struct PackedPlaneDecoder::History {
  PlaneMemory memory;
  PlaneExtents extents;
  double quantum_m = 0.0;
  std::uint64_t tick = 0;

  /// Decodes a packed surface or packed foam into `memory`; after an error it holds nothing.
  std::optional<core::Error> read(const v1::LayerFrame& frame) {
    auto error = frame.has_surface_predicted() ? read(frame, v1::LAYER_SURFACE, frame.surface_predicted())
                                               : read(frame, v1::LAYER_FOAM, frame.foam_predicted());
    if (error) memory.row().forget();
    return error;
  }

 private:
  template <typename Header>
  std::optional<core::Error> read(const v1::LayerFrame& frame, v1::Layer layer, const Header& header) {
    const PlaneExtents header_extents = extentsOf(header);
    const double header_quantum_m = quantumOf(header);
    if (auto error = checkExtents(header_extents)) return error;
    if (auto error = checkRange("quantum_m", header_quantum_m, 1e-9)) return error;
    if (auto error = checkFrame(frame, layer)) return error;
    SurfaceWeights weights, earlier_weights;
    if (!takeWeights(header.weights(), weights))
      return invalid("weights: " + std::to_string(header.weights_size()) + ", there have to be 10");
    const PackedPayload payload(viewOf(frame.payload()));
    PlaneRow& row = memory.row();
    bool is_read = false;
    if (frame.keyframe()) {
      if (!takeWeights(header.earlier_weights(), earlier_weights))
        return invalid("earlier_weights: " + std::to_string(header.earlier_weights_size()) + ", there have to be 10");
      memory.resize(header_extents.count);
      is_read = row.readKeyframe(payload.data(), payload.size(), weights, earlier_weights);
    } else {
      if (!row.hasRow() || frame.base_tick() != tick || header_extents != extents || header_quantum_m != quantum_m) {
        return core::unavailable("base_tick: the frame builds on tick " + std::to_string(frame.base_tick()) +
                                 ", which is not here: subscribe again for a keyframe");
      }
      is_read = row.readDelta(payload.data(), payload.size(), weights);
    }
    if (!is_read) return invalid("payload: its end does not fit its beginning; the frame is damaged");
    extents = header_extents;
    quantum_m = header_quantum_m;
    tick = frame.tick();
    return std::nullopt;
  }
};

PackedPlaneDecoder::PackedPlaneDecoder() : history_(std::make_unique<History>()) {}
PackedPlaneDecoder::~PackedPlaneDecoder() = default;

core::Result<SurfaceSamples> PackedSurfaceDecoder::decode(const v1::LayerFrame& frame) {
  if (!frame.has_surface_predicted()) return invalid("codec: not surface_predicted");
  if (auto error = history_->read(frame)) return *error;
  const double quantum_m = history_->quantum_m;
  const auto elevationOf = [quantum_m](std::int16_t sample) { return static_cast<float>(sample * quantum_m); };
  return SurfaceSamples{history_->extents, quantum_m,
                        valuesOf<float>(history_->memory.row(), &PlaneRow::row, elevationOf)};
}

core::Result<FoamSamples> PackedFoamDecoder::decode(const v1::LayerFrame& frame) {
  if (!frame.has_foam_predicted()) return invalid("codec: not foam_predicted");
  if (auto error = history_->read(frame)) return *error;
  const auto foamOf = [](std::int16_t sample) { return static_cast<std::uint8_t>(std::clamp<int>(sample, 0, 255)); };
  return FoamSamples{history_->extents, valuesOf<std::uint8_t>(history_->memory.row(), &PlaneRow::row, foamOf)};
}

bool FrameKeeper::take(core::ByteView message) {
  head_.reset();
  auto parsed = parseServerMessage(message);
  if (!parsed || !parsed->has_frame()) return false;
  v1::LayerFrame& frame = *parsed->mutable_frame();
  if (frame.has_floaters_predicted()) {
    if (!floaters_) floaters_ = std::make_unique<PackedFloaterDecoder>();
    if (!floaters_->decode(frame)) return false;
  } else if ((!frame.has_surface_predicted() && !frame.has_foam_predicted()) || history_->read(frame)) {
    return false;
  }
  frame.clear_payload();
  head_ = std::move(frame);
  return true;
}

core::SharedBytes FrameKeeper::keyframe() {
  if (!head_) return nullptr;
  v1::ServerMessage message;
  v1::LayerFrame& frame = *message.mutable_frame() = *head_;
  core::Bytes payload;
  if (frame.has_floaters_predicted()) {
    frame.mutable_floaters_predicted()->clear_motion_weight();
    payload = floaters_->keyframePayload();
  } else {
    const PlaneRow& planes = history_->memory.row();
    const auto planeOf = [&](const std::int16_t* (PlaneRow::*row)(std::size_t) const) {
      SurfacePlane out;
      out.resize(history_->extents.count);
      out.assign(std::span<const std::int16_t>(valuesOf<std::int16_t>(planes, row)));
      return out;
    };
    ResidualEncoder residuals;
    PlaneChainEncoder::Form form =
        PlaneChainEncoder::keyframeOf(planeOf(&PlaneRow::row), planeOf(&PlaneRow::earlierRow), residuals);
    const auto setWeights = [&](auto& header) {
      header.mutable_weights()->Assign(form.weights.of.begin(), form.weights.of.end());
      header.mutable_earlier_weights()->Assign(form.earlier_weights.of.begin(), form.earlier_weights.of.end());
    };
    if (frame.has_surface_predicted())
      setWeights(*frame.mutable_surface_predicted());
    else
      setWeights(*frame.mutable_foam_predicted());
    payload = std::move(form.payload);
  }
  frame.set_keyframe(true);
  frame.clear_base_tick();
  frame.set_crc32c(core::crc32c(payload));
  frame.set_payload(payload.data(), payload.size());
  return serialized(message);
}

}  // namespace spindrift::codec
