// Reading files that people name: with bounds, and errors that say what to do. Finding those that the program ships
// with: next to the program in a bundle, or in the source tree above a build tree.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include <spindrift/core/result.h>

namespace spindrift::core {

using FileStream = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// Opens a regular file for reading. `what` it is, with an article, is part of the errors ("a scene file"); they do not
/// name the file. Errors: kUnavailable; kInvalidInput for a name with a zero byte.
Result<FileStream> openFile(const std::filesystem::path& file, const std::string& what);

/// Reads a UTF-8 text of at most `max_bytes`, without the byte order mark that some editors put first. Every text file
/// that users name is read here. Errors: those of openFile(); kUnavailable if it cannot be read; kInvalidInput if it is
/// longer, which ends with `advice`, or UTF-16 or UTF-32.
Result<std::string> readText(const std::filesystem::path& file, std::size_t max_bytes, const std::string& what,
                             const std::string& advice);

/// Returns the shipped scene of that name ("harbor", "splash"), otherwise the file. kUnavailable names both paths.
Result<std::filesystem::path> findScene(const std::string& given);

/// Returns the folder of the built web client: share/spindrift/web above the program, or web-client/dist of the source
/// tree. Empty when neither exists.
std::filesystem::path findWebRoot();

/// Returns the folder of the shipped scenes; empty when it does not exist.
std::filesystem::path findSceneFolder();

}  // namespace spindrift::core
