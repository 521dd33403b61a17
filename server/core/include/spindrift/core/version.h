// Version of the program. The only place that names it is project(spindrift VERSION …) in CMakeLists.txt.
#pragma once

#include <string_view>

namespace spindrift::core {

/// Returns the version, for example "1.2.3".
std::string_view version();

/// Returns name and version, for example "spindrift 1.2.3", as greetings, logs of rooms and `--version` say it.
std::string_view nameAndVersion();

}  // namespace spindrift::core
