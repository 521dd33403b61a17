// Objects in the water: a frame with two of them, the answer to a spawn, a row of packed frames, and what a client has
// to refuse.
#include <cstdio>
#include <span>
#include <utility>

#include <spindrift/codec/frame_decoder.h>
#include <spindrift/codec/frame_encoder.h>
#include <spindrift/core/crc32c.h>
#include <spindrift/wire/server_message.h>

#include "commands.h"
#include "golden_packed.h"

namespace spindrift::wire {
namespace {

/// A crate at the origin as it stands; a held stone far out, turned by 120 degrees.
core::Bytes floatersBytes() {
  const auto mm = [](std::int32_t value) { return static_cast<std::uint32_t>(value); };
  const std::vector<std::uint32_t> words = {1,
                                            0,
                                            0,
                                            0,
                                            0,
                                            0x7FFF'0000u,
                                            0x0001'003Cu,  // FloaterKind, size in cm
                                            0xFFFF'FFFFu,
                                            mm(12'345),
                                            mm(-250),
                                            mm(-100'000),
                                            0xC000'4000u,
                                            0xC001'4000u,
                                            0x0108'00FFu};
  core::FrameView frame;
  frame.tick = 1234;
  frame.time_s = 20.5;
  frame.floaters = core::FloatersView{2, words};
  return *codec::FrameEncoder().encode(v1::LAYER_FLOATERS, frame);
}

/// Seven objects, of which one goes, others come in its slot and behind the last until there are 70, one is held, one
/// is thrown over 200 m, and all move and turn. Integers only, so that all machines give the same.
std::vector<std::uint32_t> movingWords(std::int32_t step) {
  std::vector<std::uint32_t> words;
  const auto add = [&](std::uint32_t id, std::uint32_t size_cm, std::uint32_t kind, bool is_held) {
    const auto k = static_cast<std::int32_t>(id % 100);
    const auto mm = [](std::int32_t value) { return static_cast<std::uint32_t>(value); };
    words.push_back(id);
    words.push_back(mm(k * 700 + step * (13 + k) + (id == 2 ? step * 100'000 : 0)));
    words.push_back(mm((k % 3 - 1) * step * step * 4 - k));
    words.push_back(mm(-k * 500 - (k % 4) * step));
    // (a, b, 0, c) with a^2 + b^2 + c^2 nearly 32767^2; each third object turns over between the steps.
    const std::uint32_t a = k % 3 == 0 ? 0xC001u : 0x4000u - static_cast<std::uint32_t>(step) * 8;
    const std::uint32_t b = k % 3 == 0 && step == 1 ? 0x93C0u : 0x6C40u, c = 0x163Cu;
    words.push_back(a | b << 16);
    words.push_back(k % 2 == 0 ? c << 16 : c);
    words.push_back(size_cm | kind << 16 | (is_held ? 1u << 24 : 0u));
  };
  for (std::uint32_t id = 1; id <= 7; ++id) {
    if (id == 4 && step > 0)
      add(4'000'000'004u, 55, 8, false);
    else
      add(id, 30 + id * 10, id, id == 6 && step == 1);
  }
  if (step == 2) {
    for (std::uint32_t id = 8; id <= 70; ++id) add(id, 40, 2, false);
  }
  return words;
}

std::string floatersJson(const v1::LayerFrame& frame, std::span<const codec::FloaterSample> samples,
                         const std::string& more) {
  std::string text = "\"kind\": \"frame\", \"layer\": \"LAYER_FLOATERS\", \"tick\": \"" + std::to_string(frame.tick()) +
                     "\", \"time_s\": 20.5, \"keyframe\": " + (frame.keyframe() ? "true" : "false") +
                     ", \"crc32c\": " + std::to_string(frame.crc32c()) + more +
                     ", \"count\": " + std::to_string(samples.size()) + ",\n    \"floaters\": [";
  for (const codec::FloaterSample& floater : samples) {
    if (text.back() != '[') text += ",\n      ";
    char size[40];
    std::snprintf(size, sizeof size, "%.9g", floater.size_m);
    text += "{\"floater_id\": " + std::to_string(floater.floater_id) +
            ", \"position_m\": " + numbersOf(floater.position_m) + ", \"rotation\": " + numbersOf(floater.rotation) +
            ", \"size_m\": " + size + ", \"kind\": \"" + v1::FloaterKind_Name(floater.kind) +
            "\", \"is_held\": " + (floater.is_held ? "true" : "false") + "}";
  }
  return text + "]";
}

}  // namespace

std::vector<GoldenCase> goldenFloaters() {
  const core::Bytes bytes = floatersBytes();
  const v1::ServerMessage good = *codec::parseServerMessage(bytes);
  std::vector<GoldenCase> cases = {
      {"floaters_2.bin", GoldenVerdict::kOk, floatersJson(good.frame(), *codec::decodeFloaters(good.frame()), ""),
       bytes},
      {"ack_floater.bin", GoldenVerdict::kOk,
       "\"kind\": \"ack\", \"command_id\": \"303\", \"applied_tick\": \"1234\", \"floater_id\": 9",
       *ack(test::ackOf(303, 1234, 0, 9))}};
  const auto damaged = [&](const v1::ServerMessage& whole, const char* file, const char* why,
                           void (*damage)(v1::LayerFrame&)) {
    v1::ServerMessage message = whole;
    v1::LayerFrame& frame = *message.mutable_frame();
    damage(frame);
    frame.set_crc32c(core::crc32c(core::viewOf(frame.payload())));
    core::Bytes damaged_bytes(message.ByteSizeLong());
    message.SerializeWithCachedSizesToArray(damaged_bytes.data());
    cases.push_back(
        {file, GoldenVerdict::kBadFrame, std::string("\"why\": \"") + why + "\"", std::move(damaged_bytes)});
  };
  const auto bad = [&](const char* file, const char* why, void (*damage)(v1::LayerFrame&)) {
    damaged(good, file, why, damage);
  };
  bad("bad_floaters_truncated.bin", "the last object is cut short, checksum of what is there",
      [](v1::LayerFrame& f) { f.mutable_payload()->resize(54); });
  bad("bad_floaters_count_huge.bin", "count whose size in bytes wraps to the payload's in 32 bits",
      [](v1::LayerFrame& f) { f.mutable_floaters_fixed28()->set_count(0x4000'0002u); });
  bad("bad_floaters_layer.bin", "the codec of another layer",
      [](v1::LayerFrame& f) { f.mutable_bodies_fixed28()->set_count(2); });

  codec::FrameEncoder encoder;
  codec::PackedFloaterDecoder decoder;
  v1::ServerMessage key;
  std::string follows;
  for (std::int32_t step = 0; step < 3; ++step) {
    const std::vector<std::uint32_t> words = movingWords(step);
    core::FrameView view;
    view.tick = 100 + 2 * static_cast<std::uint64_t>(step);
    view.time_s = 20.5;
    view.floaters = core::FloatersView{static_cast<std::uint32_t>(words.size() / 7), words};
    const codec::EncodedFrame encoded =
        encoder.encode({v1::LAYER_FLOATERS, v1::PACKING_PACKED}, view, core::Level::kFull, false);
    const core::Bytes& packed = encoded.keyframe ? *encoded.keyframe : *encoded.delta;
    const v1::ServerMessage message = *codec::parseServerMessage(packed);
    if (step == 0) key = message;
    const std::string more = ", \"packing\": \"PACKING_PACKED\",\n    \"follows\": \"" + follows +
                             "\", \"quantum_m\": 0.001, \"rotation_bits\": 11, \"motion_weight\": " +
                             std::to_string(message.frame().floaters_predicted().motion_weight());
    follows = "floaters_packed_" + std::to_string(step) + ".bin";
    cases.push_back(
        {follows, GoldenVerdict::kOk, floatersJson(message.frame(), *decoder.decode(message.frame()), more), packed});
  }
  damaged(key, "bad_floaters_packed_cut.bin", "the packed payload is cut, checksum of what is there",
          [](v1::LayerFrame& f) { f.mutable_payload()->resize(f.payload().size() - 3); });
  damaged(key, "bad_floaters_packed_count.bin", "count says one object more than the payload holds",
          [](v1::LayerFrame& f) { f.mutable_floaters_predicted()->set_count(8); });
  damaged(key, "bad_floaters_packed_quantum.bin", "quantum_m above 0.05",
          [](v1::LayerFrame& f) { f.mutable_floaters_predicted()->set_quantum_m(0.06); });
  damaged(key, "bad_floaters_packed_bits.bin", "rotation_bits above 13",
          [](v1::LayerFrame& f) { f.mutable_floaters_predicted()->set_rotation_bits(14); });
  damaged(key, "bad_floaters_packed_weight.bin", "motion_weight above 512",
          [](v1::LayerFrame& f) { f.mutable_floaters_predicted()->set_motion_weight(513); });
  damaged(key, "bad_floaters_packed_rotation.bin", "parts of a quaternion that are longer than a unit one",
          [](v1::LayerFrame& f) { f.mutable_floaters_predicted()->set_rotation_bits(10); });
  return cases;
}

}  // namespace spindrift::wire
