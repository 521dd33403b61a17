// What the parts of a simulation are made of: buffers, and passes over them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include <shared/groups.h>

#include <spindrift/core/cell_counts.h>
#include <spindrift/core/result.h>
#include <spindrift/gpu/buffer.h>
#include <spindrift/gpu/context.h>
#include <spindrift/gpu/program.h>
#include <spindrift/gpu/readback_ring.h>

namespace spindrift::sim {

/// A compute program. A barrier ends each run, so that the next pass sees what it wrote; dispatches have none.
class Pass : public gpu::Program {
 public:
  Pass() = default;  ///< empty; only to be assigned to
  Pass(gpu::Context& ctx, gpu::Program program) : gpu::Program(std::move(program)), ctx_(&ctx) {}

  void run(core::CellCounts cells) { run(cells.x, cells.z); }
  /// One invocation per WAVE_STRIP rows of cells (shared/groups.h).
  void runStrips(core::CellCounts cells) {
    const std::uint32_t strip = std::min<std::uint32_t>(ctx_->tuning().dispersion_strip, WAVE_STRIP_MAX);
    run(cells.x, (cells.z + strip - 1) / strip);
  }
  void run(std::uint32_t x_count, std::uint32_t y_count = 1, std::uint32_t z_count = 1) {
    dispatch(x_count, y_count, z_count);
    barrier();
  }
  void runGroups(std::uint32_t count) {
    dispatchGroups(count);
    barrier();
  }
  /// Makes the writes of the passes before visible to `readers`.
  void barrier(gpu::Barrier readers = gpu::Barrier::kStorageAndTexel) { ctx_->barrier(readers); }

 private:
  gpu::Context* ctx_ = nullptr;
};

/// Makes buffers and passes, and keeps the first error. What it makes from then on is empty.
class Creation {
 public:
  explicit Creation(gpu::Context& ctx, gpu::Defines defines = {}) : ctx_(ctx), defines_(std::move(defines)) {}

  gpu::Buffer buffer(std::string_view name, std::size_t size_bytes,
                     gpu::BufferContent content = gpu::BufferContent::kZero) {
    return made<gpu::Buffer>(name, size_bytes, gpu::BufferUse::kDeviceOnly, content);
  }
  template <typename Block>
  gpu::Buffer uniforms(std::string_view name) {
    return updatable(name, sizeof(Block));
  }
  gpu::Buffer updatable(std::string_view name, std::size_t size_bytes) {
    return made<gpu::Buffer>(name, size_bytes, gpu::BufferUse::kUpdatable);
  }
  gpu::TexelBuffer texels(std::string_view name, std::size_t texel_count, gpu::TexelFormat format,
                          gpu::BufferContent content = gpu::BufferContent::kZero) {
    return made<gpu::TexelBuffer>(name, texel_count, format, content);
  }
  gpu::TexelBuffer scratch(std::string_view name, std::size_t texel_count, gpu::TexelFormat format) {
    return texels(name, texel_count, format, gpu::BufferContent::kScratch);
  }
  /// Compiles a shader with the defines, and `more`.
  Pass pass(std::string_view shader_path, const gpu::Defines& more = {}) {
    gpu::Defines defines = defines_;
    defines.insert(defines.end(), more.begin(), more.end());
    return {ctx_, made<gpu::Program>(shader_path, defines)};
  }
  /// Compiles a shader without defines.
  Pass plainPass(std::string_view shader_path) { return {ctx_, made<gpu::Program>(shader_path)}; }
  std::unique_ptr<gpu::ReadbackRing> ring(std::string_view name, std::size_t slot_bytes, std::size_t slot_count) {
    return made<std::unique_ptr<gpu::ReadbackRing>, gpu::ReadbackRing>(name, slot_bytes, slot_count);
  }

  void fail(core::Error error) {
    if (!error_) error_ = std::move(error);
  }
  [[nodiscard]] const std::optional<core::Error>& error() const { return error_; }
  /// Returns success, or the first error.
  [[nodiscard]] core::Result<void> result() const {
    return error_ ? core::Result<void>(*error_) : core::Result<void>();
  }
  [[nodiscard]] gpu::Context& context() const { return ctx_; }

 private:
  template <typename Made, typename Maker = Made>
  Made made(const auto&... arguments) {
    if (error_) return {};
    auto out = Maker::create(ctx_, arguments...);
    if (out) return *std::move(out);
    error_ = out.error();
    return {};
  }

  gpu::Context& ctx_;
  gpu::Defines defines_;
  std::optional<core::Error> error_;
};

}  // namespace spindrift::sim
