#include "thesis_particles.h"

#include <algorithm>
#include <utility>

#include <glad/gl.h>

#include <spindrift/gpu/embedded_shader.h>

namespace spindrift::gpu {

/// Generated from tests/bench/thesis.
std::span<const EmbeddedShader> thesisShaders();

}  // namespace spindrift::gpu

namespace spindrift::bench {
namespace {

constexpr std::int64_t kGroupSize = 1024;
constexpr std::uint32_t kScanLevels = 15;
constexpr std::uint32_t kCells = 1u << kScanLevels;  // 32^3

}  // namespace

ThesisParticles::ThesisParticles(gpu::Context& ctx, std::uint32_t count)
    : ctx_(ctx),
      count_(count),
      group_(static_cast<std::uint32_t>(std::min(kGroupSize, ctx.limits().max_work_group_invocations))) {}

core::Result<std::unique_ptr<ThesisParticles>> ThesisParticles::create(gpu::Context& ctx, const gpu::Defines& defines,
                                                                       std::uint32_t count, core::CellCounts wave_count,
                                                                       std::span<const WaveTexel> wave) {
  std::unique_ptr<ThesisParticles> out(new ThesisParticles(ctx, count));
  ThesisParticles& t = *out;
  for (const auto& [buffer, name, size_bytes] :
       {std::tuple{&t.particles_, "thesis particles", sizeof(Particle) * count},
        std::tuple{&t.cell_count_, "thesis count", sizeof(std::uint32_t) * kCells},
        std::tuple{&t.cell_start_, "thesis start", sizeof(std::uint32_t) * kCells},
        std::tuple{&t.contents_, "thesis contents", sizeof(std::uint32_t) * count}}) {
    auto made = gpu::Buffer::create(ctx, name, size_bytes);
    if (!made) return made.error();
    *buffer = *std::move(made);
  }
  for (const auto& [program, path] : {std::pair{&t.count_pass_, "count.comp"}, std::pair{&t.scan_up_, "scan_up.comp"},
                                      std::pair{&t.scan_down_, "scan_down.comp"}, std::pair{&t.fill_, "fill.comp"},
                                      std::pair{&t.density_, "density.comp"}, std::pair{&t.force_, "force.comp"},
                                      std::pair{&t.integrate_, "integrate.comp"}}) {
    if (auto compiled = t.compile(*program, path, defines); !compiled) return compiled.error();
  }
  if (!wave.empty()) {
    glCreateTextures(GL_TEXTURE_2D, 1, &t.wave_);
    const auto x = static_cast<GLsizei>(wave_count.x);
    const auto z = static_cast<GLsizei>(wave_count.z);
    glTextureStorage2D(t.wave_, 1, GL_RGBA32F, x, z);
    glTextureSubImage2D(t.wave_, 0, 0, 0, x, z, GL_RGBA, GL_FLOAT, wave.data());
  }
  return out;
}

ThesisParticles::~ThesisParticles() {
  for (const std::uint32_t program : {count_pass_, scan_up_, scan_down_, fill_, density_, force_, integrate_})
    glDeleteProgram(program);
  glDeleteTextures(1, &wave_);
}

core::Result<void> ThesisParticles::compile(std::uint32_t& program, const std::string& path,
                                            const gpu::Defines& defines) {
  const auto shaders = gpu::thesisShaders();
  const auto shader = std::ranges::find(shaders, path, &gpu::EmbeddedShader::path);
  std::string text = "#version 450 core\n#define GROUP " + std::to_string(group_) + "\n";
  for (const auto& [name, value] : defines) text += "#define " + name + " " + value + "\n";
  text += "#line 1\n" + std::string(shader->text);
  const char* const pointer = text.c_str();
  program = glCreateShaderProgramv(GL_COMPUTE_SHADER, 1, &pointer);
  GLint is_linked = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &is_linked);
  if (is_linked) return {};
  std::string log(4096, '\0');
  GLsizei length = 0;
  glGetProgramInfoLog(program, static_cast<GLsizei>(log.size()), &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  return core::Error{core::ErrorCode::kInternal, "tests/bench/thesis/" + path + ": " + gpu::translateLog(*shader, log)};
}

void ThesisParticles::setState(std::span<const float> position, std::span<const float> velocity) {
  std::vector<Particle> particles(count_);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    std::copy_n(position.data() + 4 * i, 3, particles[i].position_m.data());
    std::copy_n(velocity.data() + 4 * i, 3, particles[i].velocity_mps.data());
  }
  particles_.upload(particles);
}

void ThesisParticles::run(std::uint32_t program, std::uint32_t items) {
  glUseProgram(program);
  glDispatchCompute((items + group_ - 1) / group_, 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void ThesisParticles::step() {
  particles_.bindStorage(0);
  cell_count_.bindStorage(1);
  cell_start_.bindStorage(2);
  contents_.bindStorage(3);
  if (wave_) glBindTextureUnit(0, wave_);
  // The grid.
  run(count_pass_, count_);
  for (std::uint32_t level = 0; level < kScanLevels; ++level) {
    glProgramUniform1ui(scan_up_, 0, level);
    run(scan_up_, kCells >> (level + 1));
  }
  for (std::uint32_t level = kScanLevels; level-- > 0;) {
    glProgramUniform1ui(scan_down_, 0, level);
    run(scan_down_, kCells >> (level + 1));
  }
  run(fill_, count_);
  // SPH.
  run(density_, count_);
  run(force_, count_);
  run(integrate_, count_);
}

std::vector<ThesisParticles::Particle> ThesisParticles::download() {
  ctx_.barrier(gpu::Barrier::kBufferUpdate);
  return particles_.downloadVector<Particle>(count_);
}

}  // namespace spindrift::bench
