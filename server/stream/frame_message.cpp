#include "frame_message.h"

#include <cassert>
#include <cstddef>

#include <google/protobuf/io/coded_stream.h>

#include <spindrift/stream/client_message.h>
#include <spindrift/stream/crc32c.h>

namespace spindrift::stream {
namespace {

using google::protobuf::io::CodedOutputStream;

constexpr std::uint32_t kWireFixed32 = 5;
constexpr std::uint32_t kWireLengthDelimited = 2;

constexpr std::uint32_t tagOf(int field_number, std::uint32_t wire_type) {
  return static_cast<std::uint32_t>(field_number) << 3 | wire_type;
}

constexpr std::uint32_t kFrameTag = tagOf(v1::ServerMessage::kFrameFieldNumber, kWireLengthDelimited);
constexpr std::uint32_t kCrcTag = tagOf(v1::LayerFrame::kCrc32CFieldNumber, kWireFixed32);
constexpr std::uint32_t kPayloadTag = tagOf(v1::LayerFrame::kPayloadFieldNumber, kWireLengthDelimited);
static_assert(kFrameTag < 0x80 && kCrcTag < 0x80 && kPayloadTag < 0x80, "tags are written as one byte");
constexpr std::size_t kCrcFieldBytes = 1 + 4;

std::uint8_t* appendMessage(const google::protobuf::MessageLite& message, std::uint8_t* at) {
  return message.SerializeWithCachedSizesToArray(at);
}

}  // namespace

// The payload is written by hand so that it is copied exactly once; serialized pieces of a message may be concatenated,
// and here all but server_time_s and state_id stand in the order of their field numbers.
core::SharedBytes serializeFrame(const core::FrameView& frame, v1::Layer layer, std::optional<std::uint64_t> base_tick,
                                 const v1::LayerFrame& codec, core::ByteView payload) {
  v1::LayerFrame head;
  head.set_layer(layer);
  head.set_tick(frame.tick);
  head.set_time_s(frame.time_s);
  head.set_keyframe(!base_tick);
  head.set_base_tick(base_tick.value_or(0));
  head.set_server_time_s(frame.asked_s);
  head.set_state_id(frame.state_id);
  v1::LayerFrame level;
  level.set_level(toWire(frame.level));

  const auto payload_size = static_cast<std::uint32_t>(payload.size());
  const std::size_t before_payload = head.ByteSizeLong() + kCrcFieldBytes + level.ByteSizeLong() +
                                     codec.ByteSizeLong() + 1 + CodedOutputStream::VarintSize32(payload_size);
  const auto frame_size = static_cast<std::uint32_t>(before_payload + payload_size);
  const std::size_t prefix_size = 1 + CodedOutputStream::VarintSize32(frame_size) + before_payload;

  core::Bytes bytes;
  bytes.reserve(prefix_size + payload_size);
  bytes.resize(prefix_size);
  // The checksum reads the copy: the payload may lie in memory mapped from the device, slow to read twice.
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  const std::uint32_t crc = crc32c(core::ByteView(bytes).subspan(prefix_size));

  std::uint8_t* at = bytes.data();
  *at++ = static_cast<std::uint8_t>(kFrameTag);
  at = CodedOutputStream::WriteVarint32ToArray(frame_size, at);
  at = appendMessage(head, at);
  *at++ = static_cast<std::uint8_t>(kCrcTag);
  at = CodedOutputStream::WriteLittleEndian32ToArray(crc, at);
  at = appendMessage(level, at);
  at = appendMessage(codec, at);
  *at++ = static_cast<std::uint8_t>(kPayloadTag);
  at = CodedOutputStream::WriteVarint32ToArray(payload_size, at);
  assert(at == bytes.data() + prefix_size);
  return core::share(std::move(bytes));
}

}  // namespace spindrift::stream
