// The scenes that a room can change to: a folder's scene files, listed once at the start.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/v1/fidelity_errors.pb.h>
#include <spindrift/v1/scene.pb.h>

namespace spindrift::water {

/// At most this many are listed, in the order of their names.
inline constexpr std::size_t kCatalogMaxCount = 64;

class SceneCatalog {
 public:
  SceneCatalog() = default;
  /// Lists the regular files NAME.textproto in the folder, where NAME has letters, digits, '_' and '-'; empty if there
  /// is no such file, and reads the errors that were measured of them (scene::loadFidelityErrors). `fidelity` replaces
  /// the fidelity of every scene.
  explicit SceneCatalog(std::filesystem::path folder, std::optional<v1::Fidelity> fidelity = std::nullopt);

  /// Lists a file under this name, in place of the folder's if that has one. Does nothing for a name that a scene may
  /// not have, and when kCatalogMaxCount are listed.
  void add(const std::string& name, const std::filesystem::path& file);

  /// Returns the listed names, sorted.
  [[nodiscard]] std::vector<std::string> names() const;
  [[nodiscard]] bool has(const std::string& name) const { return files_.contains(name); }
  /// Reads the file again, so that edits take effect; the scene gets the listed name. `fidelity` replaces the
  /// catalog's. Errors: kUnavailable for a name that is not listed, otherwise those of the loader.
  [[nodiscard]] core::Result<v1::Scene> load(const std::string& name,
                                             std::optional<v1::Fidelity> fidelity = std::nullopt) const;
  /// Returns the errors that were measured of a scene, in the order of scene::kFidelities, and their day; null without.
  [[nodiscard]] const v1::FidelityErrorsOfScene* errorsOf(const std::string& name) const;
  [[nodiscard]] const std::string& errorsMeasuredOn() const { return errors_.measured_on(); }

 private:
  std::optional<v1::Fidelity> fidelity_;
  std::map<std::string, std::filesystem::path> files_;  ///< by name
  v1::FidelityErrors errors_;
};

}  // namespace spindrift::water
