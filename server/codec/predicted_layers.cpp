// Encoder and decoder of packed planes: SurfacePredicted and FoamPredicted in wire.proto.
#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <spindrift/codec/frame_decoder.h>
#include <spindrift/codec/frame_encoder.h>
#include <spindrift/core/crc32c.h>

#include "encode/plane_chain.h"
#include "frame_checks.h"
#include "frame_message.h"
#include "layer_codec.h"
#include "packed_payload.h"

namespace spindrift::codec {
namespace {

/// Writes the forms of a plane as messages; `headerOf` returns a LayerFrame with the codec's member but without
/// weights.
class PlaneMessages {
 public:
  template <typename Header>
  EncodedFrame encode(const core::FrameView& frame, v1::Layer layer, core::Level level, bool wants_keyframe,
                      Header header_of) {
    const PlaneChainEncoder::Forms forms = chain_.encode(wants_keyframe);
    const auto message = [&](const std::optional<PlaneChainEncoder::Form>& form,
                             std::optional<std::uint64_t> base_tick) -> core::SharedBytes {
      if (!form) return nullptr;
      v1::LayerFrame codec;
      auto& header = header_of(codec);
      header.mutable_weights()->Add(form->weights.of.begin(), form->weights.of.end());
      if (!base_tick)
        header.mutable_earlier_weights()->Add(form->earlier_weights.of.begin(), form->earlier_weights.of.end());
      return serializeFrame(frame, layer, level, base_tick, codec, form->payload);
    };
    EncodedFrame out{.keyframe = message(forms.keyframe, std::nullopt), .delta = message(forms.delta, tick_)};
    tick_ = frame.tick;
    return out;
  }
  void restart() { chain_.restart(); }
  /// The plane that encode() encodes next.
  SurfacePlane& plane() { return chain_.next(); }

 private:
  PlaneChainEncoder chain_;
  std::uint64_t tick_ = 0;  ///< of the newest encoded plane
};

class SurfacePredictedCodec final : public LayerCodec {
 public:
  EncodedFrame encode(const core::FrameView& frame, core::Level level, bool wants_keyframe) override {
    if (!frame.at(level).surface) return {};
    const core::SurfaceView& surface = *frame.at(level).surface;
    const PlaneExtents extents{surface.count, surface.length_m, surface.width_m};
    if (extents_ != extents || quantum_m_ != surface.quantum_m) messages_.restart();
    extents_ = extents;
    quantum_m_ = surface.quantum_m;
    messages_.plane().resize(surface.count);
    messages_.plane().assign(
        std::span(reinterpret_cast<const std::int16_t*>(surface.words.data()), surface.count.total()));
    return messages_.encode(frame, v1::LAYER_SURFACE, level, wants_keyframe,
                            [&](v1::LayerFrame& codec) -> v1::SurfacePredicted& {
                              v1::SurfacePredicted& header = *codec.mutable_surface_predicted();
                              setExtents(extents, header);
                              header.set_quantum_m(surface.quantum_m);
                              return header;
                            });
  }

 private:
  PlaneMessages messages_;
  PlaneExtents extents_;
  double quantum_m_ = 0.0;
};

class FoamPredictedCodec final : public LayerCodec {
 public:
  EncodedFrame encode(const core::FrameView& frame, core::Level level, bool wants_keyframe) override {
    if (!frame.at(level).foam) return {};
    const core::FoamView& foam = *frame.at(level).foam;
    const PlaneExtents extents{foam.count, foam.length_m, foam.width_m};
    if (extents_ != extents) messages_.restart();
    extents_ = extents;
    messages_.plane().resize(foam.count);
    messages_.plane().assign(std::span(reinterpret_cast<const std::uint8_t*>(foam.words.data()), foam.count.total()));
    return messages_.encode(frame, v1::LAYER_FOAM, level, wants_keyframe,
                            [&](v1::LayerFrame& codec) -> v1::FoamPredicted& {
                              v1::FoamPredicted& header = *codec.mutable_foam_predicted();
                              setExtents(extents, header);
                              return header;
                            });
  }

 private:
  PlaneMessages messages_;
  PlaneExtents extents_;
};

constexpr double kFoamQuantum = 1.0;

/// False: the number of weights is wrong.
template <typename Field>
bool takeWeights(const Field& field, SurfaceWeights& weights) {
  if (field.size() != static_cast<int>(weights.of.size())) return false;
  std::ranges::copy(field, weights.of.begin());
  return true;
}

}  // namespace

std::unique_ptr<LayerCodec> makeSurfacePredictedCodec() {
  return std::make_unique<SurfacePredictedCodec>();
}
std::unique_ptr<LayerCodec> makeFoamPredictedCodec() {
  return std::make_unique<FoamPredictedCodec>();
}

/// The planes that a client has decoded, and their header values.
struct PackedPlaneDecoder::History {
  PlaneMemory memory;
  PlaneExtents extents;
  double quantum_m = 0.0;
  std::uint64_t tick = 0;

  /// Decodes a frame's plane into `memory`; after an error it holds nothing.
  template <typename Header>
  std::optional<core::Error> read(const v1::LayerFrame& frame, v1::Layer layer, const Header& header,
                                  double header_quantum_m) {
    auto error = check(frame, layer, header, header_quantum_m);
    if (error) memory.row().forget();
    extents = extentsOf(header);
    quantum_m = header_quantum_m;
    tick = frame.tick();
    return error;
  }

 private:
  template <typename Header>
  std::optional<core::Error> check(const v1::LayerFrame& frame, v1::Layer layer, const Header& header,
                                   double header_quantum_m) {
    const PlaneExtents header_extents = extentsOf(header);
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
        return core::Error{core::ErrorCode::kUnavailable, "base_tick: the frame builds on tick " +
                                                              std::to_string(frame.base_tick()) +
                                                              ", which is not here: subscribe again for a keyframe"};
      }
      is_read = row.readDelta(payload.data(), payload.size(), weights);
    }
    if (!is_read) return invalid("payload: its end does not fit its beginning; the frame is damaged");
    return std::nullopt;
  }
};

PackedPlaneDecoder::PackedPlaneDecoder() : history_(std::make_unique<History>()) {}
PackedPlaneDecoder::~PackedPlaneDecoder() = default;

core::Result<SurfaceSamples> PackedSurfaceDecoder::decode(const v1::LayerFrame& frame) {
  if (!frame.has_surface_predicted()) return invalid("codec: not surface_predicted");
  const v1::SurfacePredicted& header = frame.surface_predicted();
  if (auto error = history_->read(frame, v1::LAYER_SURFACE, header, header.quantum_m())) return *error;
  const PlaneExtents& extents = history_->extents;
  SurfaceSamples out{extents.count, extents.length_m, extents.width_m, header.quantum_m(), {}};
  const PlaneRow& plane = history_->memory.row();
  const std::size_t nx = out.count.x;
  const double quantum_m = header.quantum_m();
  out.elevation_m.resize(out.count.total());
  for (std::size_t z = 0; z < out.count.z; ++z) {
    std::transform(plane.row(z), plane.row(z) + nx, out.elevation_m.begin() + static_cast<std::ptrdiff_t>(z * nx),
                   [quantum_m](std::int16_t sample) { return static_cast<float>(sample * quantum_m); });
  }
  return out;
}

bool PlaneKeeper::take(core::ByteView message) {
  has_frame_ = false;
  auto parsed = parseServerMessage(message);
  if (!parsed || !parsed->has_frame()) return false;
  v1::LayerFrame& frame = *parsed->mutable_frame();
  std::optional<core::Error> error;
  if (frame.has_surface_predicted()) {
    const v1::SurfacePredicted& header = frame.surface_predicted();
    error = history_->read(frame, v1::LAYER_SURFACE, header, header.quantum_m());
  } else if (frame.has_foam_predicted()) {
    error = history_->read(frame, v1::LAYER_FOAM, frame.foam_predicted(), kFoamQuantum);
  } else {
    return false;
  }
  if (error) return false;
  frame.clear_payload();
  head_ = std::move(frame);
  has_frame_ = true;
  return true;
}

core::SharedBytes PlaneKeeper::keyframe() {
  if (!has_frame_) return nullptr;
  const PlaneRow& planes = history_->memory.row();
  const auto planeOf = [&](const std::int16_t* (PlaneRow::*row)(std::size_t) const) {
    std::vector<std::int16_t> samples;
    samples.reserve(planes.countX() * planes.countZ());
    for (std::size_t z = 0; z < planes.countZ(); ++z) {
      const std::int16_t* const first = (planes.*row)(z);
      samples.insert(samples.end(), first, first + planes.countX());
    }
    SurfacePlane out;
    out.resize(history_->extents.count);
    out.assign(std::span<const std::int16_t>(samples));
    return out;
  };
  ResidualEncoder residuals;
  const PlaneChainEncoder::Form form =
      PlaneChainEncoder::keyframeOf(planeOf(&PlaneRow::row), planeOf(&PlaneRow::earlierRow), residuals);
  v1::ServerMessage message;
  v1::LayerFrame& frame = *message.mutable_frame() = head_;
  const auto setWeights = [&](auto& header) {
    header.mutable_weights()->Assign(form.weights.of.begin(), form.weights.of.end());
    header.mutable_earlier_weights()->Assign(form.earlier_weights.of.begin(), form.earlier_weights.of.end());
  };
  if (frame.has_surface_predicted())
    setWeights(*frame.mutable_surface_predicted());
  else
    setWeights(*frame.mutable_foam_predicted());
  frame.set_keyframe(true);
  frame.clear_base_tick();
  frame.set_crc32c(core::crc32c(form.payload));
  frame.set_payload(form.payload.data(), form.payload.size());
  core::Bytes bytes(message.ByteSizeLong());
  message.SerializeWithCachedSizesToArray(bytes.data());
  return core::share(std::move(bytes));
}

core::Result<FoamSamples> PackedFoamDecoder::decode(const v1::LayerFrame& frame) {
  if (!frame.has_foam_predicted()) return invalid("codec: not foam_predicted");
  const v1::FoamPredicted& header = frame.foam_predicted();
  if (auto error = history_->read(frame, v1::LAYER_FOAM, header, kFoamQuantum)) return *error;
  const PlaneExtents& extents = history_->extents;
  FoamSamples out{extents.count, extents.length_m, extents.width_m, {}};
  const PlaneRow& plane = history_->memory.row();
  const std::size_t nx = out.count.x;
  out.foam.resize(out.count.total());
  for (std::size_t z = 0; z < out.count.z; ++z) {
    std::transform(plane.row(z), plane.row(z) + nx, out.foam.begin() + static_cast<std::ptrdiff_t>(z * nx),
                   [](std::int16_t sample) { return static_cast<std::uint8_t>(std::clamp<int>(sample, 0, 255)); });
  }
  return out;
}

}  // namespace spindrift::codec
