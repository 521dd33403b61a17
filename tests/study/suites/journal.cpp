#include <fstream>
#include <utility>

#include <boost/json/parse.hpp>
#include <boost/json/serialize.hpp>

#include <spindrift/study_suites/journal.h>

namespace spindrift::study_suites {
namespace {

core::Error unwritable(const std::string& file) {
  return {core::ErrorCode::kUnavailable, "--journal '" + file + "': cannot be written: choose another file"};
}

}  // namespace

StudyJournal::StudyJournal(std::string file) : file_(std::move(file)) {
  if (file_.empty()) return;
  std::ifstream in(file_);
  for (std::string line; std::getline(in, line);) {
    boost::system::error_code broken;
    const boost::json::value value = boost::json::parse(line, broken);
    if (broken || !value.is_object()) continue;
    const auto& entry = value.as_object();
    if (entry.contains("key") && entry.at("key").is_string() && entry.contains("result")) entries_.push_back(entry);
  }
}

core::Result<void> StudyJournal::check() const {
  if (!file_.empty() && !std::ofstream(file_, std::ios::app)) return unwritable(file_);
  return {};
}

std::optional<boost::json::value> StudyJournal::find(const std::string& key) const {
  for (const auto& entry : entries_) {
    if (entry.at("key").as_string() == key) return entry.at("result");
  }
  return std::nullopt;
}

core::Result<void> StudyJournal::add(const std::string& key, boost::json::value result) {
  if (file_.empty()) return {};
  std::ofstream out(file_, std::ios::app);
  out << boost::json::serialize(boost::json::object{{"key", key}, {"result", std::move(result)}}) << '\n';
  if (!out.flush()) return unwritable(file_);
  return {};
}

}  // namespace spindrift::study_suites
