#include <algorithm>
#include <charconv>

#include <spindrift/gpu/embedded_shader.h>

namespace spindrift::gpu {
namespace {

/// Removes an unsigned number from the start of `text`; returns false if it begins with no digit.
bool takeNumber(std::string_view& text, std::uint32_t& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc()) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

bool takeChar(std::string_view& text, char wanted) {
  if (text.empty() || text.front() != wanted) return false;
  text.remove_prefix(1);
  return true;
}

/// Translates one line of a log; unchanged when it does not start with a position.
std::string translateLine(const EmbeddedShader& shader, std::string_view line) {
  std::string_view rest = line;
  std::uint32_t source = 0;
  std::uint32_t number = 0;
  std::uint32_t column = 0;
  if (!takeNumber(rest, source) || source != 0) return std::string(line);
  if (takeChar(rest, ':')) {  // 0:12(5): error: …
    if (!takeNumber(rest, number)) return std::string(line);
    if (takeChar(rest, '(') && !(takeNumber(rest, column) && takeChar(rest, ')'))) return std::string(line);
  } else if (!(takeChar(rest, '(') && takeNumber(rest, number) && takeChar(rest, ')'))) {  // 0(12) : error …
    return std::string(line);
  }
  while (takeChar(rest, ' ') || takeChar(rest, ':')) {
  }
  return sourcePosition(shader, number) + ": " + std::string(rest);
}

}  // namespace

const EmbeddedShader* findShader(std::string_view path) {
  const auto shaders = embeddedShaders();
  const auto found = std::lower_bound(shaders.begin(), shaders.end(), path,
                                      [](const EmbeddedShader& s, std::string_view p) { return s.path < p; });
  return found != shaders.end() && found->path == path ? &*found : nullptr;
}

std::string sourcePosition(const EmbeddedShader& shader, std::uint32_t line) {
  const auto after = std::upper_bound(shader.lines.begin(), shader.lines.end(), line,
                                      [](std::uint32_t l, const LineRange& r) { return l < r.first_line; });
  if (after == shader.lines.begin()) return std::string(shader.path) + " (defines)";
  const LineRange& range = *(after - 1);
  return std::string(range.file) + ":" + std::to_string(range.file_line + (line - range.first_line));
}

std::string translateLog(const EmbeddedShader& shader, std::string_view log) {
  std::string out;
  while (!log.empty()) {
    const std::size_t end = std::min(log.find('\n'), log.size());
    const std::string_view line = log.substr(0, end);
    log.remove_prefix(std::min(end + 1, log.size()));
    if (line.find_first_not_of(" \t\r") == std::string_view::npos || line.front() == '\0') continue;
    if (!out.empty()) out += '\n';
    out += translateLine(shader, line);
  }
  return out;
}

}  // namespace spindrift::gpu
