#include "access_tracker.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include <spdlog/spdlog.h>

namespace spindrift::gpu {
namespace {

constexpr std::size_t kMaxFaults = 64;
constexpr std::array<const char*, AccessTracker::kKindCount> kKindNames = {
    "Barrier::kStorage", "Barrier::kTexel", "Barrier::kUniform", "Barrier::kIndirect", "Barrier::kBufferUpdate"};

std::string quoted(const BufferAccess& buffer) {
  return "buffer \"" + buffer.name + "\"";
}

}  // namespace

void AccessTracker::remove(BufferAccess& buffer) {
  buffers_.erase(&buffer);
  for (auto& table : bound_) std::ranges::replace(table, &buffer, nullptr);
}

void AccessTracker::bind(Kind kind, std::uint32_t binding, BufferAccess& buffer) {
  constexpr std::uint32_t kMaxBinding = 1024;  // far above the limits of drivers, which refuse larger numbers
  assert(binding < kMaxBinding);
  if (binding >= kMaxBinding) return;
  std::vector<BufferAccess*>& table = bound_[kind];
  if (binding >= table.size()) table.resize(binding + 1, nullptr);
  table[binding] = &buffer;
}

Barrier AccessTracker::beforeDispatch(const ProgramUses& program, BufferAccess* indirect) {
  // Most drivers order uploads and copies with shader reads anyway. A store over data that an operation still reads or
  // writes is not ordered. Uniform blocks and indirect arguments written by an operation need nothing.
  bool is_needed = false;
  for (const ProgramUses::Block& block : program.storage) {
    const BufferAccess* const buffer = at(kStorage, block.binding);
    if (!buffer) continue;
    is_needed |= buffer->update_write > barrier_at_[kStorage];
    is_needed |= block.is_written && buffer->update_read > barrier_at_[kStorage];
  }
  for (const ProgramUses::Block& unit : program.texels) {
    const BufferAccess* const buffer = at(kTexel, unit.binding);
    is_needed |= buffer && buffer->update_write > barrier_at_[kTexel];
  }
  const Barrier needed = is_needed ? Barrier::kStorageAndTexel : Barrier{};
  barrier(needed);

  if (checks_) check(program, indirect);

  ++now_;
  for (const ProgramUses::Block& unit : program.texels) {
    if (BufferAccess* const buffer = at(kTexel, unit.binding)) {
      buffer->shader_read = now_;
      buffer->shader_reader = program.path;
    }
  }
  for (const ProgramUses::Block& block : program.storage) {
    BufferAccess* const buffer = at(kStorage, block.binding);
    if (!buffer) continue;
    if (block.is_read) {
      buffer->shader_read = now_;
      buffer->shader_reader = program.path;
    }
    if (block.is_written) {
      buffer->shader_write = now_;
      buffer->shader_writer = program.path;
    }
  }
  return needed;
}

Barrier AccessTracker::beforeUpdate(BufferAccess* from, BufferAccess* to) {
  bool is_needed = false;
  for (const BufferAccess* const buffer : {from, to}) {
    is_needed |= buffer && buffer->shader_write > barrier_at_[kUpdate];
  }
  is_needed |= to && to->shader_read > barrier_at_[kUpdate];
  const Barrier needed = is_needed ? Barrier::kBufferUpdate : Barrier{};
  barrier(needed);
  ++now_;
  if (from) from->update_read = now_;
  if (to) to->update_write = now_;
  return needed;
}

void AccessTracker::barrier(Barrier readers) {
  for (std::size_t kind = 0; kind < kKindCount; ++kind) {
    if ((static_cast<std::uint32_t>(readers) >> kind & 1u) != 0) barrier_at_[kind] = now_;
  }
}

void AccessTracker::check(const ProgramUses& program, BufferAccess* indirect) {
  const auto bound = [&](Kind kind, const ProgramUses::Block& block, const char* what) {
    const BufferAccess* const buffer = at(kind, block.binding);
    if (!buffer) {
      fault(std::string(program.path) + " uses " + what + " " + std::to_string(block.binding) + " (" + block.name +
            "), where no buffer is bound");
    }
    return buffer;
  };
  if (indirect) checkRead(program, *indirect, kIndirect);
  for (const ProgramUses::Block& block : program.uniforms) {
    const BufferAccess* const buffer = bound(kUniform, block, "uniform binding");
    if (!buffer) continue;
    checkRead(program, *buffer, kUniform);
    if (buffer->size_bytes < block.size_bytes) {
      fault(std::string(program.path) + ": the uniform block " + block.name + " has " +
            std::to_string(block.size_bytes) + " bytes, but " + quoted(*buffer) + " bound to it only " +
            std::to_string(buffer->size_bytes));
    }
  }
  for (const ProgramUses::Block& unit : program.texels) {
    if (const BufferAccess* const buffer = bound(kTexel, unit, "texture unit")) checkRead(program, *buffer, kTexel);
  }
  for (const ProgramUses::Block& block : program.storage) {
    const BufferAccess* const buffer = bound(kStorage, block, "storage binding");
    if (!buffer) continue;
    if (block.is_read) checkRead(program, *buffer, kStorage);
    if (block.is_written) checkWrite(program, *buffer);
  }
}

void AccessTracker::checkRead(const ProgramUses& program, const BufferAccess& buffer, Kind kind) {
  if (buffer.shader_write <= barrier_at_[kind]) return;
  if (kind == kStorage && buffer.has_disjoint_writes) return;
  fault(std::string(program.path) + " reads " + quoted(buffer) + ", which " + std::string(buffer.shader_writer) +
        " wrote, without " + kKindNames[kind] + " between them");
}

void AccessTracker::checkWrite(const ProgramUses& program, const BufferAccess& buffer) {
  if (!buffer.has_disjoint_writes && buffer.shader_write > barrier_at_[kStorage]) {
    fault(std::string(program.path) + " writes " + quoted(buffer) + ", which " + std::string(buffer.shader_writer) +
          " wrote as well, without Barrier::kStorage between them");
  }
  if (!buffer.has_disjoint_writes && buffer.shader_read > barrier_at_[kStorage]) {
    fault(std::string(program.path) + " writes " + quoted(buffer) + ", which " + std::string(buffer.shader_reader) +
          " may still read, without Barrier::kStorage between them");
  }
}

void AccessTracker::fault(std::string text) {
  if (known_faults_.size() >= kMaxFaults || !known_faults_.insert(text).second) return;
  spdlog::error("barrier checker: {}", text);
  faults_.push_back(std::move(text));
}

std::vector<std::string> AccessTracker::takeFaults() {
  known_faults_.clear();
  return std::exchange(faults_, {});
}

}  // namespace spindrift::gpu
