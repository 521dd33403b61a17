#include "record_bytes.h"

namespace spindrift::mcap {

RecordBytes& RecordBytes::number(std::uint64_t value, int byte_count) {
  for (int k = 0; k < byte_count; ++k) out_.push_back(static_cast<std::uint8_t>(value >> (8 * k)));
  return *this;
}

void RecordBytes::set(std::size_t at, std::uint64_t value, int byte_count) {
  for (int k = 0; k < byte_count; ++k)
    out_[at + static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(value >> (8 * k));
}

RecordBytes& RecordBytes::bytes(core::ByteView bytes) {
  out_.insert(out_.end(), bytes.begin(), bytes.end());
  return *this;
}

RecordBytes& RecordBytes::text(std::string_view text) {
  u32(static_cast<std::uint32_t>(text.size()));
  out_.insert(out_.end(), text.begin(), text.end());
  return *this;
}

RecordBytes& RecordBytes::map(const std::map<std::string, std::string>& values) {
  const std::size_t at = out_.size();
  u32(0);
  for (const auto& [name, value] : values) text(name).text(value);
  set(at, out_.size() - at - 4, 4);
  return *this;
}

RecordBytes& RecordBytes::begin(Opcode opcode) {
  u8(static_cast<std::uint8_t>(opcode)).u64(0);
  content_ = out_.size();
  return *this;
}

void RecordBytes::end() {
  set(content_ - 8, out_.size() - content_, 8);
}

}  // namespace spindrift::mcap
