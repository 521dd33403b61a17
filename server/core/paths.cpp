#include <set>
#include <string>
#include <system_error>
#include <vector>

#include <spindrift/core/paths.h>

namespace spindrift::core {
namespace {

namespace fs = std::filesystem;

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
