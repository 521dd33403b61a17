#include <algorithm>

#include <boost/asio/ip/address_v4.hpp>
#include <boost/asio/ip/address_v6.hpp>
#include <boost/asio/ip/network_v4.hpp>
#include <boost/asio/ip/network_v6.hpp>

#include <spindrift/http/network_text.h>
#include <spindrift/http/trusted_networks.h>
#include <spindrift/http/url.h>

#include "field_list.h"

namespace spindrift::net {
namespace {

namespace ip = boost::asio::ip;

constexpr unsigned kV4Bits = 32;
constexpr unsigned kV6Bits = 128;
/// Bits of an IPv4-mapped address in front of the IPv4 address.
constexpr unsigned kMappedBits = kV6Bits - kV4Bits;

using core::invalid;

/// Returns the first address of the network of `bits` that holds `address`.
ip::address firstOf(const ip::address& address, unsigned bits) {
  if (address.is_v4()) return ip::network_v4(address.to_v4(), static_cast<unsigned short>(bits)).network();
  return ip::network_v6(ip::address_v6(address.to_v6().to_bytes()), static_cast<unsigned short>(bits)).network();
}

/// An address of a zone (fe80::1%eth0) means something on one machine only.
std::optional<ip::address> addressOf(std::string_view text) {
  constexpr std::size_t kLongest = 45;  // an IPv4-mapped address with all digits
  if (text.size() > kLongest || text.find('%') != std::string_view::npos) return std::nullopt;
  boost::system::error_code error;
  const ip::address address = ip::make_address(std::string(text), error);
  return error ? std::nullopt : std::optional(unmapped(address));
}

/// An address with an optional port: 192.0.2.1, 192.0.2.1:80, 2001:db8::1, [2001:db8::1], [2001:db8::1]:80.
std::optional<ip::address> entryOf(std::string_view text) {
  std::string_view port;
  bool has_port = false;
  if (text.starts_with('[')) {
    const std::size_t end = text.find(']');
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view rest = text.substr(end + 1);
    has_port = !rest.empty();
    if (has_port && rest.front() != ':') return std::nullopt;
    port = has_port ? rest.substr(1) : rest;
    text = text.substr(1, end - 1);
    if (text.find(':') == std::string_view::npos) return std::nullopt;  // brackets are for IPv6
  } else if (std::ranges::count(text, ':') == 1) {
    has_port = true;
    port = text.substr(text.find(':') + 1);
    text = text.substr(0, text.find(':'));
  }
  if (has_port && !wholeNumber(port, kPortMax)) return std::nullopt;
  return addressOf(text);
}

}  // namespace

ip::address unmapped(const ip::address& address) {
  if (!address.is_v6() || !address.to_v6().is_v4_mapped()) return address;
  return ip::make_address_v4(ip::v4_mapped, address.to_v6());
}

std::string limitKey(const ip::address& address) {
  constexpr unsigned kNetworkBits = 64;
  const ip::address plain = unmapped(address);
  if (!plain.is_v6()) return plain.to_string();
  return ip::network_v6(plain.to_v6(), kNetworkBits).canonical().to_string();
}

core::Result<TrustedNetworks::Network> TrustedNetworks::parseOne(const std::string& text) {
  const std::size_t slash = text.find('/');
  boost::system::error_code error;
  const ip::address address = ip::make_address(text.substr(0, slash), error);
  if (error || text.find('%') != std::string::npos) {
    return invalid("'" + text + "' is not a network: write ADDRESS/BITS, such as 10.0.0.0/8 or 2001:db8::/32");
  }
  const unsigned bits_max = address.is_v4() ? kV4Bits : kV6Bits;
  const auto bits = slash == std::string::npos ? std::optional(bits_max)
                                               : wholeNumber(std::string_view(text).substr(slash + 1), bits_max);
  if (!bits) {
    return invalid("'" + text + "': the part behind '/' is a number of bits from 0 to " + std::to_string(bits_max));
  }
  const ip::address first = firstOf(address, *bits);
  if (first != address) {
    return invalid("'" + text + "' has bits set behind its first " + std::to_string(*bits) + ": write " +
                   first.to_string() + "/" + std::to_string(*bits));
  }
  if (unmapped(first) != first && *bits >= kMappedBits) return Network{unmapped(first), *bits - kMappedBits};
  return Network{first, *bits};
}

core::Result<TrustedNetworks> TrustedNetworks::parse(std::span<const std::string> texts) {
  TrustedNetworks out;
  for (const std::string& text : texts) {
    auto network = parseOne(text);
    if (!network) return network.error();
    out.networks_.push_back(*std::move(network));
  }
  return out;
}

bool TrustedNetworks::contains(const ip::address& address) const {
  const ip::address plain = unmapped(address);
  return std::ranges::any_of(networks_, [&](const Network& network) {
    return network.first.is_v4() == plain.is_v4() && firstOf(plain, network.prefix_bits) == network.first;
  });
}

core::Result<void> checkNetwork(const std::string& text) {
  const auto parsed = TrustedNetworks::parse({&text, 1});
  if (!parsed) return parsed.error();
  return {};
}

core::Result<void> checkListenAddress(const std::string& text) {
  constexpr const char* kForm = "write one such as 127.0.0.1, 0.0.0.0 (all of IPv4), :: (all) or ::1";
  boost::system::error_code error;
  const ip::address address = ip::make_address(text, error);
  if (!error) {
    const bool lacks_interface = address.is_v6() && address.to_v6().is_link_local() && address.to_v6().scope_id() == 0;
    if (!lacks_interface) return {};
    return invalid("'" + text + "' is a link-local address, which each interface has for itself: write the interface " +
                   "behind it, such as " + text.substr(0, text.find('%')) + "%eth0");
  }
  // What was meant may be in it: a URL, an address with a port or in brackets.
  std::string_view rest = text;
  if (const std::size_t mark = rest.find("://"); mark != std::string_view::npos) rest.remove_prefix(mark + 3);
  rest = rest.substr(0, rest.find('/'));
  if (!entryOf(rest)) {
    return invalid("'" + text + "' is not an IP address (" + kForm + "); names of hosts cannot be listened on");
  }
  const std::size_t bracket = rest.find(']');
  const std::size_t colon = rest.find(':', bracket == std::string_view::npos ? 0 : bracket);
  const bool has_port =
      std::ranges::count(rest, ':') == 1 || (bracket != std::string_view::npos && colon != std::string_view::npos);
  const std::string_view host =
      bracket == std::string_view::npos ? rest.substr(0, has_port ? colon : rest.size()) : rest.substr(1, bracket - 1);
  return invalid("'" + text + "' is more than an IP address: write --address " + std::string(host) +
                 (has_port ? " --port " + std::string(rest.substr(colon + 1)) : ""));
}

core::Result<std::optional<ip::address>> forwardedClient(std::span<const std::string_view> lines,
                                                         const TrustedNetworks& trusted) {
  std::optional<ip::address> client;
  for (std::size_t k = lines.size(); k-- > 0;) {
    std::string_view line = lines[k];
    while (true) {
      const std::size_t comma = line.rfind(',');
      const std::string_view entry = trimmed(comma == std::string_view::npos ? line : line.substr(comma + 1));
      client = entryOf(entry);
      if (!client) {
        return invalid("The X-Forwarded-For header has the entry '" + printable(entry.substr(0, 60)) +
                       "', which is not an IP address: the proxy in front of this server has to write one.");
      }
      if (!trusted.contains(*client)) return client;
      if (comma == std::string_view::npos) break;
      line = line.substr(0, comma);
    }
  }
  return client;
}

}  // namespace spindrift::net
