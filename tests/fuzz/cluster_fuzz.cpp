// What comes over the bus: a byte that says what is tried, then a frame, or parts of messages. Several parts are
// divided by their lengths of two bytes, little endian.
#include <algorithm>
#include <map>
#include <optional>
#include <vector>

#include <spindrift/core/bytes.h>

#include "frame_head.h"
#include "fuzz.h"
#include "parts.h"

namespace spindrift::fuzz {
namespace {

void tryFrame(core::ByteView message) {
  const auto frame = cluster::readFrame(message);
  if (!frame) return;
  must(frame->keyframe.size() == frame->head.keyframe_bytes && frame->delta.size() == frame->head.delta_bytes,
       "the parts of a frame are as long as its head says");
  must(!frame->keyframe.empty() || !frame->delta.empty(), "a frame has a keyframe or a delta");
  const auto head = cluster::toBytes(frame->head);
  core::Bytes again(head.begin(), head.end());
  again.insert(again.end(), frame->keyframe.begin(), frame->keyframe.end());
  again.insert(again.end(), frame->delta.begin(), frame->delta.end());
  must(std::ranges::equal(again, message), "a frame that is read would be written so");
}

struct Part {
  bus::PartHead head;
  core::Bytes content;
};

/// The message of the last parts of one number, if they are all of its parts in order.
std::optional<core::Bytes> wholeAtTheEnd(const std::vector<Part>& parts) {
  const std::uint32_t part_count = parts.back().head.part_count;
  if (parts.size() < part_count) return std::nullopt;
  core::Bytes out;
  for (std::uint32_t k = 0; k < part_count; ++k) {
    const Part& part = parts[parts.size() - part_count + k];
    if (part.head.part != k || part.head.part_count != part_count) return std::nullopt;
    out.insert(out.end(), part.content.begin(), part.content.end());
  }
  return out;
}

void tryParts(core::ByteView input) {
  bus::PartCollector collector;
  std::map<std::uint64_t, std::vector<Part>> parts_of;  ///< by number of the message
  std::uint64_t lost = 0;
  while (input.size() >= 2) {
    const std::size_t length = std::min<std::size_t>(input[0] | input[1] << 8, input.size() - 2);
    const core::ByteView part = input.subspan(2, length);
    input = input.subspan(2 + length);
    const auto head = bus::readPartHead(part);
    const std::uint64_t lost_before = lost;
    const auto message = collector.take(part, lost);
    must(lost <= lost_before + 1, "a part costs at most one message");
    if (!head) {
      must(!message && lost == lost_before + 1, "bytes that are not a part are counted and complete nothing");
      continue;
    }
    core::Bytes again(bus::kPartHeadBytes);
    bus::writePartHead(*head, again.data());
    must(std::ranges::equal(again, part.first(bus::kPartHeadBytes)), "a head that is read would be written so");
    const core::ByteView content = part.subspan(bus::kPartHeadBytes);
    if (head->part_count == 1) {
      must(message && std::ranges::equal(*message, content), "one part is the whole message");
      continue;
    }
    auto& parts = parts_of[head->message];
    parts.push_back({*head, {content.begin(), content.end()}});
    const auto whole = wholeAtTheEnd(parts);
    must(!message || (whole && std::ranges::equal(*message, *whole)), "a message is all of its parts in order");
    must(message || !whole || lost > 0, "a message whose parts all came is complete unless one was given up");
  }
}

}  // namespace
}  // namespace spindrift::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace spindrift;
  if (size == 0) return 0;
  const core::ByteView input(data + 1, size - 1);
  if ((data[0] & 1) == 0)
    fuzz::tryFrame(input);
  else
    fuzz::tryParts(input);
  return 0;
}
