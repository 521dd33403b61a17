// Encoder and decoder of packed objects in the water: FloatersPredicted in wire.proto.
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include <spindrift/bitstream/decode/floater_reader.h>
#include <spindrift/codec/frame_decoder.h>
#include <spindrift/core/text.h>

#include "layer_encoders.h"
#include "packed_payload.h"

namespace spindrift::codec {
namespace {

/// Indexed by core::Level. A rotation by one unit moves the ends of an object of half a metre by about a quantum.
constexpr std::array<FloaterScale, core::kLevelCount> kScales{{{0.008, 8}, {0.004, 9}, {0.002, 10}, {0.001, 11}}};

core::SharedBytes message(const core::FrameView& frame, core::Level level, std::optional<std::uint64_t> base_tick,
                          std::uint32_t motion_weight, const std::optional<core::Bytes>& payload) {
  if (!payload) return nullptr;
  const FloaterScale& scale = kScales[core::indexOf(level)];
  v1::LayerFrame codec;
  v1::FloatersPredicted& header = *codec.mutable_floaters_predicted();
  header.set_count(frame.floaters->count);
  header.set_quantum_m(scale.quantum_m);
  header.set_rotation_bits(scale.rotation_bits);
  if (base_tick) header.set_motion_weight(motion_weight);
  return serializeFrame(frame, v1::LAYER_FLOATERS, level, base_tick, codec, *payload);
}

}  // namespace

EncodedFrame PackedFloaters::encode(const core::FrameView& frame, core::Level level, bool wants_keyframe) {
  if (!frame.floaters) return {};
  const FloaterChainEncoder::Forms forms =
      chain_.encode(frame.floaters->words, kScales[core::indexOf(level)], wants_keyframe);
  EncodedFrame out{.keyframe = message(frame, level, std::nullopt, 0, forms.keyframe),
                   .delta = message(frame, level, tick_, forms.motion_weight, forms.delta)};
  tick_ = frame.tick;
  return out;
}

/// The frame that a client has decoded, and its header.
struct PackedFloaterDecoder::History {
  FloaterReader reader;
  v1::Level level = v1::LEVEL_FULL;
  double quantum_m = 0.0;
  std::uint32_t rotation_bits = 0;
  std::uint64_t tick = 0;

  std::optional<core::Error> read(const v1::LayerFrame& frame) {
    const v1::FloatersPredicted& header = frame.floaters_predicted();
    if (auto error = checkCount(header.count(), kBodyMaxCount)) return error;
    if (auto error = checkRange("quantum_m", header.quantum_m(), kFloaterMinQuantum_m)) return error;
    if (header.quantum_m() > kFloaterMaxQuantum_m)
      return invalid("quantum_m: " + core::formatNumber(header.quantum_m()) + " is above " +
                     core::formatNumber(kFloaterMaxQuantum_m));
    if (!FloaterReader::isAllowed(header.count(), header.rotation_bits(), header.motion_weight()))
      return invalid("rotation_bits: " + std::to_string(header.rotation_bits()) + " is not from " +
                     std::to_string(kRotationMinBits) + " to " + std::to_string(kRotationMaxBits) +
                     ", or motion_weight: " + std::to_string(header.motion_weight()) + " is above " +
                     std::to_string(kMotionWeightMax));
    if (auto error = checkFrame(frame, v1::LAYER_FLOATERS)) return error;
    const PackedPayload payload(viewOf(frame.payload()));
    bool is_read = false;
    if (frame.keyframe()) {
      is_read = reader.readKeyframe(payload.data(), payload.size(), header.count(), header.rotation_bits());
    } else {
      if (!reader.hasList() || frame.base_tick() != tick || frame.level() != level || header.quantum_m() != quantum_m ||
          header.rotation_bits() != rotation_bits) {
        return core::unavailable("base_tick: the frame builds on tick " + std::to_string(frame.base_tick()) +
                                 ", which is not here: subscribe again for a keyframe");
      }
      is_read = reader.readDelta(payload.data(), payload.size(), header.count(), header.rotation_bits(),
                                 header.motion_weight());
    }
    if (!is_read)
      return invalid("payload: it does not hold " + std::to_string(header.count()) + " objects; the frame is damaged");
    level = frame.level();
    quantum_m = header.quantum_m();
    rotation_bits = header.rotation_bits();
    tick = frame.tick();
    return std::nullopt;
  }
};

PackedFloaterDecoder::PackedFloaterDecoder() : history_(std::make_unique<History>()) {}
PackedFloaterDecoder::~PackedFloaterDecoder() = default;

core::Result<std::vector<FloaterSample>> PackedFloaterDecoder::decode(const v1::LayerFrame& frame) {
  if (!frame.has_floaters_predicted()) return invalid("codec: not floaters_predicted");
  if (auto error = history_->read(frame)) {
    history_->reader.forget();
    return *error;
  }
  const FloaterList& list = history_->reader.list();
  std::vector<FloaterSample> out(list.count);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const FloaterRecord& record = list.records[i];
    FloaterSample& sample = out[i];
    sample.floater_id = record.id;
    for (std::size_t axis = 0; axis < 3; ++axis) sample.position_m[axis] = record.place[axis] * history_->quantum_m;
    double square = 0.0;
    for (const std::int16_t part : record.turn) square += static_cast<double>(part) * part;
    for (std::size_t part = 0; part < 4; ++part) sample.rotation[part] = record.turn[part] / std::sqrt(square);
    sample.size_m = record.size_cm / 100.0;
    sample.kind = floaterKindOf(record.kind);
    sample.is_held = (record.flags & 1u) != 0;
  }
  return out;
}

core::Bytes PackedFloaterDecoder::keyframePayload() const {
  ResidualEncoder residuals;
  return FloaterChainEncoder::keyframeOf(history_->reader.list(), residuals);
}

}  // namespace spindrift::codec
