// SHA-256, random bytes and comparisons whose time does not depend on the bytes. The implementation is OpenSSL's.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace spindrift::access {

using Digest = std::array<std::uint8_t, 32>;

/// Returns the SHA-256 of `first` followed by `second`.
Digest digestOf(std::string_view first, std::string_view second = {});
/// Returns the HMAC with SHA-256 (RFC 2104).
Digest hmacOf(std::string_view key, std::string_view text);
/// Compares in a time that does not depend on where the two differ.
bool isEqual(const Digest& a, const Digest& b);
/// Returns `count` bytes of the system's random numbers.
std::string randomBytes(std::size_t count);

}  // namespace spindrift::access
