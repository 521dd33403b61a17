// The configuration file of `serve`: a v1::ServeConfig as text. Its fields and the options have the same names
// (proto/spindrift/v1/serve_config.proto).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <spindrift/core/result.h>

#include "option_sources.h"

namespace spindrift::cli {

inline constexpr std::size_t kConfigFileMaxBytes = 1 << 20;

/// Reads the file and gives the options that have neither flag nor variable its values. kUnavailable: it cannot be
/// read. kInvalidInput: it is bigger than kConfigFileMaxBytes, or as for takeConfigText().
core::Result<void> takeConfigFile(const std::string& file, OptionSources& options);

/// The same for text. kInvalidInput names the first location that is wrong, as LABEL:LINE:COLUMN.
core::Result<void> takeConfigText(std::string_view text, const std::string& label, OptionSources& options);

/// Returns the values of all options as text that takeConfigText() accepts, each with its source as a comment.
std::string configText(const OptionSources& options);

}  // namespace spindrift::cli
