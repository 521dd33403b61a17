#include "study_journal.h"

#include <fstream>

#include <boost/json/parse.hpp>
#include <boost/json/serialize.hpp>

namespace spindrift::app {

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
  if (!out.flush())
    return core::Error{core::ErrorCode::kUnavailable, file_ + ": cannot be written: choose another --journal"};
  return {};
}

}  // namespace spindrift::app
