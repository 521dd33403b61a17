#include "json_object.h"

#include <cstddef>

#include <boost/json/parse.hpp>

namespace spindrift::access {
namespace {

namespace json = boost::json;

constexpr std::size_t kMaxDepth = 8;

/// Returns the number of members of all objects in a valid text: each has one colon outside of strings.
std::size_t memberCount(std::string_view text) {
  std::size_t count = 0;
  bool is_in_string = false;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (is_in_string && c == '\\') {
      ++at;
    } else if (c == '"') {
      is_in_string = !is_in_string;
    } else if (c == ':' && !is_in_string) {
      ++count;
    }
  }
  return count;
}

std::size_t memberCount(const json::value& value) {
  std::size_t count = 0;
  if (const json::array* const list = value.if_array()) {
    for (const json::value& one : *list) count += memberCount(one);
  } else if (const json::object* const object = value.if_object()) {
    count = object->size();
    for (const auto& [name, one] : *object) count += memberCount(one);
  }
  return count;
}

}  // namespace

core::Result<json::object> parseJsonObject(std::string_view text) {
  const auto refuse = [](std::string why) { return core::invalid(std::move(why)); };
  boost::system::error_code error;
  json::parse_options options;
  options.max_depth = kMaxDepth;
  json::value value = json::parse({text.data(), text.size()}, error, {}, options);
  if (error) return refuse("not JSON: " + error.message());
  if (!value.is_object()) return refuse("not a JSON object");
  // Boost keeps the last of two members with one name.
  if (memberCount(text) != memberCount(value)) return refuse("JSON with the same name twice in an object");
  return std::move(value.get_object());
}

}  // namespace spindrift::access
