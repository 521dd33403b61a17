// A NATS key-value bucket (JetStream): small values that all processes agree on, each change made on top of a known
// revision. This process keeps a copy of the bucket, which a watch keeps up to date: reading costs NATS nothing.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include <spindrift/bus/bus.h>
#include <spindrift/core/bytes.h>
#include <spindrift/core/result.h>

namespace spindrift::bus {

struct KeyValue {
  core::Bytes value;
  std::uint64_t revision = 0;
};

using KeyValueMap = std::map<std::string, KeyValue>;

/// Calls with a round trip block for a few seconds at most: not for handlers of the bus. One thread at a time.
/// A bucket that is gone, because NATS lost its data, is made anew, empty. Errors are kUnavailable.
class KeyValues {
 public:
  /// Opens the bucket, or makes it. `bus` outlives it. Error also when the NATS server runs without JetStream.
  static core::Result<std::unique_ptr<KeyValues>> open(Bus& bus, const std::string& bucket);
  virtual ~KeyValues() = default;

  /// Returns the copy: what others wrote lately may be missing. Most calls make no round trip. Error while there is no
  /// connection. Keys and values beyond the limits of server/bus/key_copy.h are left out.
  virtual core::Result<KeyValueMap> copy() = 0;
  /// Returns what the bucket contains now: everything written before the call. One round trip.
  virtual core::Result<KeyValueMap> all() = 0;
  /// Sets the value if its revision is still this one; 0: if there is no such key. Returns the new revision; 0 if
  /// another process was faster.
  virtual core::Result<std::uint64_t> set(const std::string& key, core::ByteView value, std::uint64_t revision) = 0;
  virtual core::Result<void> remove(const std::string& key) = 0;
};

}  // namespace spindrift::bus
