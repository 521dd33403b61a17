#include "device_needs.h"

#include <glad/gl.h>

namespace spindrift::gpu {
namespace {

struct Limit {
  std::int64_t DeviceLimits::*member;
  GLenum gl_name;
  const char* text;
  GLuint axis = 0;  ///< of a limit with three values
};

#define SPINDRIFT_LIMIT(name) name, #name
constexpr GLenum kGroupCount = GL_MAX_COMPUTE_WORK_GROUP_COUNT;
constexpr Limit kLimits[] = {
    {&DeviceLimits::max_ssbo_bytes, SPINDRIFT_LIMIT(GL_MAX_SHADER_STORAGE_BLOCK_SIZE)},
    {&DeviceLimits::max_texel_buffer_elements, SPINDRIFT_LIMIT(GL_MAX_TEXTURE_BUFFER_SIZE)},
    {&DeviceLimits::max_uniform_block_bytes, SPINDRIFT_LIMIT(GL_MAX_UNIFORM_BLOCK_SIZE)},
    {&DeviceLimits::max_work_group_invocations, SPINDRIFT_LIMIT(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS)},
    {&DeviceLimits::max_work_group_count_x, kGroupCount, "GL_MAX_COMPUTE_WORK_GROUP_COUNT[0]", 0},
    {&DeviceLimits::max_work_group_count_y, kGroupCount, "GL_MAX_COMPUTE_WORK_GROUP_COUNT[1]", 1},
    {&DeviceLimits::max_work_group_count_z, kGroupCount, "GL_MAX_COMPUTE_WORK_GROUP_COUNT[2]", 2},
    {&DeviceLimits::max_shared_memory_bytes, SPINDRIFT_LIMIT(GL_MAX_COMPUTE_SHARED_MEMORY_SIZE)},
    {&DeviceLimits::max_ssbo_bindings, SPINDRIFT_LIMIT(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS)},
    {&DeviceLimits::max_compute_ssbo_blocks, SPINDRIFT_LIMIT(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS)},
    {&DeviceLimits::max_compute_texture_units, SPINDRIFT_LIMIT(GL_MAX_COMPUTE_TEXTURE_IMAGE_UNITS)},
    {&DeviceLimits::max_combined_texture_units, SPINDRIFT_LIMIT(GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS)}};

}  // namespace

DeviceLimits currentLimits() {
  DeviceLimits out;
  for (const Limit& limit : kLimits) {
    GLint64 value = 0;
    if (limit.gl_name == kGroupCount)
      glGetInteger64i_v(limit.gl_name, limit.axis, &value);
    else
      glGetInteger64v(limit.gl_name, &value);
    out.*limit.member = value;
  }
  return out;
}

std::string missingLimits(const DeviceLimits& limits, const DeviceLimits& needs) {
  std::string out;
  for (const Limit& limit : kLimits) {
    const std::int64_t value = limits.*limit.member, needed = needs.*limit.member;
    if (value >= needed) continue;
    if (!out.empty()) out += ", ";
    out += std::string(limit.text) + " is " + std::to_string(value) + ", at least " + std::to_string(needed) +
           " is needed";
  }
  return out;
}

}  // namespace spindrift::gpu
