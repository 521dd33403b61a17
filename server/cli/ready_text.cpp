#include "ready_text.h"

#include <string>
#include <vector>

#include <fmt/format.h>

#include <spindrift/net/page_urls.h>

namespace spindrift::cli {
namespace {

std::string pageUrl(const FrontOptions& options, const std::string& host, std::uint16_t port) {
  return fmt::format("{}://{}:{}/", options.tls_cert_file.empty() ? "http" : "https",
                     host.find(':') != std::string::npos ? "[" + host + "]" : host, port);
}

net::PageAddress pageAddress(const FrontOptions& options, std::uint16_t port) {
  return {options.address, port, !options.tls_cert_file.empty(), options.public_url};
}

}  // namespace

std::string readyText(const FrontOptions& options, std::uint16_t port) {
  const std::string own = pageUrl(options, options.address, port);
  std::string out = "Spindrift is ready: " + own + "\n";
  // No browser opens the address that stands for all of a machine's.
  const bool is_any = options.address == "0.0.0.0" || options.address == "::";
  const std::string here = pageUrl(options, is_any ? "localhost" : options.address, port);
  const std::string token = options.operator_token.empty() ? "" : "#token=" + options.operator_token;
  if (options.is_class) {
    const std::string phones = phoneUrl(options, port);
    return out + "Projector: " + here + "?class" + token + "\n" +
           (phones.empty() ? "Phones cannot reach this machine: connect it to a network, or give --public-url\n"
                           : "Phones: " + phones + "\n");
  }
  if (!token.empty()) out += "Link of the operator: " + here + token + "\n";
  for (const std::string& url : net::pageUrls(pageAddress(options, port)))
    if (url != own) out += "Phones and other computers: " + url + "\n";
  return out;
}

std::string phoneUrl(const FrontOptions& options, std::uint16_t port) {
  const net::PageAddress page = pageAddress(options, port);
  const auto urls = options.is_class ? net::padUrls(page) : net::pageUrls(page);
  return urls.empty() ? "" : urls.front();
}

}  // namespace spindrift::cli
