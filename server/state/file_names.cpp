#include "file_names.h"

#include <algorithm>
#include <charconv>

#include "posix_file.h"

namespace spindrift::state {
namespace {

constexpr std::size_t kDigitCount = 12;
constexpr std::string_view kSnapshotSuffix = ".snapshot";
constexpr std::string_view kLogSuffix = ".log";

std::string nameOf(std::uint64_t generation, std::string_view suffix) {
  const std::string digits = std::to_string(generation);
  return std::string(kDigitCount - std::min(kDigitCount, digits.size()), '0') + digits + std::string(suffix);
}

}  // namespace

FileName parseFileName(std::string_view name) {
  const std::string_view digits = name.substr(0, kDigitCount);
  std::uint64_t generation = 0;
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), generation);
  const bool is_number = digits.size() == kDigitCount && read.ec == std::errc() && generation > 0 &&
                         read.ptr == digits.data() + digits.size();
  if (!is_number) return {};
  std::string_view rest = name.substr(kDigitCount);
  const FileKind kind = rest.starts_with(kSnapshotSuffix) ? FileKind::kSnapshot
                        : rest.starts_with(kLogSuffix)    ? FileKind::kLog
                                                          : FileKind::kForeign;
  if (kind == FileKind::kForeign) return {};
  rest.remove_prefix(kind == FileKind::kSnapshot ? kSnapshotSuffix.size() : kLogSuffix.size());
  if (rest.empty()) return {kind, generation};
  if (rest == kTemporarySuffix) return {FileKind::kTemporary, 0};
  if (rest == ".damaged" || rest.starts_with(".damaged.")) return {FileKind::kSetAside, 0};
  return {};
}

std::string snapshotName(std::uint64_t generation) {
  return nameOf(generation, kSnapshotSuffix);
}

std::string logName(std::uint64_t generation) {
  return nameOf(generation, kLogSuffix);
}

}  // namespace spindrift::state
