#include <algorithm>
#include <system_error>

#include <spdlog/spdlog.h>

#include <spindrift/scene/fidelity.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/water/scene_catalog.h>

namespace spindrift::water {
namespace {

namespace fs = std::filesystem;
constexpr const char* kEnding = ".textproto";

}  // namespace

SceneCatalog::SceneCatalog(fs::path folder, std::optional<v1::Fidelity> fidelity) : fidelity_(fidelity) {
  if (folder.empty()) return;
  std::map<std::string, fs::path> found;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    const fs::path& file = entry->path();
    if (file.extension() == kEnding && fs::is_regular_file(file, ignored)) found.emplace(file.stem().string(), file);
  }
  for (const auto& [name, file] : found) add(name, file);
  if (auto errors = scene::loadFidelityErrors(folder))
    errors_ = *std::move(errors);
  else
    spdlog::warn("the errors of the fidelity levels are not known: {}", errors.error().message);
}

void SceneCatalog::add(const std::string& name, const fs::path& file) {
  if (!scene::isSceneName(name) || (!has(name) && files_.size() == kCatalogMaxCount)) return;
  fs::path& known = files_[name];
  std::error_code ignored;
  if (!fs::equivalent(known, file, ignored)) {  // another water: nothing was measured of it
    auto& scenes = *errors_.mutable_scenes();
    const auto measured = std::ranges::find(scenes, name, &v1::FidelityErrorsOfScene::name);
    if (measured != scenes.end()) scenes.erase(measured);
  }
  known = file;
}

const v1::FidelityErrorsOfScene* SceneCatalog::errorsOf(const std::string& name) const {
  const auto found = std::ranges::find(errors_.scenes(), name, &v1::FidelityErrorsOfScene::name);
  return found == errors_.scenes().end() ? nullptr : &*found;
}

std::vector<std::string> SceneCatalog::names() const {
  std::vector<std::string> out;
  for (const auto& [name, file] : files_) out.push_back(name);
  return out;
}

core::Result<v1::Scene> SceneCatalog::load(const std::string& name, std::optional<v1::Fidelity> fidelity) const {
  if (!has(name)) return core::unavailable("scene '" + name + "' is not listed");
  auto scene = scene::loadSceneFile(files_.at(name), fidelity ? fidelity : fidelity_);
  if (scene) scene->set_name(name);
  return scene;
}

}  // namespace spindrift::water
