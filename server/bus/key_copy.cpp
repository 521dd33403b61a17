#include "key_copy.h"

#include <algorithm>

namespace spindrift::bus {

bool KeyCopy::put(const std::string& key, core::ByteView value, std::uint64_t revision) {
  complete(revision);
  return wrote(key, value, revision);
}

bool KeyCopy::wrote(const std::string& key, core::ByteView value, std::uint64_t revision) {
  const auto known = values_.find(key);
  if (known != values_.end() && known->second.revision >= revision) return true;  // older than this process's own write
  if (value.size() > kValueMaxBytes || (known == values_.end() && values_.size() >= kKeyMaxCount)) {
    if (known != values_.end()) values_.erase(known);  // no value is better than one that is not valid any more
    return false;
  }
  values_[key] = {core::Bytes(value.begin(), value.end()), revision};
  return true;
}

void KeyCopy::remove(const std::string& key, std::uint64_t revision) {
  complete(revision);
  const auto known = values_.find(key);
  if (known != values_.end() && known->second.revision < revision) values_.erase(known);
}

void KeyCopy::complete(std::uint64_t revision) {
  revision_ = std::max(revision_, revision);
}

}  // namespace spindrift::bus
