// The built web client: each file is read from disc once and cached until its modification time or size changes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_map>

namespace spindrift::net {

struct StaticFile {
  std::string content;
  std::string content_type;
  std::string etag;        ///< quoted; changes with the size or the modification time
  bool immutable = false;  ///< under /assets/, where file names contain a hash of the content
};

/// Thread-safe. Serves only regular files inside one folder: no "..", no hidden files, no links that lead outside.
class StaticFiles {
 public:
  /// `web_root` empty or missing: no file is found.
  explicit StaticFiles(const std::string& web_root);

  /// Returns the file for a decoded path ("/" = /index.html), or null if there is none that may be served.
  std::shared_ptr<const StaticFile> find(std::string_view path);

  /// Larger files are not served: a web client has none.
  static constexpr std::uintmax_t kMaxFileBytes = 64U << 20U;

 private:
  struct Entry {
    std::shared_ptr<const StaticFile> file;
    std::filesystem::file_time_type modified;
    std::uintmax_t size_bytes = 0;
  };

  std::filesystem::path root_;  ///< canonical; empty = no files
  std::mutex mutex_;
  std::unordered_map<std::string, Entry> cache_;
  std::uintmax_t cached_bytes_ = 0;
};

/// Returns the Content-Type by the file name's extension; application/octet-stream for unknown ones.
std::string contentType(std::string_view file_name);

}  // namespace spindrift::net
