// The built web client, read from disc once and kept while its modification time and size stay.
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
  std::string etag;        ///< quoted; changes with size or modification time
  bool immutable = false;  ///< under /assets/, where the file name carries a hash of the content
};

/// Thread-safe. Serves regular files inside one folder and nothing else: no "..", no hidden files, no links that lead
/// out.
class StaticFiles {
 public:
  /// `web_root` empty or missing = there are no files.
  explicit StaticFiles(const std::string& web_root);

  /// The file for a decoded path ("/" = /index.html), or null if there is none that may be served.
  std::shared_ptr<const StaticFile> find(std::string_view path);

  /// One file larger than this is not served: it has no place in a web client.
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

/// The Content-Type for a file name, by its extension; application/octet-stream for unknown ones.
std::string contentType(std::string_view file_name);

}  // namespace spindrift::net
