#include <system_error>

#include "scene_parts.h"

namespace spindrift::scene {

namespace fs = std::filesystem;

namespace {

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

core::Result<fs::path> fileInFolder(const std::optional<fs::path>& folder, const fs::path& name,
                                    const std::string& instead) {
  if (!folder) return core::invalid("cannot be read, because this scene is not a file; give " + instead + " instead");
  if (const std::string why = leavesFolder(*folder, name); !why.empty())
    return core::invalid(why + "; put the file into the folder of the scene file");
  return *folder / name;
}

}  // namespace spindrift::scene
