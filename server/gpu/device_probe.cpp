// Tests whether a device really does what the program needs.
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include <glad/gl.h>

#include <spindrift/gpu/embedded_shader.h>

#include "device_needs.h"
#include "device_selection.h"
#include "gl_errors.h"

namespace spindrift::gpu {
namespace {

constexpr std::uint32_t kGroup = 32;
constexpr std::uint32_t kItems = 64;
constexpr std::uint32_t kFactor = 3;

/// GL objects of the probe, deleted at its end. Uses OpenGL directly, because there is no Context yet.
struct Objects {
  GLuint program = 0;
  GLuint texture = 0;
  std::array<GLuint, 5> buffers{};  ///< uniforms, texels, stored, result, arguments
  ~Objects() {
    glUseProgram(0);
    glDeleteProgram(program);
    glDeleteTextures(1, &texture);
    glDeleteBuffers(static_cast<GLsizei>(buffers.size()), buffers.data());
  }
};

/// Returns an empty string, or the compiler's or linker's message.
std::string compile(GLuint& program) {
  const EmbeddedShader* const shader = findShader("device/probe.comp");
  if (!shader) return "the probe's shader is not embedded";
  const std::string text = "#version 450 core\n#line 1\n" + std::string(shader->text);
  const char* const pointer = text.c_str();
  program = glCreateShaderProgramv(GL_COMPUTE_SHADER, 1, &pointer);
  GLint is_fine = GL_FALSE;
  if (program != 0) glGetProgramiv(program, GL_LINK_STATUS, &is_fine);
  if (is_fine) return {};
  std::array<char, 512> log{};
  GLsizei length = 0;
  if (program != 0) glGetProgramInfoLog(program, static_cast<GLsizei>(log.size()), &length, log.data());
  std::string said = translateLog(*shader, std::string_view(log.data(), static_cast<std::size_t>(length)));
  std::ranges::replace(said, '\n', ' ');
  return "does not compile: " + (said.empty() ? "the driver does not say why" : said);
}

/// Runs shaders/device/probe.comp in the current context and checks its result: storage and texel reads, a uniform
/// block, shared memory with a barrier, atomics and an indirect dispatch. Returns an empty string on success, otherwise
/// one line.
std::string runProbe() {
  clearOldErrors();
  Objects objects;
  if (std::string problem = compile(objects.program); !problem.empty()) return problem;

  std::vector<std::uint32_t> texels(kItems);
  std::vector<std::uint32_t> stored(kItems);
  for (std::uint32_t i = 0; i < kItems; ++i) {
    texels[i] = 7 * i + 1;
    stored[i] = 1000 * i;
  }
  const std::array<std::uint32_t, 4> uniforms = {kFactor, 0, 0, 0};
  const std::vector<std::uint32_t> nothing(1 + kItems, 0);
  const std::array<std::uint32_t, 3> groups = {kItems / kGroup, 1, 1};
  const auto fill = [](GLuint id, const auto& values) {
    glNamedBufferStorage(id, static_cast<GLsizeiptr>(values.size() * sizeof(values[0])), values.data(), 0);
  };
  glCreateBuffers(static_cast<GLsizei>(objects.buffers.size()), objects.buffers.data());
  fill(objects.buffers[0], uniforms);
  fill(objects.buffers[1], texels);
  fill(objects.buffers[2], stored);
  fill(objects.buffers[3], nothing);
  fill(objects.buffers[4], groups);
  glCreateTextures(GL_TEXTURE_BUFFER, 1, &objects.texture);
  glTextureBuffer(objects.texture, GL_R32UI, objects.buffers[1]);

  glBindBufferBase(GL_UNIFORM_BUFFER, 0, objects.buffers[0]);
  glBindTextureUnit(2, objects.texture);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, objects.buffers[2]);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, objects.buffers[3]);
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, objects.buffers[4]);
  glUseProgram(objects.program);
  glDispatchComputeIndirect(0);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  std::vector<std::uint32_t> got(1 + kItems, 0);
  glGetNamedBufferSubData(objects.buffers[3], 0, static_cast<GLsizeiptr>(got.size() * 4), got.data());
  if (const GLenum error = glGetError(); error != GL_NO_ERROR) return "OpenGL error " + std::to_string(error);

  if (got[0] != kItems) {
    return "counts " + std::to_string(got[0]) + " invocations instead of " + std::to_string(kItems);
  }
  for (std::uint32_t i = 0; i < kItems; ++i) {
    std::uint32_t sum = 0;
    for (std::uint32_t k = 0; k < kGroup; ++k) sum += texels[i / kGroup * kGroup + k];
    const std::uint32_t expected = sum * kFactor + stored[i];
    if (got[1 + i] == expected) continue;
    return "computes " + std::to_string(got[1 + i]) + " instead of " + std::to_string(expected) + " in invocation " +
           std::to_string(i);
  }
  return {};
}

}  // namespace

egl::Attempt egl::openUsable(const Candidate& candidate) {
  Attempt attempt = open(candidate);
  if (!attempt.handles) {
    const std::string advice =
        fileAdvice(candidate.render_file.empty() ? candidate.drm_file : candidate.render_file, Machine::real());
    if (!advice.empty()) attempt.info.problem += "; " + advice;
    return attempt;
  }
  std::string problem = missingLimits(attempt.info.limits);
  if (problem.empty()) {
    problem = runProbe();
    if (!problem.empty()) problem = "the probe program " + problem;
  }
  if (problem.empty()) return attempt;
  close(*attempt.handles);
  attempt.handles.reset();
  attempt.info.problem = std::move(problem);
  return attempt;
}

}  // namespace spindrift::gpu
