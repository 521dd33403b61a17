// Results of finished cases, so that an interrupted study can be continued.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <boost/json/object.hpp>

#include <spindrift/core/result.h>

namespace spindrift::study_suites {

/// One JSON object per line: {"key", "result"}. The key names everything that a result depends on.
class StudyJournal {
 public:
  /// Reads the file; a truncated line is ignored. With an empty name nothing is kept.
  explicit StudyJournal(std::string file);

  /// kUnavailable when the file cannot be written. Call it before a long run.
  [[nodiscard]] core::Result<void> check() const;

  [[nodiscard]] std::optional<boost::json::value> find(const std::string& key) const;
  /// Errors as check().
  core::Result<void> add(const std::string& key, boost::json::value result);

 private:
  std::string file_;
  std::vector<boost::json::object> entries_;
};

}  // namespace spindrift::study_suites
