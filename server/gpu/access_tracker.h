// Tracks which accesses to buffers happened since which barrier. Gives the barriers that API operations need, and is
// the barrier checker. Private to this module.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <spindrift/gpu/context.h>

namespace spindrift::gpu {

/// A buffer on the device, and the last accesses to it as positions in the context's sequence of commands; 0 is never.
/// Owned by the Buffer; the address stays fixed while the Buffer lives.
struct BufferAccess {
  Context& ctx;
  std::uint32_t buffer_id = 0;
  std::uint32_t texture_id = 0;  ///< of a TexelBuffer
  std::string name;
  std::size_t size_bytes = 0;
  bool is_updatable = false;  ///< BufferUse::kUpdatable
  bool is_scratch = false;
  /// Consecutive passes write different parts: two writes without a barrier between them are not a fault.
  bool has_disjoint_writes = false;

  std::uint64_t shader_write = 0;
  std::uint64_t shader_read = 0;     ///< as storage or through a texel view
  std::uint64_t update_write = 0;    ///< upload, clear, copy to
  std::uint64_t update_read = 0;     ///< download, copy from
  std::string_view shader_writer{};  ///< path of the program of `shader_write`
  std::string_view shader_reader{};
};

/// Blocks and samplers that a linked program reads and writes. Those that the driver found unused are left out.
struct ProgramUses {
  struct Block {
    std::string name;
    std::uint32_t binding = 0;
    std::uint32_t size_bytes = 0;
    bool is_read = true;
    bool is_written = false;
  };
  std::string_view path;
  std::vector<Block> storage;
  std::vector<Block> uniforms;
  std::vector<Block> texels;  ///< `binding` is the texture unit
};

/// One per context. The rules are those of OpenGL 4.5 core, section 7.13.2 "Shader Memory Access Synchronization":
/// shader writes are visible to a later access only after a barrier that names the kind of that access, and a shader's
/// store may overtake earlier accesses to the same memory unless a storage barrier lies between.
class AccessTracker {
 public:
  /// Kinds of access that a barrier can name, in the order of the bits of Barrier.
  enum Kind { kStorage, kTexel, kUniform, kIndirect, kUpdate, kKindCount };

  explicit AccessTracker(bool checks) : checks_(checks) {}

  void add(BufferAccess& buffer) { buffers_.insert(&buffer); }
  void remove(BufferAccess& buffer);
  [[nodiscard]] const std::set<BufferAccess*>& buffers() const { return buffers_; }

  /// `kind`: kStorage or kUniform, or kTexel with the texture unit as `binding`.
  void bind(Kind kind, std::uint32_t binding, BufferAccess& buffer);

  /// Called before a dispatch. Returns the barrier needed after earlier uploads, clears and copies, or 0; the caller
  /// issues it. `indirect`: the buffer with the group counts, or null.
  [[nodiscard]] Barrier beforeDispatch(const ProgramUses& program, BufferAccess* indirect);
  /// Called before an upload, download, clear or copy; `from` and `to` may be null. Returns a barrier as above.
  [[nodiscard]] Barrier beforeUpdate(BufferAccess* from, BufferAccess* to);
  /// Called when a barrier is issued.
  void barrier(Barrier readers);

  [[nodiscard]] std::vector<std::string> takeFaults();
  [[nodiscard]] bool hasFaults() const { return !faults_.empty(); }

 private:
  /// Returns the buffer that is bound there, or null.
  [[nodiscard]] BufferAccess* at(Kind kind, std::uint32_t binding) const {
    return binding < bound_[kind].size() ? bound_[kind][binding] : nullptr;
  }

  void check(const ProgramUses& program, BufferAccess* indirect);
  void checkRead(const ProgramUses& program, const BufferAccess& buffer, Kind kind);
  void checkWrite(const ProgramUses& program, const BufferAccess& buffer);
  void fault(std::string text);

  bool checks_;
  std::uint64_t now_ = 0;
  std::array<std::uint64_t, kKindCount> barrier_at_{};
  std::set<BufferAccess*> buffers_;
  std::array<std::vector<BufferAccess*>, kIndirect> bound_;  ///< by kind and binding
  std::set<std::string> known_faults_;                       ///< bounded, see fault()
  std::vector<std::string> faults_;
};

}  // namespace spindrift::gpu
