// 16-bit grayscale PNG files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <spindrift/core/result.h>

namespace spindrift::scene {

/// Larger images are refused before their pixels are read.
inline constexpr std::uint32_t kImageSideMaxCount = 1024;

struct GrayImage {
  std::uint32_t width_count = 0;
  std::uint32_t height_count = 0;
  std::vector<std::uint16_t> values;  ///< width * height, the upper row first
};

/// Reads the file. Errors: those of openFile(); kInvalidInput with the reason, without the file's name: too big, no
/// PNG, damaged, of another kind than 16-bit grayscale without transparency.
core::Result<GrayImage> readGrayPng(const std::filesystem::path& file);

}  // namespace spindrift::scene
