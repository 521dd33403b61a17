// For shader development: reads shaders from files while the program runs, in place of the embedded ones. Private to
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

  /// One entry point with its includes expanded, as embed_shaders.py does, except for lines that the preprocessor
  /// drops.
  struct Source {
    std::string text;
    std::vector<LineRange> lines;
    std::deque<std::string> names;  ///< file names that `lines` points to; a deque, because elements must not move
    std::set<std::string> files;    ///< all files that were read, relative to the root
  };
  /// Errors name file and line: kInvalidInput for a missing file, an include that cannot be parsed or a cycle.
  [[nodiscard]] core::Result<Source> expand(std::string_view entry) const;

  /// Returns the files below the root that were written, added or removed since the last call; none if that was a
  /// moment ago.
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
