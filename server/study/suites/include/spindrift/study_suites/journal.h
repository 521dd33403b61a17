// Results of finished cases, so that an interrupted study can be continued.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <boost/json/object.hpp>

#include <spindrift/core/result.h>

namespace spindrift::study_suites {

/// One JSON object a line: {"key", "result"}. The key names all that a result depends on.
class StudyJournal {
 public:
  /// Reads what the file holds; a line that was cut off counts as not there. An empty name keeps nothing.
  explicit StudyJournal(std::string file);

  /// kUnavailable when the file cannot be written: to be asked before hours of work.
  [[nodiscard]] core::Result<void> check() const;

  [[nodiscard]] std::optional<boost::json::value> find(const std::string& key) const;
  /// Errors as check()'s.
  core::Result<void> add(const std::string& key, boost::json::value result);

 private:
  std::string file_;
  std::vector<boost::json::object> entries_;
};

}  // namespace spindrift::study_suites
