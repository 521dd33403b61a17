#include "parts.h"

#include <algorithm>

namespace spindrift::bus {
namespace {

template <typename Number>
void write(Number value, std::uint8_t* out) {
  for (std::size_t k = 0; k < sizeof(Number); ++k) out[k] = static_cast<std::uint8_t>(value >> (8 * k));
}

template <typename Number>
Number read(const std::uint8_t* bytes) {
  Number value = 0;
  for (std::size_t k = 0; k < sizeof(Number); ++k) value |= static_cast<Number>(Number{bytes[k]} << (8 * k));
  return value;
}

}  // namespace

void writePartHead(const PartHead& head, std::uint8_t* out) {
  write(head.message, out);
  write(head.part, out + 8);
  write(head.part_count, out + 12);
}

std::optional<PartHead> readPartHead(core::ByteView part) {
  if (part.size() < kPartHeadBytes) return std::nullopt;
  const PartHead head{read<std::uint64_t>(part.data()), read<std::uint32_t>(part.data() + 8),
                      read<std::uint32_t>(part.data() + 12)};
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
