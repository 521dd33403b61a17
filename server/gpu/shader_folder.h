// Shaders read from files while the program runs, in place of the embedded ones: for whoever works on them. Private to
// this module.
#pragma once

#include <chrono>
#include <deque>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/gpu/embedded_shader.h>

namespace spindrift::gpu {

class ShaderFolder {
 public:
  explicit ShaderFolder(std::filesystem::path root);

  /// One entry point with its includes, as embed_shaders.py expands it, but for lines that the preprocessor drops.
  struct Source {
    std::string text;
    std::uint32_t line_count = 0;  ///< in `text`
    std::vector<LineRange> lines;
    std::deque<std::string> names;  ///< what `lines` refers to: elements never move
    std::set<std::string> files;    ///< read for it, relative to the root
  };
  /// Errors, with file and line: kInvalidInput for a file that is not there, an include that cannot be read as one or a
  /// cycle.
  [[nodiscard]] core::Result<Source> expand(std::string_view entry) const;

  /// Files below the root that were written, added or removed since the last call; none where that was a moment ago.
  [[nodiscard]] std::set<std::string> takeChanged();

 private:
  using Times = std::map<std::string, std::filesystem::file_time_type>;
  [[nodiscard]] Times times() const;
  core::Result<void> expand(const std::string& name, const std::vector<std::string>& stack, Source& out) const;

  const std::filesystem::path root_;
  Times times_;
  std::chrono::steady_clock::time_point next_look_{};
};

}  // namespace spindrift::gpu
