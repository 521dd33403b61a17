#include <cerrno>
#include <cstring>
#include <set>
#include <string_view>
#include <system_error>
#include <vector>

#include <spindrift/core/files.h>

namespace spindrift::core {

namespace fs = std::filesystem;

namespace {

/// Returns the name of an encoding other than UTF-8: told by its byte order mark, or by the zero bytes of two
/// characters of ASCII, with which all texts here begin. Empty for UTF-8.
std::string otherEncoding(std::string_view text) {
  const auto starts = [&](std::string_view mark) { return text.starts_with(mark); };
  if (starts(std::string_view("\xFF\xFE\0\0", 4)) || starts(std::string_view("\0\0\xFE\xFF", 4))) return "UTF-32";
  if (starts("\xFF\xFE") || starts("\xFE\xFF")) return "UTF-16";
  if (text.size() < 4) return "";
  const auto isZero = [&](std::size_t at) { return text[at] == '\0'; };
  const bool is_little = !isZero(0) && isZero(1) && !isZero(2) && isZero(3);
  const bool is_big = isZero(0) && !isZero(1) && isZero(2) && !isZero(3);
  return is_little || is_big ? "UTF-16" : "";
}

/// The first of `candidates`, relative to a folder above the program, that is a directory.
fs::path findAboveProgram(const std::vector<fs::path>& candidates) {
  std::error_code error;
  fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (int level = 0; level < 5 && !folder.empty(); ++level, folder = folder.parent_path()) {
    for (const fs::path& candidate : candidates) {
      if (fs::is_directory(folder / candidate, error)) return folder / candidate;
    }
  }
  return {};
}

}  // namespace

Result<FileStream> openFile(const fs::path& file, const std::string& what) {
  // The system would open the file whose name ends there.
  if (file.native().find('\0') != std::string::npos) return invalid("has a zero byte in its name; remove it");
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) return unavailable("there is no such file; check the path");
  if (fs::is_directory(status)) return unavailable("is a directory; name " + what + " in it");
  if (!fs::is_regular_file(status)) return unavailable("is not a regular file; name " + what);
  FileStream stream(std::fopen(file.c_str(), "rb"), &std::fclose);
  if (!stream) return unavailable(std::string("cannot be opened: ") + std::strerror(errno) + "; check its permissions");
  return stream;
}

Result<std::string> readText(const fs::path& file, std::size_t max_bytes, const std::string& what,
                             const std::string& advice) {
  const auto stream = openFile(file, what);
  if (!stream) return stream.error();
  // One byte more than allowed, to detect a file that is too big, whatever its reported size.
  std::string text(max_bytes + 1, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), stream->get()));
  if (std::ferror(stream->get()) != 0)
    return unavailable(std::string("cannot be read: ") + std::strerror(errno) + "; check the file");
  if (text.size() > max_bytes) return invalid("is bigger than " + std::to_string(max_bytes) + " bytes; " + advice);
  if (const std::string encoding = otherEncoding(text); !encoding.empty()) {
    return invalid("is " + encoding +
                   " text; save it as UTF-8: choose this encoding where the editor saves the file, or "
                   "run iconv -f " +
                   encoding + " -t UTF-8");
  }
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.erase(0, kByteOrderMark.size());
  return text;
}

fs::path findSceneFolder() {
  return findAboveProgram({"share/spindrift/scenes", "server/scenes"});
}

fs::path findWebRoot() {
  return findAboveProgram({"share/spindrift/web", "web-client/dist"});
}

Result<fs::path> findScene(const std::string& given) {
  std::error_code error;
  const fs::path folder = findSceneFolder();
  const bool is_name = given.find('/') == std::string::npos && !given.empty();
  // A bare name means the shipped scene, even if a file of that name exists; ./NAME means the file.
  if (is_name && !folder.empty()) {
    if (const fs::path shipped = folder / (given + ".textproto"); fs::exists(shipped, error)) return shipped;
  }
  if (fs::exists(given, error)) return fs::path(given);
  if (is_name && !folder.empty()) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      if (entry.path().extension() == ".textproto") names.insert(entry.path().stem().string());
    }
    std::string listed;
    for (const std::string& name : names) listed += (listed.empty() ? "" : ", ") + name;
    return unavailable("scene '" + given + "': neither a file nor a shipped scene; shipped are: " + listed);
  }
  return unavailable("scene '" + given +
                     "': no such file: give the path of a .textproto file or the name of a shipped scene");
}

}  // namespace spindrift::core
