#include "program_resources.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <glad/gl.h>

namespace spindrift::gpu {
namespace {

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

std::map<std::string, BlockLayout> blocksOf(std::uint32_t program_id) {
  std::map<std::string, BlockLayout> out;
  addBlocks(program_id, false, out);
  addBlocks(program_id, true, out);
  return out;
}

std::map<std::string, std::uint32_t> texelUnitsOf(std::uint32_t program_id) {
  std::map<std::string, std::uint32_t> out;
  GLint count = 0;
  glGetProgramInterfaceiv(program_id, GL_UNIFORM, GL_ACTIVE_RESOURCES, &count);
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    constexpr GLenum kProperties[] = {GL_TYPE, GL_LOCATION};
    GLint values[2] = {0, -1};
    glGetProgramResourceiv(program_id, GL_UNIFORM, i, 2, kProperties, 2, nullptr, values);
    const auto type = static_cast<GLenum>(values[0]);
    if (type != GL_SAMPLER_BUFFER && type != GL_INT_SAMPLER_BUFFER && type != GL_UNSIGNED_INT_SAMPLER_BUFFER) continue;
    GLint unit = 0;
    glGetUniformiv(program_id, values[1], &unit);
    out.emplace(resourceName(program_id, GL_UNIFORM, i), static_cast<std::uint32_t>(unit));
  }
  return out;
}

}  // namespace spindrift::gpu
