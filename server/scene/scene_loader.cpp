#include <system_error>
#include <utility>
#include <vector>

#include <spindrift/core/files.h>
#include <spindrift/scene/fidelity.h>
#include <spindrift/scene/fields.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/scene/scene_rules.h>
#include <spindrift/textproto/parsed_text.h>

#include "scene_parts.h"

namespace spindrift::scene {
namespace {

/// Returns the reason why a name does not stay in the folder; empty if it does.
std::string leavesFolder(const std::filesystem::path& folder, const std::filesystem::path& name) {
  if (name.is_absolute()) return "is an absolute path";
  for (const std::filesystem::path& part : name) {
    if (part == "..") return "goes up by \"..\"";
  }
  // Links are followed: what they point to has to be in the folder, too.
  std::error_code error;
  const std::filesystem::path root =
      std::filesystem::weakly_canonical(folder.empty() ? std::filesystem::path(".") : folder, error);
  const std::filesystem::path file = std::filesystem::weakly_canonical(root / name, error);
  if (error) return "cannot be found: " + error.message();
  const std::filesystem::path inside = file.lexically_relative(root);
  return inside.empty() || *inside.begin() == ".." ? "is a link that leads out of it" : "";
}

}  // namespace

core::Result<std::filesystem::path> fileInFolder(const std::optional<std::filesystem::path>& folder,
                                                 const std::filesystem::path& name, const std::string& instead) {
  if (!folder) return core::invalid("cannot be read, because this scene is not a file; give " + instead + " instead");
  if (const std::string why = leavesFolder(*folder, name); !why.empty())
    return core::invalid(why + "; put the file into the folder of the scene file");
  return *folder / name;
}

core::Result<v1::Scene> parseSceneText(std::string_view text, const std::string& file_label,
                                       std::optional<v1::Fidelity> fidelity,
                                       const std::optional<std::filesystem::path>& folder) {
  if (text.size() > kSceneFileMaxBytes) {
    return core::invalid(file_label + ": " + std::to_string(text.size()) + " bytes are more than " +
                         std::to_string(kSceneFileMaxBytes) + "; a scene is a small text");
  }
  v1::Scene scene;
  textproto::ParsedText parsed(std::string(text), scene);
  const bool text_is_fine = !parsed.hasErrors();

  std::vector<FieldIssue> issues;
  checkFields(scene, "", issues);
  // A level rounds the width to its own cells.
  if (text_is_fine && issues.empty() && scene.has_wave()) checkCells(scene.wave(), issues);
  if (text_is_fine) {
    const bool numbers_are_fine = issues.empty();
    if (fidelity) scene.set_fidelity(*fidelity);
    if (numbers_are_fine) applyFidelity(scene);
    fillDefaults(scene);
    if (scene.name().empty()) scene.set_name(std::filesystem::path(file_label).stem().string());
    for (FieldIssue& issue : checkStructure(scene)) issues.push_back(std::move(issue));
    if (numbers_are_fine) {
      readSeries(scene, folder, issues);
      for (FieldIssue& issue : checkNumbers(scene)) issues.push_back(std::move(issue));
      if (scene.bed().has_grid()) readDepthGrid(*scene.mutable_bed()->mutable_grid(), folder, issues);
    }
  }
  for (const FieldIssue& issue : issues) parsed.addError(issue.path, issue.message);
  if (parsed.hasErrors()) return core::invalid(parsed.report(file_label));
  return scene;
}

core::Result<v1::Scene> loadSceneFile(const std::filesystem::path& file, std::optional<v1::Fidelity> fidelity) {
  const std::string label = file.string();
  const auto text = core::readText(file, kSceneFileMaxBytes, "a scene file", "a scene is a small text");
  if (!text) return core::Error{text.error().code, label + ": " + text.error().message};
  return parseSceneText(*text, label, fidelity, file.parent_path());
}

}  // namespace spindrift::scene
