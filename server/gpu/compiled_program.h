// What the driver made of one shader with one set of defines, shared by all Program objects of a context that ask for
// it. Private to this module.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/gpu/program.h>

#include "access_tracker.h"

namespace spindrift::gpu {

struct CompiledProgram {
  /// Compiles and links. Errors as Program::create().
  static core::Result<std::shared_ptr<CompiledProgram>> compile(Context& ctx, std::string_view shader_path,
                                                                const Defines& defines);
  CompiledProgram() = default;
  ~CompiledProgram();
  CompiledProgram(const CompiledProgram&) = delete;
  CompiledProgram& operator=(const CompiledProgram&) = delete;

  /// Goes on as `fresh`, the same shader compiled from changed files.
  void become(CompiledProgram& fresh);

  std::uint32_t id = 0;
  std::uint32_t generation = 0;  ///< counts become(): locations of uniforms are others then
  std::array<std::uint32_t, 3> group_size = {1, 1, 1};
  std::set<std::string> files;  ///< that it was compiled from; empty for an embedded shader
  std::map<std::string, std::int32_t, std::less<>> locations;
  ProgramUses uses;

  /// Plain uniforms are state of the OpenGL program: whose values it holds now (Program::handle_), and which locations
  /// anybody ever set.
  std::uint64_t uniforms_of = 0;
  std::vector<UniformValue> touched;
};

/// Programs by shader and defines. Those that nobody uses are kept for the next room of the same kind, at most
/// kMaxUnused of them.
class ProgramCache {
 public:
  core::Result<std::shared_ptr<CompiledProgram>> get(Context& ctx, std::string_view shader_path,
                                                     const Defines& defines);
  /// Programs held now, in use or not.
  [[nodiscard]] std::size_t size() const { return entries_.size(); }
  std::uint64_t newHandle() { return ++last_handle_; }
  void clear() { entries_.clear(); }
  /// Compiles those anew that were compiled from one of these files of the context's shader folder. Errors are logged,
  /// and the program goes on as it was.
  void reload(Context& ctx, const std::set<std::string>& files);

 private:
  static constexpr std::size_t kMaxUnused = 256;  // a room has about 30; all variants that scenes ask for are about 90
  struct Entry {
    std::string key;
    std::string shader_path;
    Defines defines;
    std::shared_ptr<CompiledProgram> program;
  };
  void dropUnused();

  std::list<Entry> entries_;  ///< least recently asked for first
  std::map<std::string, std::list<Entry>::iterator> by_key_;
  std::uint64_t last_handle_ = 0;
};

}  // namespace spindrift::gpu
