// Proxies in front of the server: which peers are trusted, and which client a trusted peer names. Without a socket.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <boost/asio/ip/address.hpp>

#include <spindrift/core/result.h>

namespace spindrift::net {

/// Returns the IPv4 address that an IPv4-mapped IPv6 address stands for; any other address unchanged. Sockets for both
/// families report IPv4 peers in the mapped form.
boost::asio::ip::address unmapped(const boost::asio::ip::address& address);

/// Returns the key for limits per address: the address, or for IPv6 its /64 network.
std::string limitKey(const boost::asio::ip::address& address);

/// The networks of ServerOptions::trusted_proxies.
class TrustedNetworks {
 public:
  /// Each text as in checkNetwork().
  static core::Result<TrustedNetworks> parse(std::span<const std::string> texts);

  [[nodiscard]] bool contains(const boost::asio::ip::address& address) const;
  [[nodiscard]] bool empty() const { return networks_.empty(); }

 private:
  struct Network {
    boost::asio::ip::address first;
    unsigned prefix_bits = 0;
  };
  static core::Result<Network> parseOne(const std::string& text);

  std::vector<Network> networks_;
};

/// Returns the client that X-Forwarded-For names: the rightmost entry that is not a trusted proxy, or the leftmost one
/// if all are; nullopt if there is no entry. `lines`: the values of all headers of this name, in order; an entry is an
/// address, with a port or not (192.0.2.1:80, [2001:db8::1]:80). Only entries up to the client are read, because the
/// client itself can write whatever it likes in front of them. kInvalidInput is one line that names the header.
core::Result<std::optional<boost::asio::ip::address>> forwardedClient(std::span<const std::string_view> lines,
                                                                      const TrustedNetworks& trusted);

}  // namespace spindrift::net
