#include "parts.h"

#include <algorithm>

#include <boost/endian/conversion.hpp>

namespace spindrift::bus {

void writePartHead(const PartHead& head, std::uint8_t* out) {
  boost::endian::store_little_u64(out, head.message);
  boost::endian::store_little_u32(out + 8, head.part);
  boost::endian::store_little_u32(out + 12, head.part_count);
}

std::optional<PartHead> readPartHead(core::ByteView part) {
  if (part.size() < kPartHeadBytes) return std::nullopt;
  const PartHead head{boost::endian::load_little_u64(part.data()), boost::endian::load_little_u32(part.data() + 8),
                      boost::endian::load_little_u32(part.data() + 12)};
  if (head.part_count == 0 || head.part_count > kPartMaxCount || head.part >= head.part_count) return std::nullopt;
  return head;
}

std::optional<core::ByteView> PartCollector::take(core::ByteView part, std::uint64_t& lost) {
  const auto head = readPartHead(part);
  if (!head) {
    ++lost;
    return std::nullopt;
  }
  const core::ByteView content = part.subspan(kPartHeadBytes);
  if (head->part_count == 1) return content;
  auto open = std::ranges::find(open_, head->message, &Open::message);
  if (head->part == 0 && open == open_.end()) {
    if (open_.size() == kOpenMaxCount) {
      open_.pop_front();
      ++lost;
    }
    open = open_.insert(open_.end(), {.message = head->message, .part_count = head->part_count});
  }
  if (open == open_.end()) return std::nullopt;  // its first part was lost, which was counted then
  if (head->part != open->next_part || head->part_count != open->part_count || content.size() > kPartMaxBytes) {
    open_.erase(open);
    ++lost;
    return std::nullopt;
  }
  open->bytes.insert(open->bytes.end(), content.begin(), content.end());
  if (++open->next_part < open->part_count) return std::nullopt;
  complete_ = std::move(open->bytes);
  open_.erase(open);
  return complete_;
}

}  // namespace spindrift::bus
