// Addresses at which other devices open the page.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace spindrift::net {

struct PageAddress {
  std::string address;  ///< that the server listens on
  std::uint16_t port = 0;
  bool is_tls = false;
  std::string public_url{};  ///< of the page as others reach it; empty: by the addresses of this machine
};

/// Returns the URLs of the page, "http://192.168.1.20:8080/", IPv4 first: that of `public_url`, or one for each address
/// of the machine's interfaces that are up, without loopback and link-local ones. Empty if only this machine can reach
/// the server.
std::vector<std::string> pageUrls(const PageAddress& page);

/// Returns the same for the page's pad, "http://192.168.1.20:8080/pad".
std::vector<std::string> padUrls(const PageAddress& page);

}  // namespace spindrift::net
