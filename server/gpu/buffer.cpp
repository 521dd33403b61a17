#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include <glad/gl.h>

#include <spindrift/gpu/buffer.h>

#include "access_tracker.h"
#include "gl_errors.h"
#include "staging.h"

namespace spindrift::gpu {
namespace {

struct TexelTraits {
  GLenum gl_format;
  std::size_t bytes;
};

/// Indexed by TexelFormat.
constexpr std::array<TexelTraits, 9> kTexels = {{{GL_R32F, 4},
                                                 {GL_RG32F, 8},
                                                 {GL_RGBA32F, 16},
                                                 {GL_R32UI, 4},
                                                 {GL_RG32UI, 8},
                                                 {GL_RGBA32UI, 16},
                                                 {GL_R32I, 4},
                                                 {GL_RG32I, 8},
                                                 {GL_RGBA32I, 16}}};

core::Error refused(std::string_view name, const std::string& what) {
  return {core::ErrorCode::kInternal, "buffer \"" + std::string(name) + "\": " + what};
}

}  // namespace

core::Result<Buffer> Buffer::create(Context& ctx, std::string_view name, std::size_t size_bytes, BufferUse use,
                                    BufferContent content) {
  assert(ctx.isOwnedHere());
  if (size_bytes == 0) return refused(name, "size is 0 bytes; leave the buffer out instead");
  const auto max_bytes = static_cast<std::size_t>(ctx.limits().max_ssbo_bytes);
  if (size_bytes > max_bytes) {
    return refused(name, std::to_string(size_bytes) + " bytes exceed the device's largest storage block of " +
                             std::to_string(max_bytes) + " bytes; make the scene smaller");
  }
  clearOldErrors();  // the debug callback has counted them; the next error concerns this buffer
  GLuint id = 0;
  glCreateBuffers(1, &id);
  if (!isMemoryUsedUp(ctx, size_bytes)) {
    glNamedBufferStorage(id, static_cast<GLsizeiptr>(size_bytes), nullptr,
                         use == BufferUse::kUpdatable ? GL_DYNAMIC_STORAGE_BIT : 0);
  }
  const GLenum error = isMemoryUsedUp(ctx, size_bytes) ? GL_OUT_OF_MEMORY : glGetError();
  if (error != GL_NO_ERROR) {
    glDeleteBuffers(1, &id);
    if (error == GL_OUT_OF_MEMORY) return outOfMemory(ctx, "buffer \"" + std::string(name) + "\"", size_bytes);
    return refused(name, "the device cannot hold " + std::to_string(size_bytes) + " bytes (OpenGL error " +
                             std::to_string(error) + "); make the scene smaller");
  }
  Buffer buffer;
  buffer.access_.reset(new BufferAccess{.ctx = ctx,
                                        .buffer_id = id,
                                        .name = std::string(name),
                                        .size_bytes = size_bytes,
                                        .is_updatable = use == BufferUse::kUpdatable,
                                        .is_scratch = content == BufferContent::kScratch});
  ctx.accesses().add(*buffer.access_);
  Ledger& ledger = ctx.ledgerEntry();
  ++ledger.buffer_count;
  ++ledger.buffers_made_count;
  ledger.buffer_bytes += size_bytes;
  // Shown by drivers and debuggers, which may limit its length.
  glObjectLabel(GL_BUFFER, id, static_cast<GLsizei>(std::min<std::size_t>(name.size(), 200)), name.data());
  buffer.clear(ctx.checks().poison && content == BufferContent::kScratch ? 0xffffffff : 0);
  return buffer;
}

void Buffer::Delete::operator()(BufferAccess* access) const {
  Context& ctx = access->ctx;
  assert(ctx.isOwnedHere());
  if (access->texture_id != 0) glDeleteTextures(1, &access->texture_id);
  ctx.accesses().remove(*access);
  glDeleteBuffers(1, &access->buffer_id);
  Ledger& ledger = ctx.ledgerEntry();
  --ledger.buffer_count;
  ledger.buffer_bytes -= access->size_bytes;
  delete access;
}

BufferAccess& Buffer::current() const {
  assert(access_ && access_->ctx.isOwnedHere());
  return *access_;
}

std::size_t Buffer::sizeBytes() const {
  return access_ ? access_->size_bytes : 0;
}

const std::string& Buffer::name() const {
  return access_->name;
}

std::uint32_t Buffer::id() const {
  return access_ ? access_->buffer_id : 0;
}

void Buffer::declareDisjointWrites() {
  access_->has_disjoint_writes = true;
}

void Buffer::clear(std::uint32_t word) {
  BufferAccess& buffer = current();
  const std::size_t whole_bytes = buffer.size_bytes / 4 * 4;
  if (whole_bytes > 0) clearRange(word, 0, whole_bytes);
  if (whole_bytes == buffer.size_bytes) return;
  buffer.ctx.beforeUpdate(nullptr, &buffer);
  for (std::size_t i = whole_bytes; i < buffer.size_bytes; ++i) {
    const auto byte = static_cast<std::uint8_t>(word >> (8 * (i - whole_bytes)));
    glClearNamedBufferSubData(buffer.buffer_id, GL_R8UI, static_cast<GLintptr>(i), 1, GL_RED_INTEGER, GL_UNSIGNED_BYTE,
                              &byte);
  }
}

void Buffer::clearRange(std::uint32_t word, std::size_t offset_bytes, std::size_t size_bytes) {
  BufferAccess& buffer = current();
  assert(offset_bytes % 4 == 0 && size_bytes % 4 == 0 && offset_bytes + size_bytes <= buffer.size_bytes);
  buffer.ctx.beforeUpdate(nullptr, &buffer);
  glClearNamedBufferSubData(buffer.buffer_id, GL_R32UI, static_cast<GLintptr>(offset_bytes),
                            static_cast<GLsizeiptr>(size_bytes), GL_RED_INTEGER, GL_UNSIGNED_INT, &word);
}

void Buffer::copyFrom(const Buffer& source, std::size_t source_offset_bytes, std::size_t size_bytes,
                      std::size_t offset_bytes) {
  BufferAccess &from = source.current(), &to = current();
  assert(source_offset_bytes + size_bytes <= from.size_bytes && offset_bytes + size_bytes <= to.size_bytes);
  to.ctx.beforeUpdate(&from, &to);
  glCopyNamedBufferSubData(from.buffer_id, to.buffer_id, static_cast<GLintptr>(source_offset_bytes),
                           static_cast<GLintptr>(offset_bytes), static_cast<GLsizeiptr>(size_bytes));
}

void Buffer::bindStorage(std::uint32_t binding) const {
  BufferAccess& buffer = current();
  buffer.ctx.accesses().bind(AccessTracker::kStorage, binding, buffer);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.buffer_id);
}

void Buffer::bindUniform(std::uint32_t binding) const {
  BufferAccess& buffer = current();
  buffer.ctx.accesses().bind(AccessTracker::kUniform, binding, buffer);
  glBindBufferBase(GL_UNIFORM_BUFFER, binding, buffer.buffer_id);
}

void Buffer::uploadBytes(std::span<const std::byte> bytes, std::size_t offset_bytes) {
  BufferAccess& buffer = current();
  assert(offset_bytes + bytes.size() <= buffer.size_bytes);
  if (bytes.empty()) return;
  ++buffer.ctx.ledgerEntry().upload_count;
  buffer.ctx.ledgerEntry().uploaded_bytes += bytes.size();
  buffer.ctx.beforeUpdate(nullptr, &buffer);
  if (buffer.is_updatable) {
    glNamedBufferSubData(buffer.buffer_id, static_cast<GLintptr>(offset_bytes), static_cast<GLsizeiptr>(bytes.size()),
                         bytes.data());
  } else {
    buffer.ctx.staging().upload(buffer.buffer_id, offset_bytes, bytes);
  }
}

void Buffer::downloadBytes(std::span<std::byte> bytes, std::size_t offset_bytes) const {
  BufferAccess& buffer = current();
  assert(offset_bytes + bytes.size() <= buffer.size_bytes);
  if (bytes.empty()) return;
  buffer.ctx.beforeUpdate(&buffer, nullptr);
  buffer.ctx.staging().download(buffer.buffer_id, offset_bytes, bytes);
}

core::Result<TexelBuffer> TexelBuffer::create(Context& ctx, std::string_view name, std::size_t texel_count,
                                              TexelFormat format, BufferContent content) {
  const TexelTraits texel = kTexels[static_cast<std::size_t>(format)];
  const auto max_count = static_cast<std::size_t>(ctx.limits().max_texel_buffer_elements);
  if (texel_count > max_count) {
    return refused(name, std::to_string(texel_count) + " texels exceed the device's largest buffer texture of " +
                             std::to_string(max_count) + " texels; make the scene smaller");
  }
  core::Result<Buffer> storage = Buffer::create(ctx, name, texel_count * texel.bytes, BufferUse::kDeviceOnly, content);
  if (!storage) return storage.error();
  TexelBuffer buffer;
  static_cast<Buffer&>(buffer) = std::move(*storage);
  GLuint& texture_id = buffer.access_->texture_id;
  glCreateTextures(GL_TEXTURE_BUFFER, 1, &texture_id);
  glTextureBuffer(texture_id, texel.gl_format, buffer.id());
  return buffer;
}

void TexelBuffer::bindTexel(std::uint32_t unit) const {
  BufferAccess& buffer = current();
  buffer.ctx.accesses().bind(AccessTracker::kTexel, unit, buffer);
  glBindTextureUnit(unit, buffer.texture_id);
}

}  // namespace spindrift::gpu
