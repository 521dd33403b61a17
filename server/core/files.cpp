#include <cerrno>
#include <cstring>
#include <system_error>

#include <spindrift/core/files.h>

namespace spindrift::core {

namespace fs = std::filesystem;

namespace {

Error unavailable(std::string message) {
  return {ErrorCode::kUnavailable, std::move(message)};
}

}  // namespace

Result<FileStream> openFile(const fs::path& file, const std::string& what) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) return unavailable("there is no such file; check the path");
  if (fs::is_directory(status)) return unavailable("is a directory; name " + what + " in it");
  if (!fs::is_regular_file(status)) return unavailable("is no regular file; name " + what);
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
  if (text.size() > max_bytes)
    return Error{ErrorCode::kInvalidInput, "is bigger than " + std::to_string(max_bytes) + " bytes; " + advice};
  return text;
}

}  // namespace spindrift::core
