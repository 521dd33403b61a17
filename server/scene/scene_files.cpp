#include "scene_files.h"

#include <cerrno>
#include <cstring>
#include <system_error>

#include <fmt/format.h>

namespace spindrift::scene {

namespace fs = std::filesystem;

namespace {

core::Error unavailable(std::string message) {
  return {core::ErrorCode::kUnavailable, std::move(message)};
}

/// Returns the reason why a name does not stay in the folder; empty if it does.
std::string leavesFolder(const fs::path& folder, const fs::path& name) {
  if (name.is_absolute()) return "is an absolute path";
  for (const fs::path& part : name) {
    if (part == "..") return "goes up by \"..\"";
  }
  // Links are followed: what they point to has to be in the folder, too.
  std::error_code error;
  const fs::path root = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, error);
  const fs::path file = fs::weakly_canonical(root / name, error);
  if (error) return "cannot be found: " + error.message();
  const fs::path inside = file.lexically_relative(root);
  return inside.empty() || *inside.begin() == ".." ? "is a link that leads out of it" : "";
}

}  // namespace

core::Result<FileStream> openFile(const fs::path& file, const std::string& what) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) return unavailable("there is no such file; check the path");
  if (fs::is_directory(status)) return unavailable("is a directory; name " + what + " in it");
  if (!fs::is_regular_file(status)) return unavailable("is no regular file; name " + what);
  FileStream stream(std::fopen(file.c_str(), "rb"), &std::fclose);
  if (!stream) return unavailable(fmt::format("cannot be opened: {}; check its permissions", std::strerror(errno)));
  return stream;
}

core::Result<std::string> readText(const fs::path& file, std::size_t max_bytes, const std::string& what,
                                   const std::string& advice) {
  const auto stream = openFile(file, what);
  if (!stream) return stream.error();
  // One byte more than allowed, to detect a file that is too big, whatever its reported size.
  std::string text(max_bytes + 1, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), stream->get()));
  if (std::ferror(stream->get()) != 0)
    return unavailable(fmt::format("cannot be read: {}; check the file", std::strerror(errno)));
  if (text.size() > max_bytes)
    return core::Error{core::ErrorCode::kInvalidInput, fmt::format("is bigger than {} bytes; {}", max_bytes, advice)};
  return text;
}

core::Result<fs::path> fileInFolder(const std::optional<fs::path>& folder, const fs::path& name,
                                    const std::string& instead) {
  const auto invalid = [](std::string message) {
    return core::Error{core::ErrorCode::kInvalidInput, std::move(message)};
  };
  if (!folder) return invalid("cannot be read, because this scene is no file; give " + instead + " instead");
  if (const std::string why = leavesFolder(*folder, name); !why.empty())
    return invalid(why + "; put the file into the folder of the scene file");
  return *folder / name;
}

}  // namespace spindrift::scene
