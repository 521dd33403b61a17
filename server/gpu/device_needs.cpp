#include "device_needs.h"

#include <utility>

namespace spindrift::gpu {

std::string missingLimits(const DeviceLimits& limits, const DeviceLimits& needs) {
  using Member = std::int64_t DeviceLimits::*;
  constexpr std::pair<Member, const char*> kMembers[] = {
      {&DeviceLimits::max_ssbo_bytes, "GL_MAX_SHADER_STORAGE_BLOCK_SIZE"},
      {&DeviceLimits::max_texel_buffer_elements, "GL_MAX_TEXTURE_BUFFER_SIZE"},
      {&DeviceLimits::max_uniform_block_bytes, "GL_MAX_UNIFORM_BLOCK_SIZE"},
      {&DeviceLimits::max_work_group_invocations, "GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS"},
      {&DeviceLimits::max_work_group_count_x, "GL_MAX_COMPUTE_WORK_GROUP_COUNT[0]"},
      {&DeviceLimits::max_work_group_count_y, "GL_MAX_COMPUTE_WORK_GROUP_COUNT[1]"},
      {&DeviceLimits::max_work_group_count_z, "GL_MAX_COMPUTE_WORK_GROUP_COUNT[2]"},
      {&DeviceLimits::max_shared_memory_bytes, "GL_MAX_COMPUTE_SHARED_MEMORY_SIZE"},
      {&DeviceLimits::max_ssbo_bindings, "GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS"},
      {&DeviceLimits::max_compute_ssbo_blocks, "GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS"},
      {&DeviceLimits::max_compute_texture_units, "GL_MAX_COMPUTE_TEXTURE_IMAGE_UNITS"},
      {&DeviceLimits::max_combined_texture_units, "GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS"}};
  std::string out;
  for (const auto& [member, name] : kMembers) {
    if (limits.*member >= needs.*member) continue;
    if (!out.empty()) out += ", ";
    out += std::string(name) + " is " + std::to_string(limits.*member) + ", at least " + std::to_string(needs.*member) +
           " is needed";
  }
  return out;
}

}  // namespace spindrift::gpu
