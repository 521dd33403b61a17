// Frames out of encoded messages, and frames that a decoder has to refuse.
#pragma once

#include <functional>
#include <random>
#include <vector>

#include <gmock/gmock.h>

#include <spindrift/codec/frame_decoder.h>
#include <spindrift/core/bytes.h>
#include <spindrift/core/crc32c.h>

namespace spindrift::codec {

inline v1::LayerFrame frameOf(const core::SharedBytes& bytes) {
  if (!bytes) {
    ADD_FAILURE() << "nothing encoded";
    return {};
  }
  const auto message = parseServerMessage(*bytes);
  EXPECT_TRUE(message) << message.error().message;
  return message ? message->frame() : v1::LayerFrame();
}

/// Recomputes the checksum, so that the check under test is reached.
inline void seal(v1::LayerFrame& frame) {
  frame.set_crc32c(
      core::crc32c({reinterpret_cast<const std::uint8_t*>(frame.payload().data()), frame.payload().size()}));
}

struct DamagedFrame {
  const char* name;
  std::function<void(v1::LayerFrame&)> damage;
  const char* must_hold;  ///< in the error
  bool reseal = true;
};

/// `decode` takes the good frame and refuses each of the damaged ones as invalid input.
template <typename Decode>
void expectRefusals(const v1::LayerFrame& good, const std::vector<DamagedFrame>& cases, Decode decode) {
  ASSERT_TRUE(decode(good));
  for (const DamagedFrame& bad : cases) {
    v1::LayerFrame frame = good;
    bad.damage(frame);
    if (bad.reseal) seal(frame);
    const auto result = decode(frame);
    ASSERT_FALSE(result) << bad.name;
    EXPECT_EQ(result.error().code, core::ErrorCode::kInvalidInput) << bad.name;
    EXPECT_THAT(result.error().message, testing::HasSubstr(bad.must_hold)) << bad.name;
  }
}

/// The frame with up to eight other bytes in its payload, and sometimes with `change`; with its checksum.
inline v1::LayerFrame scrambled(v1::LayerFrame frame, std::mt19937& random,
                                const std::function<void(v1::LayerFrame&)>& change) {
  std::string& payload = *frame.mutable_payload();
  for (std::uint32_t i = 0, count = 1 + random() % 8; i < count; ++i)
    payload[random() % payload.size()] = static_cast<char>(random());
  if (random() % 4 == 0) change(frame);
  seal(frame);
  return frame;
}

}  // namespace spindrift::codec
