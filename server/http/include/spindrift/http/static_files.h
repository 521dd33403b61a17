// The built web client: each file is read from disc once and cached until its modification time or size changes.
// Compressed files beside it (kContentCodings) are sent in its place to clients that take them.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_map>

namespace spindrift::net {

/// Coding of a static file (RFC 9110 section 12.5.3).
struct ContentCoding {
  std::string_view name;    ///< in Accept-Encoding and Content-Encoding
  std::string_view suffix;  ///< of the compressed file beside the original
};

/// The smallest one first. web-client/scripts/precompress.mjs makes these files.
inline constexpr std::array<ContentCoding, 2> kContentCodings{{{"br", ".br"}, {"gzip", ".gz"}}};

/// Returns the weight of a coding in a list of Accept-Encoding, 0 to 1: that of its own entry, or that of "*"; 0 if
/// there is neither, or if the entry is malformed.
double codingWeight(std::string_view accept_encoding, std::string_view coding);

struct StaticFile {
  std::string content;
  std::string content_type;
  std::string_view coding;  ///< of the content: a name in kContentCodings, or empty
  std::string etag;         ///< quoted; another one for each coding, size and modification time
  std::filesystem::file_time_type modified;
  bool immutable = false;  ///< under /assets/, where file names contain a hash of the content
};

/// Thread-safe. Serves only regular files inside one folder: no "..", no hidden files, no links that lead outside.
class StaticFiles {
 public:
  /// `web_root` empty or missing: no file is found.
  explicit StaticFiles(const std::string& web_root);

  /// Returns the file for a decoded path ("/" = /index.html), or null if no file may be served for it: in the
  /// coding that this list of Accept-Encoding prefers, if there is such a file of this original.
  std::shared_ptr<const StaticFile> find(std::string_view path, std::string_view accept_encoding = "");

  /// Larger files are not served: a web client has none.
  static constexpr std::uintmax_t kMaxFileBytes = 64U << 20U;

 private:
  /// Returns a file in a coding, from the cache if it has not changed; null if no such file may be served.
  std::shared_ptr<const StaticFile> read(const std::string& relative, const ContentCoding& coding);

  std::filesystem::path root_;  ///< canonical; empty = no files
  std::mutex mutex_;
  std::unordered_map<std::string, std::shared_ptr<const StaticFile>> cache_;
  std::uintmax_t cached_bytes_ = 0;
};

/// Returns the Content-Type by the file name's extension; application/octet-stream for unknown ones.
std::string contentType(std::string_view file_name);

}  // namespace spindrift::net
