#include <algorithm>
#include <system_error>

#include <spindrift/rooms/scene_catalog.h>
#include <spindrift/scene/scene_loader.h>

namespace spindrift::rooms {
namespace {

namespace fs = std::filesystem;
constexpr const char* kEnding = ".textproto";

}  // namespace

SceneCatalog::SceneCatalog(fs::path folder, std::optional<v1::Fidelity> fidelity)
    : folder_(std::move(folder)), fidelity_(fidelity) {
  if (folder_.empty()) return;
  std::error_code error;
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    const fs::path& file = entry->path();
    if (file.extension() != kEnding || !fs::is_regular_file(file, ignored)) continue;
    if (std::string name = file.stem().string(); scene::isSceneName(name)) names_.push_back(std::move(name));
  }
  std::ranges::sort(names_);
  if (names_.size() > kCatalogMaxCount) names_.resize(kCatalogMaxCount);
}

bool SceneCatalog::has(const std::string& name) const {
  return std::ranges::binary_search(names_, name);
}

core::Result<v1::Scene> SceneCatalog::load(const std::string& name, std::optional<v1::Fidelity> fidelity) const {
  if (!has(name)) return core::Error{core::ErrorCode::kUnavailable, "scene '" + name + "' is not listed"};
  auto scene = scene::loadSceneFile(folder_ / (name + kEnding), fidelity ? fidelity : fidelity_);
  if (scene) scene->set_name(name);
  return scene;
}

}  // namespace spindrift::rooms
