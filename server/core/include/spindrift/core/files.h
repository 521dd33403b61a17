// Reading files that people name: with bounds, and errors that say what to do.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include <spindrift/core/result.h>

namespace spindrift::core {

using FileStream = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// Opens a regular file for reading. `what` it is, with an article, is part of the errors ("a scene file"); they do not
/// name the file. Error: kUnavailable.
Result<FileStream> openFile(const std::filesystem::path& file, const std::string& what);

/// Reads a text of at most `max_bytes`. Errors: those of openFile(); kUnavailable if it cannot be read; kInvalidInput
/// if it is longer, which ends with `advice`.
Result<std::string> readText(const std::filesystem::path& file, std::size_t max_bytes, const std::string& what,
                             const std::string& advice);

}  // namespace spindrift::core
