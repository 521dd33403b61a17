#include "output.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

#include <boost/json/serialize.hpp>

#include "commands.h"
#include "logging.h"

namespace spindrift::cli {

core::Result<void> writeJson(const std::string& file, const boost::json::value& value, const std::string& option) {
  if (file.empty()) return {};
  const std::string text = boost::json::serialize(value) + "\n";
  if (file == "-") {
    std::fwrite(text.data(), 1, text.size(), stdout);
    return {};
  }
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (!out)
    return core::Error{core::ErrorCode::kUnavailable,
                       option + " '" + file + "': cannot be written: " + std::strerror(errno)};
  return {};
}

int fail(const core::Error& error) {
  reportFailure(error.message);
  return core::exitCode(error.code);
}

}  // namespace spindrift::cli
