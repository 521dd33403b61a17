// The servers that --url names.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/net/client.h>

namespace spindrift::bench {

/// Errors: those of ClientUrl::parse(); kInvalidInput for an empty list.
inline core::Result<std::vector<net::ClientUrl>> parseUrls(const std::vector<std::string>& texts) {
  std::vector<net::ClientUrl> urls;
  for (const std::string& text : texts) {
    auto url = net::ClientUrl::parse(text);
    if (!url) return url.error();
    urls.push_back(*std::move(url));
  }
  if (urls.empty())
    return core::Error{core::ErrorCode::kInvalidInput,
                       "the suites load and soak measure servers that run: give --url ws://HOST:PORT/ws"};
  return urls;
}

}  // namespace spindrift::bench
