// Files: of scenes, and those that scenes name in their folder.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <spindrift/core/result.h>

namespace spindrift::scene {

using FileStream = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// Opens a regular file for reading. `what` it is, with an article, is part of the errors ("a scene file"); they do not
/// name the file. Error: kUnavailable.
core::Result<FileStream> openFile(const std::filesystem::path& file, const std::string& what);

/// Reads a text of at most `max_bytes`. Errors: those of openFile(); kUnavailable if it cannot be read; kInvalidInput
/// if it is longer, which ends with `advice`.
core::Result<std::string> readText(const std::filesystem::path& file, std::size_t max_bytes, const std::string& what,
                                   const std::string& advice);

/// Returns where a file lies that a scene names: in the folder of the scene or below, links followed. `folder`: nullopt
/// for scenes that are no files; `instead` says what those give in place of a name. Error: kInvalidInput.
core::Result<std::filesystem::path> fileInFolder(const std::optional<std::filesystem::path>& folder,
                                                 const std::filesystem::path& name, const std::string& instead);

}  // namespace spindrift::scene
