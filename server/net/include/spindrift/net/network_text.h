// Networks in text form, for options.
#pragma once

#include <string>
#include <string_view>

#include <spindrift/core/result.h>

namespace spindrift::net {

/// Checks ADDRESS/BITS ("10.0.0.0/8", "2001:db8::/32") or one ADDRESS. kInvalidInput says what is wrong: no address,
/// more bits than the address has, or bits set behind the prefix.
core::Result<void> checkNetwork(const std::string& text);

/// Returns whether only this machine can reach a server that listens on `address`.
inline bool isLoopback(std::string_view address) {
  return address.starts_with("127.") || address == "::1";
}

}  // namespace spindrift::net
