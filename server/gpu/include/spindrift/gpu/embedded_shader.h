// Shaders embedded in the program; the build expands and validates them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace spindrift::gpu {

/// Maps the lines of the expanded text from `first_line` on to `file`, starting at `file_line`. All count from 1.
struct LineRange {
  std::uint32_t first_line;
  std::string_view file;  ///< relative to shaders/
  std::uint32_t file_line;
};

/// One entry point with its includes expanded, without `#version`.
struct EmbeddedShader {
  std::string_view path;  ///< relative to shaders/, e.g. "sph/density.comp"
  std::string_view text;
  std::span<const LineRange> lines;              ///< ascending in first_line, the first is 1
  std::span<const std::string_view> names = {};  ///< words in capitals outside comments, ascending
  std::string_view digest = {};                  ///< SHA-256 of the text, hexadecimal
};

/// Returns all shaders, ordered by path; generated at build time.
std::span<const EmbeddedShader> embeddedShaders();

/// Returns null when no such shader was embedded.
const EmbeddedShader* findShader(std::string_view path);

/// Returns "sph/density.comp:12" for a line of the expanded text.
std::string sourcePosition(const EmbeddedShader& shader, std::uint32_t line);

/// Returns a driver's log with "0:12(5): …" (Mesa) and "0(12) : …" (NVIDIA) replaced by file and line.
std::string translateLog(const EmbeddedShader& shader, std::string_view log);

}  // namespace spindrift::gpu
