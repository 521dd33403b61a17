#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <chrono>
#include <fstream>
#include <system_error>
#include <utility>

#include <boost/beast/core/string.hpp>
#include <spdlog/spdlog.h>

#include <spindrift/http/static_files.h>

#include "field_list.h"

namespace spindrift::net {
namespace {

namespace fs = std::filesystem;

/// Limit of the cache; further files are read again for each request.
constexpr std::uintmax_t kMaxCacheBytes = 256U << 20U;
/// A copy of the folder may give a compressed file an earlier time than the original. One that is older than this
/// belongs to another original.
constexpr std::chrono::minutes kCopyTime{1};

/// Returns true if no segment is empty, ".", ".." or hidden.
bool plainSegments(std::string_view relative) {
  while (true) {
    const std::size_t slash = relative.find('/');
    const std::string_view segment = relative.substr(0, slash);
    if (segment.empty() || segment.front() == '.') return false;
    if (slash == std::string_view::npos) return true;
    relative.remove_prefix(slash + 1);
  }
}

/// Returns true if `path` lies inside `root` (both canonical): a link may lead outside.
bool inside(const fs::path& root, const fs::path& path) {
  const auto [left, rest] = std::mismatch(root.begin(), root.end(), path.begin(), path.end());
  return left == root.end() && rest != path.end();
}

std::string makeEtag(fs::file_time_type modified, std::uintmax_t size_bytes, std::string_view coding) {
  return "\"" + std::to_string(modified.time_since_epoch().count()) + "-" + std::to_string(size_bytes) +
         (coding.empty() ? "" : "-" + std::string(coding)) + "\"";
}

/// Returns the value of "q=0.5"; 0 if it is malformed.
double weightOf(std::string_view parameter) {
  parameter = trimmed(parameter);
  if (!parameter.starts_with("q=") && !parameter.starts_with("Q=")) return 0.0;
  parameter.remove_prefix(2);
  double weight = 0.0;
  const auto [end, error] = std::from_chars(parameter.data(), parameter.data() + parameter.size(), weight);
  const bool is_weight =
      error == std::errc() && end == parameter.data() + parameter.size() && weight >= 0 && weight <= 1;
  return is_weight ? weight : 0.0;
}

}  // namespace

double codingWeight(std::string_view accept_encoding, std::string_view coding) {
  double of_others = 0.0;
  while (!accept_encoding.empty()) {
    const std::string_view entry = takeEntry(accept_encoding);
    const std::size_t semicolon = entry.find(';');
    const std::string_view name = trimmed(entry.substr(0, semicolon));
    const double weight = semicolon == std::string_view::npos ? 1.0 : weightOf(entry.substr(semicolon + 1));
    if (boost::beast::iequals(name, coding)) return weight;
    if (name == "*") of_others = weight;
  }
  return of_others;
}

StaticFiles::StaticFiles(const std::string& web_root) {
  if (web_root.empty()) return;
  std::error_code error;
  fs::path root = fs::canonical(web_root, error);
  if (error || !fs::is_directory(root, error)) {
    spdlog::warn("the web root {} is not a folder: no page is served", web_root);
    return;
  }
  root_ = std::move(root);
}

std::shared_ptr<const StaticFile> StaticFiles::find(std::string_view path, std::string_view accept_encoding) {
  if (root_.empty() || !path.starts_with('/')) return nullptr;
  // The pad of a class is the same page at another address.
  const bool is_page = path == "/" || path == "/pad";
  const std::string relative(is_page ? std::string_view("index.html") : path.substr(1));
  if (!plainSegments(relative)) return nullptr;
  std::shared_ptr<const StaticFile> chosen = read(relative, {});
  if (!chosen) return nullptr;
  const fs::file_time_type modified = chosen->modified;
  // Without an entry of its own, the file as it is comes after every coding.
  double weight = codingWeight(accept_encoding, "identity");
  for (const ContentCoding& coding : kContentCodings) {
    const double coding_weight = codingWeight(accept_encoding, coding.name);
    if (coding_weight == 0.0 || coding_weight < weight || (coding_weight == weight && !chosen->coding.empty()))
      continue;
    const std::shared_ptr<const StaticFile> file = read(relative, coding);
    if (!file) continue;
    if (file->modified + kCopyTime < modified) {
      spdlog::debug("{}{} is older than {}: not served; build the page again", relative, coding.suffix, relative);
      continue;
    }
    chosen = file;
    weight = coding_weight;
  }
  return chosen;
}

std::shared_ptr<const StaticFile> StaticFiles::read(const std::string& relative, const ContentCoding& coding) {
  const std::string name = relative + std::string(coding.suffix);
  std::error_code error;
  const fs::path full = fs::canonical(root_ / name, error);
  if (error || !inside(root_, full) || !fs::is_regular_file(full, error)) return nullptr;
  const std::uintmax_t size_bytes = fs::file_size(full, error);
  if (error) return nullptr;
  const fs::file_time_type modified = fs::last_write_time(full, error);
  if (error) return nullptr;
  if (size_bytes > kMaxFileBytes) {
    spdlog::warn("{} has {} bytes, more than {}: not served", name, size_bytes, kMaxFileBytes);
    return nullptr;
  }

  const std::lock_guard lock(mutex_);
  // A file that is asked for by its compressed name is another one: as it is, it has the type of its last extension.
  const std::string key = relative + ":" + std::string(coding.name);
  const auto cached = cache_.find(key);
  if (cached != cache_.end()) {
    if (cached->second->modified == modified && cached->second->content.size() == size_bytes) return cached->second;
    cached_bytes_ -= cached->second->content.size();
    cache_.erase(cached);
  }

  auto file = std::make_shared<StaticFile>();
  file->content.resize(size_bytes);
  std::ifstream stream(full, std::ios::binary);
  stream.read(file->content.data(), static_cast<std::streamsize>(size_bytes));
  if (!stream) {
    spdlog::warn("{} cannot be read: not served", name);
    return nullptr;
  }
  file->content_type = contentType(relative);
  file->coding = coding.name;
  file->etag = makeEtag(modified, size_bytes, coding.name);
  file->modified = modified;
  file->immutable = relative.starts_with("assets/");
  if (cached_bytes_ + size_bytes <= kMaxCacheBytes) {
    cache_[key] = file;
    cached_bytes_ += size_bytes;
  }
  return file;
}

std::string contentType(std::string_view file_name) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 17> kTypes{{
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".mjs", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".json", "application/json"},
      {".map", "application/json"},
      {".wasm", "application/wasm"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".webp", "image/webp"},
      {".jpg", "image/jpeg"},
      {".jpeg", "image/jpeg"},
      {".ico", "image/vnd.microsoft.icon"},
      {".webmanifest", "application/manifest+json"},
      {".txt", "text/plain; charset=utf-8"},
      {".woff2", "font/woff2"},
      {".md", "text/plain; charset=utf-8"},
  }};
  std::string extension;
  const std::size_t dot = file_name.rfind('.');
  if (dot != std::string_view::npos) extension = file_name.substr(dot);
  for (char& letter : extension) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  for (const auto& [known, type] : kTypes) {
    if (extension == known) return std::string(type);
  }
  return "application/octet-stream";
}

}  // namespace spindrift::net
