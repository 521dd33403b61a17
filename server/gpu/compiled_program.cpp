#include "compiled_program.h"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <chrono>
#include <iterator>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <glad/gl.h>
#include <spdlog/spdlog.h>

#include <spindrift/gpu/embedded_shader.h>

#include "device_needs.h"
#include "shader_folder.h"
#include "shuffled_groups.h"

namespace spindrift::gpu {
namespace {

constexpr std::string_view kVersionLine = "#version 450 core\n";  // the same as in embed_shaders.py

/// Returns the log of a shader or a program; `get` and `getLog`: OpenGL's functions for it.
std::string logOf(GLuint id, PFNGLGETPROGRAMIVPROC get, PFNGLGETPROGRAMINFOLOGPROC getLog) {
  GLint length = 0;
  get(id, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
  getLog(id, length, &length, log.data());
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

/// With `has_offsets`, also those of the members, for which drivers search their lists of all members: half of the time
/// of a program that comes from a cache.
void addBlocks(GLuint program, bool is_storage, bool has_offsets, std::map<std::string, BlockLayout>& out) {
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
    std::vector<GLint> members(has_offsets ? static_cast<std::size_t>(values[2]) : 0);
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

/// Returns the texture unit of each used samplerBuffer, usamplerBuffer and isamplerBuffer, by name. The names are those
/// of the text: where a program lists its uniforms, drivers search all of its members for each.
std::map<std::string, std::uint32_t> texelUnitsOf(GLuint program, std::string_view text) {
  constexpr std::string_view kType = "samplerBuffer ";
  std::map<std::string, std::uint32_t> out;
  for (std::size_t at = text.find(kType); at != std::string_view::npos; at = text.find(kType, at + 1)) {
    const std::string_view rest = text.substr(at + kType.size());
    const std::string name(rest.substr(0, rest.find(';')));
    const GLint location = glGetUniformLocation(program, name.c_str());
    if (location < 0) continue;  // not used
    GLint unit = 0;
    glGetUniformiv(program, location, &unit);
    out.emplace(name, static_cast<std::uint32_t>(unit));
  }
  return out;
}

bool isWord(char c) {
  return c == '_' || std::isalnum(static_cast<unsigned char>(c)) != 0;
}

/// Returns the defines that the shader can use. Another one would make the same program from a different text, which
/// drivers compile anew: to Mesa the digest of the text is part of the program.
Defines usedIn(const EmbeddedShader& shader, const Defines& defines) {
  Defines out;
  std::ranges::copy_if(defines, std::back_inserter(out), [&](const auto& define) {
    return std::ranges::binary_search(shader.names, std::string_view(define.first));
  });
  return out;
}

std::string linesOf(const Defines& defines) {
  std::string out;
  for (const auto& [name, value] : defines) out += "#define " + name + " " + value + "\n";
  return out;
}

/// Reads the qualifiers of the storage block from the text: `restrict readonly buffer Name {`. OpenGL has no query for
/// them. A block declared several times, under different conditions, is read or written if any declaration allows it.
void readQualifiers(std::string_view text, ProgramUses::Block& block) {
  const std::string wanted = "buffer " + block.name;
  bool is_found = false;
  bool is_read = false;
  bool is_written = false;
  for (std::size_t at = text.find(wanted); at != std::string_view::npos; at = text.find(wanted, at + 1)) {
    const std::size_t end = at + wanted.size();
    if ((end < text.size() && isWord(text[end])) || (at > 0 && isWord(text[at - 1]))) continue;
    const std::size_t begin = text.find_last_of(";{})\n", at);
    const std::string_view qualifiers = text.substr(begin == std::string_view::npos ? 0 : begin, at - begin);
    is_found = true;
    is_read |= qualifiers.find("writeonly") == std::string_view::npos;
    is_written |= qualifiers.find("readonly") == std::string_view::npos;
  }
  block.is_read = is_read || !is_found;
  block.is_written = is_written || !is_found;
}

ProgramUses usesOf(GLuint program, const EmbeddedShader& shader) {
  ProgramUses uses;
  uses.path = shader.path;
  for (auto& [name, layout] : blocksOf(program, false)) {
    ProgramUses::Block block{.name = name, .binding = layout.binding, .size_bytes = layout.size_bytes};
    if (layout.is_storage) readQualifiers(shader.text, block);
    (layout.is_storage ? uses.storage : uses.uniforms).push_back(std::move(block));
  }
  for (const auto& [name, unit] : texelUnitsOf(program, shader.text))
    uses.texels.push_back({.name = name, .binding = unit});
  return uses;
}

/// Waits until the driver has compiled the linked program, where it must not compile two at a time. Mesa's zink
/// compiles on up to four threads, which allocate below one shared object without a lock (ralloc on the screen in
/// create_layout() and descriptor_util_pool_key_get() of zink_descriptors.c, Mesa 22.3): rarely, the heap is damaged.
void waitForCompiler(const Context& ctx, GLuint program) {
  if (!ctx.device().name.starts_with("zink")) return;
  constexpr GLenum kCompletionStatus = 0x91B1;  // GL_COMPLETION_STATUS_KHR of KHR_parallel_shader_compile
  for (;;) {
    GLint is_complete = GL_TRUE;  // stays so if the driver does not know the query
    glGetProgramiv(program, kCompletionStatus, &is_complete);
    if (is_complete) return;
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
}

/// Returns the identity of a program on disk: another driver, or another version of it, compiles anew.
std::string storeKey(const DeviceInfo& device, const EmbeddedShader& shader, std::string_view defines) {
  return fmt::format("{}\n{}\n{}\n{}{}\n{}", device.vendor, device.name, device.gl_version, kVersionLine, shader.digest,
                     defines);
}

/// Drivers without formats keep nothing; Mesa's have one where Mesa's own cache of shaders works.
std::vector<GLint> binaryFormats() {
  GLint count = 0;
  glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &count);
  std::vector<GLint> out(static_cast<std::size_t>(std::max(count, 0)));
  if (!out.empty()) glGetIntegerv(GL_PROGRAM_BINARY_FORMATS, out.data());
  return out;
}

/// Returns the linked program from its file, or 0.
GLuint fromStore(Context& ctx, std::string_view key, std::string_view shader_path) {
  const auto kept = ctx.programs().store().load(key);
  if (!kept) return 0;
  const GLuint id = glCreateProgram();
  GLint is_fine = GL_FALSE;
  // A format that the driver does not know would be an OpenGL error.
  if (std::ranges::count(binaryFormats(), static_cast<GLint>(kept->format)) > 0) {
    glProgramBinary(id, kept->format, kept->bytes.data(), static_cast<GLsizei>(kept->bytes.size()));
    waitForCompiler(ctx, id);
    glGetProgramiv(id, GL_LINK_STATUS, &is_fine);
  }
  if (is_fine) return id;
  glDeleteProgram(id);
  spdlog::info("{}: the driver does not take the program that was compiled earlier; it is compiled again", shader_path);
  return 0;
}

void keep(ProgramStore& store, std::string_view key, GLuint program) {
  GLint size_bytes = 0;
  glGetProgramiv(program, GL_PROGRAM_BINARY_LENGTH, &size_bytes);
  if (size_bytes <= 0) return;
  ProgramStore::Binary binary;
  binary.bytes.resize(static_cast<std::size_t>(size_bytes));
  glGetProgramBinary(program, size_bytes, &size_bytes, &binary.format, binary.bytes.data());
  binary.bytes.resize(static_cast<std::size_t>(size_bytes));
  store.save(key, binary);
}

/// Checks the program against the limits that Context::create() requires of a device.
void checkNeeds(Context& ctx, const CompiledProgram& program) {
  const auto over = [&](const char* what, std::int64_t used, std::int64_t stated) {
    if (used <= stated) return;
    ctx.countError();
    spdlog::error("{} uses {} = {}, but devices are checked for {} only: raise it in device_needs.h", program.uses.path,
                  what, used, stated);
  };
  const DeviceLimits& needs = kNeededLimits;
  std::int64_t binding_count = 0;
  std::int64_t unit_count = 0;
  for (const auto& block : program.uses.storage)
    binding_count = std::max<std::int64_t>(binding_count, block.binding + 1);
  for (const auto& unit : program.uses.texels) unit_count = std::max<std::int64_t>(unit_count, unit.binding + 1);
  over("storage bindings", binding_count, needs.max_ssbo_bindings);
  over("texture units", unit_count, needs.max_combined_texture_units);
  over("storage blocks", std::ssize(program.uses.storage), needs.max_compute_ssbo_blocks);
  over("samplers", std::ssize(program.uses.texels), needs.max_compute_texture_units);
  for (const auto& block : program.uses.uniforms) {
    over("uniform block bytes", block.size_bytes, needs.max_uniform_block_bytes);
  }
  const auto& g = program.group_size;
  over("invocations of a work group", std::int64_t{g[0]} * g[1] * g[2], needs.max_work_group_invocations);
}

/// Returns the linked program with its group size, blocks and files.
std::shared_ptr<CompiledProgram> finished(Context& ctx, std::shared_ptr<CompiledProgram> program,
                                          const EmbeddedShader& source, std::set<std::string> files) {
  ++ctx.ledgerEntry().programs_made_count;
  GLint size[3] = {0, 0, 0};
  glGetProgramiv(program->id, GL_COMPUTE_WORK_GROUP_SIZE, size);
  for (std::size_t axis = 0; axis < 3; ++axis) program->group_size[axis] = static_cast<std::uint32_t>(size[axis]);
  glObjectLabel(GL_PROGRAM, program->id, static_cast<GLsizei>(source.path.size()), source.path.data());
  program->uses = usesOf(program->id, source);
  checkNeeds(ctx, *program);
  program->files = std::move(files);
  return program;
}

/// `log`: the driver's, with files and lines. With a folder of shaders its text is at fault, not the driver.
core::Error refused(const Context& ctx, std::string_view shader_path, const char* verb, const std::string& log) {
  const DeviceInfo& device = ctx.device();
  return {core::ErrorCode::kInternal,
          std::string(shader_path) + " does not " + verb + " on " + device.name + " (" + device.gl_version +
              "): " + log +
              (ctx.shaderFolder() ? "; correct the file"
                                  : "; update the driver or use --device software, and report this line")};
}

}  // namespace

std::map<std::string, BlockLayout> blocksOf(std::uint32_t program_id, bool has_offsets) {
  std::map<std::string, BlockLayout> out;
  for (const bool is_storage : {false, true}) addBlocks(program_id, is_storage, has_offsets, out);
  return out;
}

core::Result<std::shared_ptr<CompiledProgram>> CompiledProgram::compile(Context& ctx, std::string_view shader_path,
                                                                        const Defines& defines) {
  assert(ctx.isOwnedHere());
  const EmbeddedShader* const embedded = findShader(shader_path);
  if (!embedded) {
    return core::Error{core::ErrorCode::kInternal,
                       "shader \"" + std::string(shader_path) + "\" is not embedded; embedded are " +
                           std::to_string(embeddedShaders().size()) + " files shaders/**/*.comp"};
  }
  EmbeddedShader source = *embedded;
  ShaderFolder::Source read;
  if (const ShaderFolder* const folder = ctx.shaderFolder()) {
    auto expanded = folder->expand(shader_path);
    if (!expanded) return expanded.error();
    read = *std::move(expanded);
    source.text = read.text;
    source.lines = read.lines;
  }
  Defines all = ctx.tuning().defines();
  if (!ctx.shaderFolder()) all = usedIn(*embedded, all);
  all.insert(all.end(), defines.begin(), defines.end());
  const std::string define_lines = linesOf(all);

  ProgramStore& store = ctx.programs().store();
  const std::string key = store.isOn() ? storeKey(ctx.device(), source, define_lines) : std::string{};
  auto program = std::make_shared<CompiledProgram>();
  if (store.isOn()) program->id = fromStore(ctx, key, shader_path);
  if (program->id != 0) return finished(ctx, std::move(program), source, std::move(read.files));

  // The whole text is one string, because each source string has its own number in driver messages.
  const std::uint32_t shuffle_seed = ctx.checks().shuffle_seed;
  const std::string text = std::string(kVersionLine) + define_lines + "#line 1\n" +
                           (shuffle_seed == 0 ? std::string(source.text) : shuffledGroups(source.text, shuffle_seed));
  const GLchar* const pointer = text.data();
  const auto length = static_cast<GLint>(text.size());
  const GLuint shader = glCreateShader(GL_COMPUTE_SHADER);
  glShaderSource(shader, 1, &pointer, &length);
  glCompileShader(shader);
  GLint is_fine = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &is_fine);
  const std::string log = translateLog(source, logOf(shader, glGetShaderiv, glGetShaderInfoLog));
  if (!is_fine) {
    glDeleteShader(shader);
    return refused(ctx, shader_path, "compile", log);
  }
  if (!log.empty()) spdlog::debug("{}: {}", shader_path, log);

  program->id = glCreateProgram();
  if (store.isOn()) glProgramParameteri(program->id, GL_PROGRAM_BINARY_RETRIEVABLE_HINT, GL_TRUE);
  glAttachShader(program->id, shader);
  glLinkProgram(program->id);
  glDetachShader(program->id, shader);
  glDeleteShader(shader);
  waitForCompiler(ctx, program->id);
  glGetProgramiv(program->id, GL_LINK_STATUS, &is_fine);
  if (!is_fine) {
    return refused(ctx, shader_path, "link",
                   translateLog(source, logOf(program->id, glGetProgramiv, glGetProgramInfoLog)));
  }
  if (store.isOn()) keep(store, key, program->id);
  return finished(ctx, std::move(program), source, std::move(read.files));
}

void CompiledProgram::become(CompiledProgram& fresh) {
  std::swap(id, fresh.id);
  std::swap(uses, fresh.uses);
  std::swap(files, fresh.files);
  locations.clear();
  uniforms_of = 0;
}

CompiledProgram::~CompiledProgram() {
  if (id != 0) glDeleteProgram(id);
}

core::Result<std::shared_ptr<CompiledProgram>> ProgramCache::get(Context& ctx, std::string_view shader_path,
                                                                 const Defines& all_defines) {
  // A file of a folder may use other ones when it is read again.
  const EmbeddedShader* const embedded = ctx.shaderFolder() ? nullptr : findShader(shader_path);
  const Defines defines = embedded ? usedIn(*embedded, all_defines) : all_defines;
  const auto known = std::ranges::find_if(
      entries_, [&](const Entry& entry) { return entry.shader_path == shader_path && entry.defines == defines; });
  if (known != entries_.end()) {
    entries_.splice(entries_.end(), entries_, known);
    return known->program;
  }
  auto compiled = CompiledProgram::compile(ctx, shader_path, defines);
  if (!compiled) return compiled.error();
  dropUnused();
  entries_.push_back({std::string(shader_path), defines, *compiled});
  return *compiled;
}

void ProgramCache::reload(Context& ctx, const std::set<std::string>& files) {
  for (const Entry& entry : entries_) {
    const auto is_changed = [&](const std::string& file) { return files.contains(file); };
    if (std::ranges::none_of(entry.program->files, is_changed)) continue;
    auto fresh = CompiledProgram::compile(ctx, entry.shader_path, entry.defines);
    if (!fresh) {
      spdlog::error("{}; the old program stays in use", fresh.error().message);
    } else if ((*fresh)->group_size != entry.program->group_size) {
      spdlog::error("{}: a change of the group size needs a restart; the old program stays in use", entry.shader_path);
    } else {
      entry.program->become(**fresh);
      spdlog::info("{}: recompiled", entry.shader_path);
    }
  }
}

void ProgramCache::dropUnused() {
  std::size_t unused = static_cast<std::size_t>(
      std::ranges::count_if(entries_, [](const Entry& entry) { return entry.program.use_count() == 1; }));
  for (auto entry = entries_.begin(); entry != entries_.end() && unused >= kMaxUnused;) {
    if (entry->program.use_count() > 1) {
      ++entry;
      continue;
    }
    entry = entries_.erase(entry);
    --unused;
  }
}

}  // namespace spindrift::gpu
