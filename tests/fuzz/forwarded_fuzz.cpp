// The header X-Forwarded-For as a trusted proxy passes it on, one header per line of the input, and the networks of
// --trust-proxy.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <spindrift/http/network_text.h>
#include <spindrift/http/trusted_networks.h>

#include "fuzz.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace spindrift;
  static const std::vector<std::string> kTexts{"10.0.0.0/8", "192.0.2.1", "fd00::/8", "::1"};
  static const auto kTrusted = net::TrustedNetworks::parse(kTexts);
  fuzz::must(bool(kTrusted), "the networks of this test are networks");
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  (void)net::checkNetwork(std::string(text));

  std::vector<std::string_view> lines;
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t end = rest.find('\n');
    lines.push_back(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  }
  const auto client = net::forwardedClient(lines, *kTrusted);
  if (!client) {
    fuzz::must(client.error().message.find_first_of("\r\n") == std::string::npos, "a refusal is one line");
    return 0;
  }
  fuzz::must(client->has_value() || lines.empty(), "only a request without the header has no client");
  if (!*client) return 0;
  fuzz::must(!net::limitKey(**client).empty(), "a client has a key");
  // An attacker's lines in front of what the proxy wrote change nothing.
  if (!kTrusted->contains(**client)) {
    std::vector<std::string_view> longer{"10.0.0.1, garbage, 127.0.0.1"};
    longer.insert(longer.end(), lines.begin(), lines.end());
    const auto again = net::forwardedClient(longer, *kTrusted);
    fuzz::must(again && **again == **client, "the client does not depend on what stands in front of it");
  }
  return 0;
}
