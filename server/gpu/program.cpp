#include <algorithm>
#include <cassert>

#include <glad/gl.h>
#include <spdlog/spdlog.h>

#include <spindrift/core/overloaded.h>
#include <spindrift/gpu/embedded_shader.h>
#include <spindrift/gpu/program.h>

#include "compiled_program.h"
#include "dispatch_times.h"

namespace spindrift::gpu {
namespace {

void apply(GLuint program, GLint location, UniformValue value) {
  std::visit(core::Overloaded{[&](std::uint32_t number) { glProgramUniform1ui(program, location, number); },
                              [&](std::int32_t number) { glProgramUniform1i(program, location, number); },
                              [&](float number) { glProgramUniform1f(program, location, number); }},
             value);
}

}  // namespace

core::Result<Program> Program::create(Context& ctx, std::string_view shader_path, const Defines& defines) {
  assert(ctx.isOwnedHere());
  auto compiled = ctx.programs().get(ctx, shader_path, defines);
  if (!compiled) return compiled.error();
  Program program;
  program.path_ = shader_path;
  program.compiled_ = *std::move(compiled);
  program.handle_ = ctx.programs().newHandle();
  program.ctx_.reset(&ctx);
  ++ctx.ledgerEntry().program_count;
  return program;
}

void Program::Uncount::operator()(Context* ctx) const {
  assert(ctx->isOwnedHere());
  --ctx->ledgerEntry().program_count;
}

std::uint32_t Program::id() const {
  return compiled_ ? compiled_->id : 0;
}

std::array<std::uint32_t, 3> Program::groupSize() const {
  assert(compiled_);
  return compiled_->group_size;
}

bool Program::dispatch(std::uint32_t x_count, std::uint32_t y_count, std::uint32_t z_count) {
  const auto groups = [](std::uint32_t items, std::uint32_t size) { return items / size + (items % size != 0); };
  const auto& size = compiled_->group_size;
  return dispatchGroups(groups(x_count, size[0]), groups(y_count, size[1]), groups(z_count, size[2]));
}

bool Program::dispatchGroups(std::uint32_t x_count, std::uint32_t y_count, std::uint32_t z_count) {
  assert(compiled_ && ctx_->isOwnedHere());
  const DeviceLimits& limits = ctx_->limits();
  if (x_count > limits.max_work_group_count_x || y_count > limits.max_work_group_count_y ||
      z_count > limits.max_work_group_count_z) {
    ctx_->countError();
    spdlog::error("{}: {} x {} x {} work groups exceed the device's {} x {} x {}; nothing runs", path_, x_count,
                  y_count, z_count, limits.max_work_group_count_x, limits.max_work_group_count_y,
                  limits.max_work_group_count_z);
    return false;
  }
  if (x_count == 0 || y_count == 0 || z_count == 0) return true;
  prepare(nullptr);
  run([&] { glDispatchCompute(x_count, y_count, z_count); });
  return true;
}

void Program::dispatchIndirect(const Buffer& arguments, std::size_t offset_bytes) {
  assert(compiled_ && ctx_->isOwnedHere());
  assert(offset_bytes % 4 == 0 && offset_bytes + 12 <= arguments.sizeBytes());
  prepare(&arguments);
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, arguments.id());
  run([&] { glDispatchComputeIndirect(static_cast<GLintptr>(offset_bytes)); });
}

void Program::run(const auto& dispatch) {
  DispatchTimes* const times = ctx_->dispatchTimes();
  if (times) times->begin(path_);
  dispatch();
  if (times) times->end();
  ++ctx_->ledgerEntry().dispatch_count;
}

void Program::prepare(const Buffer* arguments) {
  // Replace the values of the other Program that shares the compiled one; uniforms never set here become zero.
  if (compiled_->uniforms_of != handle_) {
    for (const auto& [name, zero] : compiled_->touched) {
      const auto own = uniforms_.find(name);
      apply(compiled_->id, location(name), own == uniforms_.end() ? zero : own->second);
    }
    compiled_->uniforms_of = handle_;
  }
  ctx_->beforeDispatch(compiled_->uses, arguments ? arguments->access() : nullptr);
  glUseProgram(compiled_->id);
}

std::int32_t Program::location(std::string_view name) {
  assert(compiled_ && ctx_->isOwnedHere());
  auto& locations = compiled_->locations;
  if (const auto known = locations.find(name); known != locations.end()) return known->second;
  const std::string key(name);
  const GLint found = glGetUniformLocation(compiled_->id, key.c_str());
  if (found < 0 && findShader(path_)->text.find(name) == std::string_view::npos) {
    spdlog::error("{} has no uniform \"{}\"", path_, name);
    ctx_->countError();
    assert(false && "uniform name that the shader does not contain");
  }
  locations.emplace(key, found);
  return found;
}

void Program::setUniform(std::string_view name, UniformValue value) {
  const std::int32_t at = location(name);
  if (at < 0) return;
  uniforms_.insert_or_assign(std::string(name), value);
  if (compiled_->uniforms_of == handle_) apply(compiled_->id, at, value);
  std::visit([](auto& number) { number = 0; }, value);
  compiled_->touched.insert_or_assign(std::string(name), value);
}

std::map<std::string, BlockLayout> Program::blocks() const {
  assert(compiled_ && ctx_->isOwnedHere());
  return blocksOf(compiled_->id);
}

}  // namespace spindrift::gpu
