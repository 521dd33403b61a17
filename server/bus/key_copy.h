// The copy of a bucket, made of what its watch tells.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <spindrift/bus/key_values.h>
#include <spindrift/core/bytes.h>

namespace spindrift::bus {

/// Bounded: at most kKeyMaxCount keys with values of at most kValueMaxBytes.
class KeyCopy {
 public:
  static constexpr std::size_t kKeyMaxCount = 10'000;
  static constexpr std::size_t kValueMaxBytes = 4 * 1024;

  /// The watch tells of a value. It tells all changes of the bucket in the order of their revisions. Returns false if
  /// the value was left out, because it is beyond the limits.
  bool put(const std::string& key, core::ByteView value, std::uint64_t revision);
  /// The watch tells that the key was removed.
  void remove(const std::string& key, std::uint64_t revision);
  /// This process wrote the value: the watch will tell it, too, perhaps after older changes. Returns as put().
  bool wrote(const std::string& key, core::ByteView value, std::uint64_t revision);
  /// The watch has told all changes up to this one.
  void complete(std::uint64_t revision);

  /// The newest revision up to which all changes were told.
  [[nodiscard]] std::uint64_t revision() const { return revision_; }
  [[nodiscard]] const KeyValueMap& values() const { return values_; }

 private:
  KeyValueMap values_;
  std::uint64_t revision_ = 0;
};

}  // namespace spindrift::bus
