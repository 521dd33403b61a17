// The scenes that a room can be changed to: a folder's scene files, listed once at the start.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/v1/scene.pb.h>

namespace spindrift::rooms {

/// At most this many are listed, in the order of their names.
inline constexpr std::size_t kCatalogMaxCount = 64;

class SceneCatalog {
 public:
  SceneCatalog() = default;
  /// Regular files NAME.textproto in the folder with names of letters, digits, '_' and '-'; empty where there are none.
  /// `fidelity` takes the place of every scene's own.
  explicit SceneCatalog(std::filesystem::path folder, std::optional<v1::Fidelity> fidelity = std::nullopt);

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] bool has(const std::string& name) const;
  /// Reads the file anew, so that an edited scene comes as it is now. The scene is called as it is listed. `fidelity`
  /// takes the place of the catalog's. kUnavailable for a name that is not listed, otherwise the loader's errors.
  [[nodiscard]] core::Result<v1::Scene> load(const std::string& name,
                                             std::optional<v1::Fidelity> fidelity = std::nullopt) const;

 private:
  std::filesystem::path folder_;
  std::optional<v1::Fidelity> fidelity_;
  std::vector<std::string> names_;
};

}  // namespace spindrift::rooms
