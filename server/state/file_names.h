// Names of the files of a room: NNNNNNNNNNNN.snapshot and NNNNNNNNNNNN.log, twelve digits; NAME.tmp while a file is
// written; NAME.damaged, NAME.damaged.2, ... for what was set aside.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace spindrift::state {

enum class FileKind { kSnapshot, kLog, kTemporary, kSetAside, kForeign };

struct FileName {
  FileKind kind = FileKind::kForeign;
  std::uint64_t generation = 0;  ///< of a snapshot or log; from 1
};

FileName parseFileName(std::string_view name);
std::string snapshotName(std::uint64_t generation);
std::string logName(std::uint64_t generation);

}  // namespace spindrift::state
