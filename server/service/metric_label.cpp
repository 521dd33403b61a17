#include <spindrift/core/text.h>
#include <spindrift/service/metric_label.h>

namespace spindrift::service {

std::string metricLabel(std::string_view name, std::string_view value) {
  std::string out = std::string(name) + "=\"";
  for (std::size_t at = 0; at < value.size();) {
    const std::size_t length = core::utf8SequenceLength(value, at);
    const std::string_view character = value.substr(at, length);
    if (length == 0)
      out += "\xEF\xBF\xBD";
    else if (character == "\n")
      out += "\\n";
    else if (character == "\"" || character == "\\")
      (out += '\\') += character;
    else
      out += character;
    at += length == 0 ? 1 : length;
  }
  return out += '"';
}

}  // namespace spindrift::service
