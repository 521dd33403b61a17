#include <cassert>
#include <utility>

#include <glad/gl.h>
#include <spdlog/spdlog.h>

#include <spindrift/gpu/embedded_shader.h>
#include <spindrift/gpu/program.h>

namespace spindrift::gpu {
namespace {

constexpr std::string_view kVersionLine = "#version 450 core\n";  // the same as in embed_shaders.py

std::string shaderLog(GLuint id) {
  GLint length = 0;
  glGetShaderiv(id, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
  glGetShaderInfoLog(id, length, &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  return log;
}

std::string programLog(GLuint id) {
  GLint length = 0;
  glGetProgramiv(id, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
  glGetProgramInfoLog(id, length, &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  return log;
}

std::string resourceName(GLuint program, GLenum interface, GLuint index) {
  constexpr GLenum kLength = GL_NAME_LENGTH;
  GLint length = 0;
  glGetProgramResourceiv(program, interface, index, 1, &kLength, 1, nullptr, &length);
  std::string name(static_cast<std::size_t>(std::max(length, 1)), '\0');
  GLsizei written = 0;
  glGetProgramResourceName(program, interface, index, static_cast<GLsizei>(name.size()), &written, name.data());
  name.resize(static_cast<std::size_t>(written));
  return name;
}

void addBlocks(GLuint program, bool is_storage, std::map<std::string, BlockLayout>& out) {
  const GLenum interface = is_storage ? GL_SHADER_STORAGE_BLOCK : GL_UNIFORM_BLOCK;
  const GLenum member_interface = is_storage ? GL_BUFFER_VARIABLE : GL_UNIFORM;
  GLint count = 0;
  glGetProgramInterfaceiv(program, interface, GL_ACTIVE_RESOURCES, &count);
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    const std::string name = resourceName(program, interface, i);
    constexpr GLenum kProperties[] = {GL_BUFFER_BINDING, GL_BUFFER_DATA_SIZE, GL_NUM_ACTIVE_VARIABLES};
    GLint values[3] = {0, 0, 0};
    glGetProgramResourceiv(program, interface, i, 3, kProperties, 3, nullptr, values);
    BlockLayout block;
    block.is_storage = is_storage;
    block.binding = static_cast<std::uint32_t>(values[0]);
    block.size_bytes = static_cast<std::uint32_t>(values[1]);
    std::vector<GLint> members(static_cast<std::size_t>(values[2]));
    constexpr GLenum kMembers = GL_ACTIVE_VARIABLES;
    if (!members.empty()) {
      glGetProgramResourceiv(program, interface, i, 1, &kMembers, values[2], nullptr, members.data());
    }
    for (const GLint member : members) {
      const auto index = static_cast<GLuint>(member);
      std::string member_name = resourceName(program, member_interface, index);
      // Members of a block with an instance name come as "Block.member".
      if (member_name.starts_with(name + ".")) member_name.erase(0, name.size() + 1);
      constexpr GLenum kOffset = GL_OFFSET;
      GLint offset = 0;
      glGetProgramResourceiv(program, member_interface, index, 1, &kOffset, 1, nullptr, &offset);
      block.offsets.emplace(std::move(member_name), static_cast<std::uint32_t>(offset));
    }
    out.emplace(name, std::move(block));
  }
}

}  // namespace

core::Result<Program> Program::create(Context& ctx, std::string_view shader_path, const Defines& defines) {
  assert(ctx.isOwnedHere());
  const EmbeddedShader* embedded = findShader(shader_path);
  if (!embedded) {
    return core::Error{core::ErrorCode::kInternal,
                       "shader \"" + std::string(shader_path) + "\" is not embedded; embedded are " +
                           std::to_string(embeddedShaders().size()) + " files shaders/**/*.comp"};
  }
  std::string text(kVersionLine);
  for (const auto& [name, value] : defines) text += "#define " + name + " " + value + "\n";
  // The driver counts the lines of the expanded text, and all of it in one string: each string has its own number.
  text += "#line 1\n";
  text += embedded->text;

  const GLchar* const pointer = text.data();
  const auto length = static_cast<GLint>(text.size());
  const GLuint shader = glCreateShader(GL_COMPUTE_SHADER);
  glShaderSource(shader, 1, &pointer, &length);
  glCompileShader(shader);
  GLint is_fine = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &is_fine);
  const std::string log = translateLog(*embedded, shaderLog(shader));
  if (!is_fine) {
    glDeleteShader(shader);
    return core::Error{core::ErrorCode::kInternal, std::string(shader_path) + " does not compile: " + log};
  }
  if (!log.empty()) spdlog::debug("{}: {}", shader_path, log);

  Program program;
  program.id_ = glCreateProgram();
  program.ctx_ = &ctx;
  program.path_ = shader_path;
  ++ctx.ledgerEntry().program_count;
  ++ctx.ledgerEntry().programs_made_count;
  glAttachShader(program.id_, shader);
  glLinkProgram(program.id_);
  glDetachShader(program.id_, shader);
  glDeleteShader(shader);
  glGetProgramiv(program.id_, GL_LINK_STATUS, &is_fine);
  if (!is_fine) {
    return core::Error{core::ErrorCode::kInternal, std::string(shader_path) + " does not link: " +
                                                       translateLog(*embedded, programLog(program.id_))};
  }
  GLint size[3] = {0, 0, 0};
  glGetProgramiv(program.id_, GL_COMPUTE_WORK_GROUP_SIZE, size);
  for (std::size_t axis = 0; axis < 3; ++axis) program.group_size_[axis] = static_cast<std::uint32_t>(size[axis]);
  glObjectLabel(GL_PROGRAM, program.id_, static_cast<GLsizei>(shader_path.size()), shader_path.data());
  return program;
}

Program::~Program() {
  if (id_ == 0) return;
  assert(ctx_->isOwnedHere());
  glDeleteProgram(id_);
  --ctx_->ledgerEntry().program_count;
}

Program::Program(Program&& other) noexcept
    : ctx_(other.ctx_),
      id_(std::exchange(other.id_, 0)),
      path_(std::move(other.path_)),
      group_size_(other.group_size_),
      locations_(std::move(other.locations_)) {}

Program& Program::operator=(Program&& other) noexcept {
  // What this held goes with the temporary.
  Program moved(std::move(other));
  std::swap(ctx_, moved.ctx_);
  std::swap(id_, moved.id_);
  std::swap(path_, moved.path_);
  std::swap(group_size_, moved.group_size_);
  std::swap(locations_, moved.locations_);
  return *this;
}

bool Program::dispatch(std::uint32_t x_count, std::uint32_t y_count, std::uint32_t z_count) {
  const auto groups = [](std::uint32_t items, std::uint32_t size) { return items / size + (items % size != 0); };
  return dispatchGroups(groups(x_count, group_size_[0]), groups(y_count, group_size_[1]),
                        groups(z_count, group_size_[2]));
}

bool Program::dispatchGroups(std::uint32_t x_count, std::uint32_t y_count, std::uint32_t z_count) {
  assert(id_ != 0 && ctx_->isOwnedHere());
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
  glUseProgram(id_);
  glDispatchCompute(x_count, y_count, z_count);
  ++ctx_->ledgerEntry().dispatch_count;
  return true;
}

void Program::dispatchIndirect(const Buffer& arguments, std::size_t offset_bytes) {
  assert(id_ != 0 && ctx_->isOwnedHere());
  assert(offset_bytes % 4 == 0 && offset_bytes + 12 <= arguments.sizeBytes());
  glUseProgram(id_);
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, arguments.id());
  glDispatchComputeIndirect(static_cast<GLintptr>(offset_bytes));
  ++ctx_->ledgerEntry().dispatch_count;
}

std::int32_t Program::location(std::string_view name) {
  assert(id_ != 0 && ctx_->isOwnedHere());
  if (const auto known = locations_.find(name); known != locations_.end()) return known->second;
  const std::string key(name);
  const GLint found = glGetUniformLocation(id_, key.c_str());
  if (found < 0 && findShader(path_)->text.find(name) == std::string_view::npos) {
    spdlog::error("{} has no uniform \"{}\"", path_, name);
    ctx_->countError();
    assert(!"uniform name that the shader does not contain");
  }
  locations_.emplace(key, found);
  return found;
}

void Program::setUniform(std::string_view name, std::uint32_t value) {
  glProgramUniform1ui(id_, location(name), value);
}
void Program::setUniform(std::string_view name, std::int32_t value) {
  glProgramUniform1i(id_, location(name), value);
}
void Program::setUniform(std::string_view name, float value) {
  glProgramUniform1f(id_, location(name), value);
}

std::map<std::string, BlockLayout> Program::blocks() const {
  assert(id_ != 0 && ctx_->isOwnedHere());
  std::map<std::string, BlockLayout> out;
  addBlocks(id_, false, out);
  addBlocks(id_, true, out);
  return out;
}

}  // namespace spindrift::gpu
