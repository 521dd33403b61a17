#include <algorithm>
#include <array>
#include <memory>

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <spindrift/http/network_text.h>
#include <spindrift/net/page_urls.h>

namespace spindrift::net {
namespace {

/// Returns the text of an address that other devices may use; empty for others.
std::string textOf(const sockaddr* address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (address->sa_family == AF_INET) {
    const auto& ip = reinterpret_cast<const sockaddr_in*>(address)->sin_addr;
    const std::uint32_t bits = ntohl(ip.s_addr);
    const bool is_link_local = bits >> 16U == 0xA9FEU;
    if (is_link_local || bits >> 24U == 127U) return {};
    return inet_ntop(AF_INET, &ip, text.data(), text.size()) != nullptr ? text.data() : std::string();
  }
  if (address->sa_family != AF_INET6) return {};
  const auto& ip = reinterpret_cast<const sockaddr_in6*>(address)->sin6_addr;
  if (IN6_IS_ADDR_LINKLOCAL(&ip) || IN6_IS_ADDR_LOOPBACK(&ip)) return {};
  return inet_ntop(AF_INET6, &ip, text.data(), text.size()) != nullptr ? text.data() : std::string();
}

bool isIpv6(const std::string& address) {
  return address.find(':') != std::string::npos;
}

std::vector<std::string> addressesOfInterfaces() {
  std::vector<std::string> out;
  ifaddrs* list = nullptr;
  if (::getifaddrs(&list) != 0) return out;
  const std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)> owner(list, &::freeifaddrs);
  for (const ifaddrs* one = list; one != nullptr; one = one->ifa_next) {
    constexpr unsigned kWanted = IFF_UP | IFF_RUNNING;
    if (one->ifa_addr == nullptr || (one->ifa_flags & kWanted) != kWanted || (one->ifa_flags & IFF_LOOPBACK) != 0)
      continue;
    std::string text = textOf(one->ifa_addr);
    if (!text.empty() && std::ranges::find(out, text) == out.end()) out.push_back(std::move(text));
  }
  // clang 14 cannot compile the one of std::ranges.
  std::stable_partition(out.begin(), out.end(), [](const std::string& address) { return !isIpv6(address); });
  return out;
}

}  // namespace

std::vector<std::string> pageUrls(const PageAddress& page) {
  if (!page.public_url.empty()) {
    const std::size_t end = page.public_url.find_last_not_of('/');
    return {page.public_url.substr(0, end + 1) + "/"};
  }
  if (isLoopback(page.address)) return {};
  const bool is_any = page.address == "0.0.0.0" || page.address == "::";
  std::vector<std::string> out;
  for (const std::string& address : is_any ? addressesOfInterfaces() : std::vector<std::string>{page.address}) {
    if (page.address == "0.0.0.0" && isIpv6(address)) continue;
    out.push_back((page.is_tls ? "https://" : "http://") + (isIpv6(address) ? "[" + address + "]" : address) + ":" +
                  std::to_string(page.port) + "/");
  }
  return out;
}

std::vector<std::string> padUrls(const PageAddress& page) {
  std::vector<std::string> out = pageUrls(page);
  for (std::string& url : out) url += "pad";
  return out;
}

}  // namespace spindrift::net
