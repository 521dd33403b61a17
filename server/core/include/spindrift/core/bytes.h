// Immutable bytes that many readers share: one encoded frame, however many clients receive it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace spindrift::core {

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;
/// Never null where it is passed; never written after it was shared.
using SharedBytes = std::shared_ptr<const Bytes>;

/// Views the text, which must outlive the view.
inline ByteView viewOf(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

inline SharedBytes share(Bytes bytes) {
  return std::make_shared<const Bytes>(std::move(bytes));
}

}  // namespace spindrift::core
