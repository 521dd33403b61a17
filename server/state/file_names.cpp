#include "file_names.h"

#include <charconv>

#include <fmt/format.h>

#include "posix_file.h"

namespace spindrift::state {
namespace {

constexpr std::size_t kDigitCount = 12;
constexpr std::string_view kSnapshotSuffix = ".snapshot";
constexpr std::string_view kLogSuffix = ".log";

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
  return fmt::format("{:0{}}{}", generation, kDigitCount, kSnapshotSuffix);
}

std::string logName(std::uint64_t generation) {
  return fmt::format("{:0{}}{}", generation, kDigitCount, kLogSuffix);
}

}  // namespace spindrift::state
