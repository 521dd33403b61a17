// Labels of the samples on /metrics.
#pragma once

#include <string>
#include <string_view>

namespace spindrift::service {

/// Returns NAME="VALUE" for any bytes as value: quotes, backslashes and line breaks are escaped as the format of
/// Prometheus says, and what is not UTF-8 is replaced by U+FFFD.
std::string metricLabel(std::string_view name, std::string_view value);

}  // namespace spindrift::service
