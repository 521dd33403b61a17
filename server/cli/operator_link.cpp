#include "operator_link.h"

#include <fmt/format.h>

#include <spindrift/access/base64url.h>
#include <spindrift/access/digest.h>
#include <spindrift/http/network_text.h>

namespace spindrift::cli {
namespace {

bool hasRoles(const FrontOptions& options) {
  return !options.token_file.empty() || !options.tokens.empty() || !options.jwt_keys.empty() ||
         !options.jwt_key_set.empty() || !options.guest_role.empty();
}

std::string pageUrl(const FrontOptions& options, const std::string& host, std::uint16_t port) {
  return fmt::format("{}://{}:{}/", options.tls_cert_file.empty() ? "http" : "https",
                     host.find(':') != std::string::npos ? "[" + host + "]" : host, port);
}

}  // namespace

bool isReachable(const FrontOptions& options) {
  return !net::isLoopback(options.address) || !options.trusted_proxies.empty();
}

void makeOperatorToken(FrontOptions& options) {
  constexpr std::size_t kTokenBytes = 16;
  if (isReachable(options) && !hasRoles(options))
    options.operator_token = access::toBase64Url(access::randomBytes(kTokenBytes));
}

std::string readyText(const FrontOptions& options, std::uint16_t port) {
  std::string out = "Spindrift is ready: " + pageUrl(options, options.address, port) + "\n";
  if (options.operator_token.empty()) return out;
  // No browser opens the address that stands for all of a machine's.
  const bool is_any = options.address == "0.0.0.0" || options.address == "::";
  return out + "Link of the operator: " + pageUrl(options, is_any ? "localhost" : options.address, port) +
         "#token=" + options.operator_token + "\n";
}

}  // namespace spindrift::cli
