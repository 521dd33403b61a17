#include "shader_folder.h"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <utility>

#include <spindrift/core/files.h>

namespace spindrift::gpu {
namespace {

namespace fs = std::filesystem;
using core::invalid;

constexpr auto kLookInterval = std::chrono::milliseconds(300);

/// Returns the text after `#NAME` in a line, without surrounding blanks; nullopt if the line is not this directive.
std::optional<std::string_view> directive(std::string_view line, std::string_view name) {
  const auto skipBlanks = [&line] { line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size())); };
  skipBlanks();
  if (!line.starts_with('#')) return std::nullopt;
  line.remove_prefix(1);
  skipBlanks();
  if (!line.starts_with(name)) return std::nullopt;
  line.remove_prefix(name.size());
  skipBlanks();
  return line;
}

/// Returns "SPINDRIFT_ONCE_coupling_splat_glsl" for "coupling/splat.glsl".
std::string guardOf(const std::string& name) {
  std::string out = "SPINDRIFT_ONCE_" + name;
  std::ranges::replace_if(
      out, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return out;
}

}  // namespace

ShaderFolder::ShaderFolder(fs::path root) : root_(std::move(root)), times_(times()) {}

core::Result<ShaderFolder::Source> ShaderFolder::expand(std::string_view entry) const {
  Source out;
  if (auto done = expand(std::string(entry), {}, out); !done) return done.error();
  return out;
}

core::Result<void> ShaderFolder::expand(const std::string& name, const std::vector<std::string>& stack,
                                        Source& out) const {
  if (std::ranges::find(stack, name) != stack.end()) return invalid("include cycle: " + stack.back() + " -> " + name);
  constexpr std::size_t kShaderMaxBytes = 1u << 20;
  const auto text = core::readText(root_ / name, kShaderMaxBytes, "a shader", "a shader is a small text");
  if (!text) return invalid("\"" + name + "\" below " + root_.string() + " " + text.error().message);
  std::istringstream file(*text);
  out.files.insert(name);
  std::vector<std::string> inside = stack;
  inside.push_back(name);
  const std::string& file_name = out.names.emplace_back(name);
  std::uint32_t number = 0;
  const auto add = [&](std::string_view line) {
    out.text.append(line).push_back('\n');
    out.lines.push_back({static_cast<std::uint32_t>(out.lines.size() + 1), file_name, number});
  };
  for (std::string line; std::getline(file, line);) {
    ++number;
    const std::string where = name + ":" + std::to_string(number);
    if (directive(line, "version")) return invalid(where + ": remove #version, the program puts it first");
    const auto included = directive(line, "include");
    // <...> is the C++ side of a header in shared/.
    const bool is_dropped = (directive(line, "pragma") == "once") || (included && included->starts_with('<'));
    if (!included || is_dropped) {
      add(is_dropped ? "" : line);
      continue;
    }
    const std::size_t end = included->find('"', 1);
    if (!included->starts_with('"') || end == std::string_view::npos)
      return invalid(where + ": write #include \"file\", relative to the shader folder");
    const std::string other(included->substr(1, end - 1));
    if (other.find("..") != std::string::npos || !fs::is_regular_file(root_ / other))
      return invalid(where + ": no file \"" + other + "\" below " + root_.string());
    // Includes a file once, at the first place that the preprocessor reaches.
    add("#ifndef " + guardOf(other));
    add("#define " + guardOf(other));
    if (auto done = expand(other, inside, out); !done) return done;
    add("#endif");
  }
  return {};
}

ShaderFolder::Times ShaderFolder::times() const {
  Times out;
  std::error_code error;
  for (fs::recursive_directory_iterator at(root_, error), end; !error && at != end; at.increment(error)) {
    std::error_code unread;
    if (const auto written = at->last_write_time(unread); !unread && at->is_regular_file(unread))
      out[at->path().lexically_relative(root_).generic_string()] = written;
  }
  return out;
}

std::set<std::string> ShaderFolder::takeChanged() {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_look_) return {};
  next_look_ = now + kLookInterval;
  Times fresh = times();
  std::set<std::string> out;
  for (const auto& [name, time] : fresh) {
    const auto known = times_.find(name);
    if (known == times_.end() || known->second != time) out.insert(name);
  }
  for (const auto& [name, time] : times_) {
    if (!fresh.contains(name)) out.insert(name);
  }
  times_ = std::move(fresh);
  return out;
}

}  // namespace spindrift::gpu
