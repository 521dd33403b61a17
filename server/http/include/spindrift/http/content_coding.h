// Content codings of static files (RFC 9110 section 12.5.3), and which of them a client prefers.
#pragma once

#include <array>
#include <string_view>

namespace spindrift::net {

struct ContentCoding {
  std::string_view name;    ///< in Accept-Encoding and Content-Encoding
  std::string_view suffix;  ///< of the compressed file beside the original
};

/// The smallest one first. web-client/scripts/precompress.mjs makes these files.
inline constexpr std::array<ContentCoding, 2> kContentCodings{{{"br", ".br"}, {"gzip", ".gz"}}};

/// Returns the weight of a coding in a list of Accept-Encoding, 0 to 1: that of its own entry, or that of "*"; 0 if
/// there is neither, or if the entry is malformed.
double codingWeight(std::string_view accept_encoding, std::string_view coding);

}  // namespace spindrift::net
