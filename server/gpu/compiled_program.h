// The compiled program of one shader with one set of defines, shared by all Program objects of a context that use it.
// Private to this module.
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

#include <spindrift/core/result.h>
#include <spindrift/gpu/program.h>

#include "access_tracker.h"
#include "program_store.h"

namespace spindrift::gpu {

struct CompiledProgram {
  /// Compiles and links. Errors: see Program::create().
  static core::Result<std::shared_ptr<CompiledProgram>> compile(Context& ctx, std::string_view shader_path,
                                                                const Defines& defines);
  CompiledProgram() = default;
  ~CompiledProgram();
  CompiledProgram(const CompiledProgram&) = delete;
  CompiledProgram& operator=(const CompiledProgram&) = delete;

  /// Replaces this program by `fresh`, the same shader compiled from changed files.
  void become(CompiledProgram& fresh);

  std::uint32_t id = 0;
  std::array<std::uint32_t, 3> group_size = {1, 1, 1};
  std::set<std::string> files;  ///< source files; empty for an embedded shader
  std::map<std::string, std::int32_t, std::less<>> locations;
  ProgramUses uses;

  /// Plain uniforms are state of the OpenGL program: the Program (handle_) whose values it holds now, and zeros for all
  /// that were ever set.
  std::uint64_t uniforms_of = 0;
  UniformValues touched;
};

/// Returns the linked program's uniform and storage blocks by the name after `uniform` or `buffer`, without those that
/// the driver found unused; with the offsets of the members if asked.
std::map<std::string, BlockLayout> blocksOf(std::uint32_t program_id, bool has_offsets = true);

/// Programs by shader and defines. At most kMaxUnused unused programs are kept, for the next room of the same kind.
class ProgramCache {
 public:
  /// `folder`: ProgramStore's.
  explicit ProgramCache(std::filesystem::path folder) : store_(std::move(folder)) {}
  core::Result<std::shared_ptr<CompiledProgram>> get(Context& ctx, std::string_view shader_path,
                                                     const Defines& defines);
  std::uint64_t newHandle() { return ++last_handle_; }
  [[nodiscard]] ProgramStore& store() { return store_; }
  /// Recompiles the programs that depend on one of these files of the context's shader folder. Errors are logged, and
  /// the old program stays in use.
  void reload(Context& ctx, const std::set<std::string>& files);

 private:
  static constexpr std::size_t kMaxUnused = 256;  // a room has about 30; the scenes use about 90 variants together
  struct Entry {
    std::string shader_path;
    Defines defines;
    std::shared_ptr<CompiledProgram> program;
  };
  void dropUnused();

  ProgramStore store_;
  std::list<Entry> entries_;  ///< least recently asked for first
  std::uint64_t last_handle_ = 0;
};

}  // namespace spindrift::gpu
