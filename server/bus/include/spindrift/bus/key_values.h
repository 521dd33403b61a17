// A NATS key-value bucket (JetStream): small values that all processes agree on, each change made on top of a known
// revision.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include <spindrift/bus/bus.h>
#include <spindrift/core/bytes.h>
#include <spindrift/core/result.h>

namespace spindrift::bus {

struct KeyValue {
  core::Bytes value;
  std::uint64_t revision = 0;
};

/// Each call is a round trip and blocks for at most two seconds: not for handlers of the bus. One thread at a time.
class KeyValues {
 public:
  /// Opens the bucket, or makes it. `bus` outlives it. Error kUnavailable also when the NATS server runs without
  /// JetStream.
  static core::Result<std::unique_ptr<KeyValues>> open(Bus& bus, const std::string& bucket);
  virtual ~KeyValues() = default;

  virtual core::Result<std::map<std::string, KeyValue>> all() = 0;
  /// Sets the value if its revision is still this one; 0: if there is no such key. Returns the new revision; nullopt if
  /// another process was faster.
  virtual core::Result<std::optional<std::uint64_t>> set(const std::string& key, core::ByteView value,
                                                         std::uint64_t revision) = 0;
  virtual core::Result<void> remove(const std::string& key) = 0;
};

}  // namespace spindrift::bus
