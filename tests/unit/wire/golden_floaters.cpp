// Objects in the water: a frame with two of them, the answer to a spawn, and what a client has to refuse.
#include <cstdio>
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

std::string floatersJson(const v1::LayerFrame& frame) {
  const auto samples = codec::decodeFloaters(frame);
  std::string text =
      "\"kind\": \"frame\", \"layer\": \"LAYER_FLOATERS\", \"tick\": \"1234\", \"time_s\": 20.5, \"keyframe\": true, "
      "\"crc32c\": " +
      std::to_string(frame.crc32c()) + ", \"count\": 2,\n    \"floaters\": [";
  for (const codec::FloaterSample& floater : *samples) {
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
      {"floaters_2.bin", GoldenVerdict::kOk, floatersJson(good.frame()), bytes},
      {"ack_floater.bin", GoldenVerdict::kOk,
       "\"kind\": \"ack\", \"command_id\": \"303\", \"applied_tick\": \"1234\", \"floater_id\": 9",
       *ack(test::ackOf(303, 1234, 0, 9))}};
  const auto bad = [&](const char* file, const char* why, void (*damage)(v1::LayerFrame&)) {
    v1::ServerMessage message = good;
    v1::LayerFrame& frame = *message.mutable_frame();
    damage(frame);
    frame.set_crc32c(core::crc32c(core::viewOf(frame.payload())));
    core::Bytes damaged_bytes(message.ByteSizeLong());
    message.SerializeWithCachedSizesToArray(damaged_bytes.data());
    cases.push_back(
        {file, GoldenVerdict::kBadFrame, std::string("\"why\": \"") + why + "\"", std::move(damaged_bytes)});
  };
  bad("bad_floaters_truncated.bin", "the last object is cut short, checksum of what is there",
      [](v1::LayerFrame& f) { f.mutable_payload()->resize(54); });
  bad("bad_floaters_count_huge.bin", "count whose size in bytes wraps to the payload's in 32 bits",
      [](v1::LayerFrame& f) { f.mutable_floaters_fixed28()->set_count(0x4000'0002u); });
  bad("bad_floaters_layer.bin", "the codec of another layer",
      [](v1::LayerFrame& f) { f.mutable_bodies_fixed28()->set_count(2); });
  return cases;
}

}  // namespace spindrift::wire
