#include "silent_proxy.h"

#include <array>
#include <chrono>
#include <stdexcept>

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace spindrift::test {
namespace {

using namespace std::chrono_literals;

constexpr int kPollPause_ms = 20;

sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

bool isReadable(int socket) {
  pollfd wanted{socket, POLLIN, 0};
  return ::poll(&wanted, 1, kPollPause_ms) > 0;
}

/// Copies what is there now; false at the end of the stream.
bool copy(int from, int to) {
  std::array<char, 16384> bytes{};
  const ssize_t count = ::recv(from, bytes.data(), bytes.size(), 0);
  if (count <= 0) return false;
  for (ssize_t sent = 0; sent < count;) {
    const ssize_t now = ::send(to, bytes.data() + sent, static_cast<std::size_t>(count - sent), MSG_NOSIGNAL);
    if (now <= 0) return false;
    sent += now;
  }
  return true;
}

}  // namespace

SilentProxy::SilentProxy(std::uint16_t server_port) {
  listener_ = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address = loopback(0);
  socklen_t size = sizeof address;
  auto* const generic = reinterpret_cast<sockaddr*>(&address);
  if (listener_ < 0 || ::bind(listener_, generic, size) != 0 || ::listen(listener_, 1) != 0 ||
      ::getsockname(listener_, generic, &size) != 0) {
    throw std::runtime_error("the proxy of the test has no port");
  }
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this, server_port] { forward(server_port); });
}

SilentProxy::~SilentProxy() {
  stopping_ = true;
  thread_.join();
  ::close(listener_);
}

void SilentProxy::forward(std::uint16_t server_port) {
  while (!stopping_ && !isReadable(listener_)) {
  }
  if (stopping_) return;
  const int client = ::accept(listener_, nullptr, nullptr);
  const int server = ::socket(AF_INET, SOCK_STREAM, 0);
  const sockaddr_in address = loopback(server_port);
  bool is_open = ::connect(server, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  while (is_open && !stopping_) {
    if (silent_) {
      std::this_thread::sleep_for(10ms);
      continue;
    }
    std::array<pollfd, 2> both{pollfd{client, POLLIN, 0}, pollfd{server, POLLIN, 0}};
    if (::poll(both.data(), both.size(), kPollPause_ms) <= 0 || silent_) continue;
    if (both[0].revents != 0) is_open = copy(client, server);
    if (is_open && both[1].revents != 0) is_open = copy(server, client);
  }
  ::close(client);
  ::close(server);
}

}  // namespace spindrift::test
