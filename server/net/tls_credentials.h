// The server's certificate and key over time: read at the start, and again when the files change.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <spindrift/core/result.h>
#include <spindrift/net/server.h>

namespace spindrift::net {

struct TlsContext;

/// Thread-safe. A connection keeps the context that it began with.
class TlsCredentials {
 public:
  /// Errors: those of TlsContext::forServer().
  static core::Result<std::unique_ptr<TlsCredentials>> load(const TlsFiles& files);

  [[nodiscard]] std::shared_ptr<TlsContext> context() const;
  /// When the first certificate of the chain in use expires.
  [[nodiscard]] std::chrono::system_clock::time_point expires() const;
  /// Reads the files. If they cannot be used, the reason is logged and the context stays.
  void reload();
  /// Call every few seconds. Reloads when the files have changed since they were read and stand still since the last
  /// call: certificate and key are written one after the other.
  void reloadIfChanged();
  [[nodiscard]] std::uint64_t reloadCount() const { return reload_count_; }
  [[nodiscard]] std::uint64_t failureCount() const { return failure_count_; }

 private:
  explicit TlsCredentials(TlsFiles files) : files_(std::move(files)) {}

  /// Tells whether a file has changed. It may be a link that was set to another file.
  struct Stamp {
    std::uint64_t inode = 0;
    std::int64_t size_bytes = -1;
    std::int64_t modified_ns = 0;
    bool operator==(const Stamp&) const = default;
  };
  using Stamps = std::array<Stamp, 2>;
  static Stamp stampOf(const std::string& file);
  Stamps stamps() const { return {stampOf(files_.certificate_file), stampOf(files_.key_file)}; }

  const TlsFiles files_;
  mutable std::mutex mutex_;  ///< of context_
  std::shared_ptr<TlsContext> context_;
  std::mutex reload_mutex_;  ///< of the stamps; one reload at a time
  Stamps read_{};            ///< of the files when they were read last
  Stamps seen_{};            ///< at the last call of reloadIfChanged()
  std::atomic<std::uint64_t> reload_count_{0};
  std::atomic<std::uint64_t> failure_count_{0};
};

}  // namespace spindrift::net
