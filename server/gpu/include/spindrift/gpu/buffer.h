// Device memory: a buffer of fixed size, and a buffer that shaders read through texelFetch.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <ranges>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/gpu/context.h>

namespace spindrift::gpu {

/// Memory in which the driver may keep a buffer.
enum class BufferUse {
  /// In device memory: storage, texels, indirect arguments. Uploads and downloads go through a copy on the device.
  kDeviceOnly,
  /// Small blocks that the host writes often, above all uniform blocks: upload() hands the bytes to the driver, in the
  /// order of the other commands.
  kUpdatable,
};

/// Content of a buffer before anything is written to it.
enum class BufferContent {
  kZero,
  /// Zero too, but no code may rely on it: each tick writes every word before it reads it. Filled with set bits when
  /// Checks::poison is on.
  kScratch,
};

/// A buffer with immutable storage. Move-only; must not outlive its context; empty when default-constructed. All sizes
/// and offsets in bytes. upload(), download(), clear() and copyFrom() see the writes of earlier shaders, and later
/// shaders see theirs: they issue the barriers that are needed. Offsets out of range are bugs of the caller: asserted
/// in debug builds, otherwise refused by OpenGL and counted in Context::debugErrorCount().
class Buffer {
 public:
  /// Creates a buffer. Error kInternal when the device has no memory for it or the size is 0.
  static core::Result<Buffer> create(Context& ctx, std::string_view name, std::size_t size_bytes,
                                     BufferUse use = BufferUse::kDeviceOnly,
                                     BufferContent content = BufferContent::kZero);

  [[nodiscard]] std::size_t sizeBytes() const;    ///< 0 when empty
  [[nodiscard]] const std::string& name() const;  ///< not of an empty buffer
  [[nodiscard]] std::uint32_t id() const;         ///< the OpenGL name; 0 when empty
  explicit operator bool() const { return access_ != nullptr; }

  /// Copies any contiguous range of plain values (vector, array, span) to `offset_bytes`.
  template <std::ranges::contiguous_range Range>
  void upload(const Range& values, std::size_t offset_bytes = 0) {
    static_assert(std::is_trivially_copyable_v<std::ranges::range_value_t<Range>>);
    uploadBytes(std::as_bytes(std::span(std::ranges::data(values), std::ranges::size(values))), offset_bytes);
  }
  /// Copies one plain value, for example a parameter block, to `offset_bytes`.
  template <typename T>
  void uploadValue(const T& value, std::size_t offset_bytes = 0) {
    static_assert(std::is_trivially_copyable_v<T>);
    uploadBytes(std::as_bytes(std::span(&value, 1)), offset_bytes);
  }
  /// Reads back into `out`. Blocks until the device is done: for tests, client commands and hashes only. When the
  /// device was lost (Context::isLost()) or does not answer within 30 s, which is logged and counted, `out` is filled
  /// with zeros.
  template <typename T>
  void download(std::span<T> out, std::size_t offset_bytes = 0) const {
    static_assert(std::is_trivially_copyable_v<T>);
    downloadBytes(std::as_writable_bytes(out), offset_bytes);
  }
  /// Returns the first `count` values. Waits, as above.
  template <typename T>
  [[nodiscard]] std::vector<T> downloadVector(std::size_t count) const {
    std::vector<T> out(count);
    download(std::span<T>(out));
    return out;
  }

  /// Sets every whole 32-bit word to `word`; a tail of 1 to 3 bytes takes the low bytes of `word`.
  void clear(std::uint32_t word = 0);
  /// Clears a part of the buffer; offset and size must be multiples of 4.
  void clearRange(std::uint32_t word, std::size_t offset_bytes, std::size_t size_bytes);
  /// Copies on the device, without waiting.
  void copyFrom(const Buffer& source, std::size_t source_offset_bytes, std::size_t size_bytes,
                std::size_t offset_bytes = 0);

  /// Binds the whole buffer as `layout(binding = …) buffer`.
  void bindStorage(std::uint32_t binding) const;
  /// Binds the whole buffer as `layout(binding = …) uniform Block`.
  void bindUniform(std::uint32_t binding) const;

  /// Tells the barrier checker that consecutive dispatches write different parts of this buffer and none reads the
  /// writes of another, so that no barrier is needed between them.
  void declareDisjointWrites();
  /// Returns the accesses to this buffer so far, for the other classes of this module. Null when empty.
  [[nodiscard]] BufferAccess* access() const { return access_.get(); }

 protected:
  struct Delete {
    void operator()(BufferAccess* access) const;
  };
  /// Returns the buffer for OpenGL calls; it is not empty, and the calling thread owns the context.
  [[nodiscard]] BufferAccess& current() const;
  void uploadBytes(std::span<const std::byte> bytes, std::size_t offset_bytes);
  void downloadBytes(std::span<std::byte> bytes, std::size_t offset_bytes) const;

  std::unique_ptr<BufferAccess, Delete> access_;  ///< the context keeps its address
};

/// Type in which texelFetch reads the words of a TexelBuffer (samplerBuffer, usamplerBuffer, isamplerBuffer).
enum class TexelFormat { kR32F, kRG32F, kRGBA32F, kR32UI, kRG32UI, kRGBA32UI, kR32I, kRG32I, kRGBA32I };

/// A buffer that is written as shader storage and read with texelFetch. Hot reads go this way because, measured on
/// llvmpipe 22.3, storage loads inside a loop are scalarised, and a gather through texelFetch is three to four times
/// faster.
class TexelBuffer : public Buffer {
 public:
  /// Creates a buffer as Buffer::create() does, of `texel_count` texels; also refused beyond
  /// `max_texel_buffer_elements`.
  static core::Result<TexelBuffer> create(Context& ctx, std::string_view name, std::size_t texel_count,
                                          TexelFormat format, BufferContent content = BufferContent::kZero);

  /// Binds the view to the texture unit of `layout(binding = …) uniform samplerBuffer`.
  void bindTexel(std::uint32_t unit) const;
};

}  // namespace spindrift::gpu
