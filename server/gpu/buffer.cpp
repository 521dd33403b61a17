#include <algorithm>
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

TexelTraits traits(TexelFormat format) {
  switch (format) {
    case TexelFormat::kR32F:
      return {GL_R32F, 4};
    case TexelFormat::kRG32F:
      return {GL_RG32F, 8};
    case TexelFormat::kRGBA32F:
      return {GL_RGBA32F, 16};
    case TexelFormat::kR32UI:
      return {GL_R32UI, 4};
    case TexelFormat::kRG32UI:
      return {GL_RG32UI, 8};
    case TexelFormat::kRGBA32UI:
      return {GL_RGBA32UI, 16};
    case TexelFormat::kR32I:
      return {GL_R32I, 4};
    case TexelFormat::kRG32I:
      return {GL_RG32I, 8};
    case TexelFormat::kRGBA32I:
      return {GL_RGBA32I, 16};
  }
  return {GL_R32F, 4};  // not reached: the switch is complete
}

core::Error refused(std::string_view name, const std::string& what) {
  return {core::ErrorCode::kInternal, "buffer \"" + std::string(name) + "\": " + what};
}

}  // namespace

Buffer::Buffer() = default;

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
  Buffer buffer;
  glCreateBuffers(1, &buffer.id_);
  if (!isMemoryUsedUp(ctx, size_bytes)) {
    glNamedBufferStorage(buffer.id_, static_cast<GLsizeiptr>(size_bytes), nullptr,
                         use == BufferUse::kUpdatable ? GL_DYNAMIC_STORAGE_BIT : 0);
  }
  const GLenum error = isMemoryUsedUp(ctx, size_bytes) ? GL_OUT_OF_MEMORY : glGetError();
  if (error != GL_NO_ERROR) {
    glDeleteBuffers(1, &buffer.id_);
    buffer.id_ = 0;
    if (error == GL_OUT_OF_MEMORY) return outOfMemory(ctx, "buffer \"" + std::string(name) + "\"", size_bytes);
    return refused(name, "the device cannot hold " + std::to_string(size_bytes) + " bytes (OpenGL error " +
                             std::to_string(error) + "); make the scene smaller");
  }
  buffer.ctx_ = &ctx;
  buffer.size_bytes_ = size_bytes;
  buffer.name_ = name;
  buffer.use_ = use;
  buffer.access_ = std::make_unique<BufferAccess>();
  buffer.access_->buffer_id = buffer.id_;
  buffer.access_->name = name;
  buffer.access_->size_bytes = size_bytes;
  buffer.access_->is_scratch = content == BufferContent::kScratch;
  ctx.accesses().add(*buffer.access_);
  Ledger& ledger = ctx.ledgerEntry();
  ++ledger.buffer_count;
  ++ledger.buffers_made_count;
  ledger.buffer_bytes += size_bytes;
  // Shown by drivers and debuggers, which may limit its length.
  glObjectLabel(GL_BUFFER, buffer.id_, static_cast<GLsizei>(std::min<std::size_t>(name.size(), 200)), name.data());
  buffer.clear(ctx.checks().poison && content == BufferContent::kScratch ? 0xffffffff : 0);
  return buffer;
}

Buffer::~Buffer() {
  if (id_ == 0) return;
  assert(ctx_->isOwnedHere());
  ctx_->accesses().remove(*access_);
  glDeleteBuffers(1, &id_);
  Ledger& ledger = ctx_->ledgerEntry();
  --ledger.buffer_count;
  ledger.buffer_bytes -= size_bytes_;
}

Buffer::Buffer(Buffer&& other) noexcept
    : ctx_(other.ctx_),
      id_(std::exchange(other.id_, 0)),
      size_bytes_(std::exchange(other.size_bytes_, 0)),
      name_(std::move(other.name_)),
      use_(other.use_),
      access_(std::move(other.access_)) {}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
  // The temporary releases the old contents.
  Buffer moved(std::move(other));
  std::swap(ctx_, moved.ctx_);
  std::swap(id_, moved.id_);
  std::swap(size_bytes_, moved.size_bytes_);
  std::swap(name_, moved.name_);
  std::swap(use_, moved.use_);
  std::swap(access_, moved.access_);
  return *this;
}

void Buffer::declareDisjointWrites() {
  assert(id_ != 0);
  access_->has_disjoint_writes = true;
}

void Buffer::clear(std::uint32_t word) {
  assert(id_ != 0 && ctx_->isOwnedHere());
  const std::size_t whole_bytes = size_bytes_ / 4 * 4;
  if (whole_bytes > 0) clearRange(word, 0, whole_bytes);
  if (whole_bytes == size_bytes_) return;
  ctx_->barrierBits(ctx_->accesses().beforeUpdate(nullptr, access_.get()));
  for (std::size_t i = whole_bytes; i < size_bytes_; ++i) {
    const auto byte = static_cast<std::uint8_t>(word >> (8 * (i - whole_bytes)));
    glClearNamedBufferSubData(id_, GL_R8UI, static_cast<GLintptr>(i), 1, GL_RED_INTEGER, GL_UNSIGNED_BYTE, &byte);
  }
}

void Buffer::clearRange(std::uint32_t word, std::size_t offset_bytes, std::size_t size_bytes) {
  assert(id_ != 0 && ctx_->isOwnedHere());
  assert(offset_bytes % 4 == 0 && size_bytes % 4 == 0 && offset_bytes + size_bytes <= size_bytes_);
  ctx_->barrierBits(ctx_->accesses().beforeUpdate(nullptr, access_.get()));
  glClearNamedBufferSubData(id_, GL_R32UI, static_cast<GLintptr>(offset_bytes), static_cast<GLsizeiptr>(size_bytes),
                            GL_RED_INTEGER, GL_UNSIGNED_INT, &word);
}

void Buffer::copyFrom(const Buffer& source, std::size_t source_offset_bytes, std::size_t size_bytes,
                      std::size_t offset_bytes) {
  assert(id_ != 0 && source.id_ != 0 && ctx_->isOwnedHere());
  assert(source_offset_bytes + size_bytes <= source.size_bytes_ && offset_bytes + size_bytes <= size_bytes_);
  ctx_->barrierBits(ctx_->accesses().beforeUpdate(source.access_.get(), access_.get()));
  glCopyNamedBufferSubData(source.id_, id_, static_cast<GLintptr>(source_offset_bytes),
                           static_cast<GLintptr>(offset_bytes), static_cast<GLsizeiptr>(size_bytes));
}

void Buffer::bindStorage(std::uint32_t binding) const {
  assert(id_ != 0 && ctx_->isOwnedHere());
  ctx_->accesses().bindStorage(binding, *access_);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, id_);
}

void Buffer::bindUniform(std::uint32_t binding) const {
  assert(id_ != 0 && ctx_->isOwnedHere());
  ctx_->accesses().bindUniform(binding, *access_);
  glBindBufferBase(GL_UNIFORM_BUFFER, binding, id_);
}

void Buffer::uploadBytes(std::span<const std::byte> bytes, std::size_t offset_bytes) {
  assert(id_ != 0 && ctx_->isOwnedHere() && offset_bytes + bytes.size() <= size_bytes_);
  if (bytes.empty()) return;
  ++ctx_->ledgerEntry().upload_count;
  ctx_->ledgerEntry().uploaded_bytes += bytes.size();
  ctx_->barrierBits(ctx_->accesses().beforeUpdate(nullptr, access_.get()));
  if (use_ == BufferUse::kUpdatable) {
    glNamedBufferSubData(id_, static_cast<GLintptr>(offset_bytes), static_cast<GLsizeiptr>(bytes.size()), bytes.data());
  } else {
    (void)ctx_->staging().upload(id_, offset_bytes, bytes);  // a failure is counted there
  }
}

void Buffer::downloadBytes(std::span<std::byte> bytes, std::size_t offset_bytes) const {
  assert(id_ != 0 && ctx_->isOwnedHere() && offset_bytes + bytes.size() <= size_bytes_);
  if (bytes.empty()) return;
  ctx_->barrierBits(ctx_->accesses().beforeUpdate(access_.get(), nullptr));
  (void)ctx_->staging().download(id_, offset_bytes, bytes);  // a failure is counted there
}

TexelBuffer::TexelBuffer() = default;

core::Result<TexelBuffer> TexelBuffer::create(Context& ctx, std::string_view name, std::size_t texel_count,
                                              TexelFormat format, BufferContent content) {
  const TexelTraits texel = traits(format);
  const auto max_count = static_cast<std::size_t>(ctx.limits().max_texel_buffer_elements);
  if (texel_count > max_count) {
    return refused(name, std::to_string(texel_count) + " texels exceed the device's largest buffer texture of " +
                             std::to_string(max_count) + " texels; make the scene smaller");
  }
  core::Result<Buffer> storage = Buffer::create(ctx, name, texel_count * texel.bytes, BufferUse::kDeviceOnly, content);
  if (!storage) return storage.error();
  TexelBuffer buffer;
  static_cast<Buffer&>(buffer) = std::move(*storage);
  glCreateTextures(GL_TEXTURE_BUFFER, 1, &buffer.texture_id_);
  glTextureBuffer(buffer.texture_id_, texel.gl_format, buffer.id_);
  return buffer;
}

TexelBuffer::~TexelBuffer() {
  if (texture_id_ != 0) glDeleteTextures(1, &texture_id_);
}

TexelBuffer::TexelBuffer(TexelBuffer&& other) noexcept
    : Buffer(std::move(other)), texture_id_(std::exchange(other.texture_id_, 0)) {}

TexelBuffer& TexelBuffer::operator=(TexelBuffer&& other) noexcept {
  TexelBuffer moved(std::move(other));
  Buffer::operator=(std::move(static_cast<Buffer&>(moved)));
  std::swap(texture_id_, moved.texture_id_);
  return *this;
}

void TexelBuffer::bindTexel(std::uint32_t unit) const {
  assert(texture_id_ != 0 && ctx_->isOwnedHere());
  ctx_->accesses().bindTexel(unit, *access_);
  glBindTextureUnit(unit, texture_id_);
}

}  // namespace spindrift::gpu
