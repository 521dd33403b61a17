#include "inherited_socket.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace spindrift::cli {
namespace {

/// SD_LISTEN_FDS_START of sd_listen_fds(3): the first descriptor that is passed on.
constexpr int kFirstDescriptor = 3;

std::string takeVariable(const char* name) {
  const char* value = std::getenv(name);
  std::string text = value == nullptr ? "" : value;
  ::unsetenv(name);
  return text;
}

}  // namespace

core::Result<std::optional<InheritedSocket>> takeInheritedSocket() {
  const char* process = std::getenv("LISTEN_PID");
  if (process == nullptr || process != std::to_string(::getpid())) return std::optional<InheritedSocket>();
  takeVariable("LISTEN_PID");
  takeVariable("LISTEN_FDNAMES");
  const std::string count = takeVariable("LISTEN_FDS");
  if (count != "1") {
    return core::invalid(fmt::format(
        "LISTEN_FDS is \"{}\": the server takes exactly 1 listening socket; give the socket unit one ListenStream",
        count));
  }
  const auto unfit = [](const std::string& why) {
    return core::invalid(fmt::format("LISTEN_FDS: descriptor {} {}: pass a TCP socket that listens (ListenStream=PORT)",
                                     kFirstDescriptor, why));
  };
  int is_listening = 0;
  socklen_t size_bytes = sizeof is_listening;
  if (::getsockopt(kFirstDescriptor, SOL_SOCKET, SO_ACCEPTCONN, &is_listening, &size_bytes) != 0)
    return unfit(fmt::format("is not a socket ({})", std::strerror(errno)));
  if (is_listening == 0) return unfit("is a socket that does not listen");

  sockaddr_storage bound{};
  size_bytes = sizeof bound;
  if (::getsockname(kFirstDescriptor, reinterpret_cast<sockaddr*>(&bound), &size_bytes) != 0)
    return unfit(fmt::format("has no address ({})", std::strerror(errno)));
  InheritedSocket out{.descriptor = kFirstDescriptor, .address = std::string(INET6_ADDRSTRLEN, '\0'), .port = 0};
  const void* address = nullptr;
  if (bound.ss_family == AF_INET) {
    const auto& v4 = reinterpret_cast<const sockaddr_in&>(bound);
    address = &v4.sin_addr;
    out.port = ntohs(v4.sin_port);
  } else if (bound.ss_family == AF_INET6) {
    const auto& v6 = reinterpret_cast<const sockaddr_in6&>(bound);
    address = &v6.sin6_addr;
    out.port = ntohs(v6.sin6_port);
  } else {
    return unfit("is not a socket of IPv4 or IPv6");
  }
  ::inet_ntop(bound.ss_family, address, out.address.data(), INET6_ADDRSTRLEN);
  out.address.resize(std::strlen(out.address.c_str()));
  ::fcntl(kFirstDescriptor, F_SETFD, FD_CLOEXEC);
  return std::optional(std::move(out));
}

}  // namespace spindrift::cli
