// A compute program from an embedded shader.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/gpu/buffer.h>
#include <spindrift/gpu/context.h>

namespace spindrift::gpu {

/// Layout of a uniform block or storage block in the linked program.
struct BlockLayout {
  bool is_storage = false;
  std::uint32_t binding = 0;
  std::uint32_t size_bytes = 0;                  ///< for a storage block with an unsized array: the minimum
  std::map<std::string, std::uint32_t> offsets;  ///< member -> offset in bytes; arrays as "name[0]"
};

/// Value of a plain uniform in OpenGL's types.
using UniformValue = std::variant<std::uint32_t, std::int32_t, float>;
using UniformValues = std::map<std::string, UniformValue, std::less<>>;  ///< by name

struct CompiledProgram;

/// Move-only; must not outlive its context; empty when default-constructed. Programs with the same path and defines are
/// compiled once per context and share the compiled program; each Program has its own uniform values.
class Program {
 public:
  /// Compiles "sph/density.comp" with `defines`. Error kInternal names the shader and, for each driver message, the
  /// original file and line; a path that was not embedded is an error too.
  static core::Result<Program> create(Context& ctx, std::string_view shader_path, const Defines& defines = {});

  [[nodiscard]] std::uint32_t id() const;  ///< the OpenGL name; 0 when empty
  explicit operator bool() const { return compiled_ != nullptr; }

  /// Returns the local size from the linked program; host code takes it from nowhere else.
  [[nodiscard]] std::array<std::uint32_t, 3> groupSize() const;

  /// Runs at least this many invocations: the item count divided by the local size, rounded up. Shaders guard the
  /// excess. Zero items run nothing. Returns false and runs nothing when more groups would be needed than the device
  /// allows; this is logged and counted in Context::debugErrorCount().
  bool dispatch(std::uint32_t x_count, std::uint32_t y_count = 1, std::uint32_t z_count = 1);
  /// Runs exactly this many groups, with the same limit.
  bool dispatchGroups(std::uint32_t x_count, std::uint32_t y_count = 1, std::uint32_t z_count = 1);
  /// Runs the three group counts that a shader wrote at `offset_bytes` (a multiple of 4).
  void dispatchIndirect(const Buffer& arguments, std::size_t offset_bytes = 0);

  /// Sets a plain uniform. A uniform that the compiler removed is ignored. A name that the shader's text does not
  /// contain is a bug of the caller: asserted in debug builds, otherwise logged once and counted.
  void setUniform(std::string_view name, UniformValue value);

  /// Returns the blocks by the name after `uniform` or `buffer`; blocks that the shader does not use may be missing.
  /// For tests that compare shaders/shared with the driver's layout.
  [[nodiscard]] std::map<std::string, BlockLayout> blocks() const;

 private:
  /// Counts the Program in the ledger no longer.
  struct Uncount {
    void operator()(Context* ctx) const;
  };
  [[nodiscard]] std::int32_t location(std::string_view name);
  /// Prepares the program, its uniforms and the memory that it reads for a dispatch.
  void prepare(const Buffer* arguments);
  void run(const auto& dispatch);

  std::unique_ptr<Context, Uncount> ctx_;  ///< not owned
  std::string path_;
  std::shared_ptr<CompiledProgram> compiled_;
  std::uint64_t handle_ = 0;  ///< unique among the Programs of the context
  UniformValues uniforms_;
};

}  // namespace spindrift::gpu
