#include "tcp_link.h"

#include <array>
#include <chrono>
#include <cstring>
#include <stdexcept>
#include <vector>

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace spindrift::test {
namespace {

constexpr int kPollPause_ms = 20;

sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

/// Copies what is there now; false at the end of the stream.
bool copy(int from, int to) {
  std::array<char, 65536> bytes{};
  const ssize_t count = ::recv(from, bytes.data(), bytes.size(), 0);
  if (count <= 0) return false;
  for (ssize_t sent = 0; sent < count;) {
    const ssize_t now = ::send(to, bytes.data() + sent, static_cast<std::size_t>(count - sent), MSG_NOSIGNAL);
    if (now <= 0) return false;
    sent += now;
  }
  return true;
}

struct Pair {
  int client = -1;
  int server = -1;
  void close() const {
    ::close(client);
    ::close(server);
  }
};

}  // namespace

TcpLink::TcpLink(std::uint16_t server_port) {
  listener_ = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address = loopback(0);
  socklen_t size = sizeof address;
  auto* const generic = reinterpret_cast<sockaddr*>(&address);
  if (listener_ < 0 || ::bind(listener_, generic, size) != 0 || ::listen(listener_, 64) != 0 ||
      ::getsockname(listener_, generic, &size) != 0) {
    throw std::runtime_error(std::string("the link of the test has no port: ") + std::strerror(errno));
  }
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this, server_port] { forward(server_port); });
}

TcpLink::~TcpLink() {
  stopping_ = true;
  thread_.join();
  ::close(listener_);
}

void TcpLink::forward(std::uint16_t server_port) {
  std::vector<Pair> pairs;
  while (!stopping_) {
    if (is_cut_) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      continue;
    }
    std::vector<pollfd> sockets{pollfd{listener_, POLLIN, 0}};
    for (const Pair& pair : pairs) {
      sockets.push_back({pair.client, POLLIN, 0});
      sockets.push_back({pair.server, POLLIN, 0});
    }
    if (::poll(sockets.data(), sockets.size(), kPollPause_ms) <= 0 || is_cut_) continue;
    std::vector<Pair> open;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      bool is_open = true;
      if (sockets[2 * k + 1].revents != 0) is_open = copy(pairs[k].client, pairs[k].server);
      if (is_open && sockets[2 * k + 2].revents != 0) is_open = copy(pairs[k].server, pairs[k].client);
      if (is_open)
        open.push_back(pairs[k]);
      else
        pairs[k].close();
    }
    pairs = std::move(open);
    if (sockets[0].revents == 0) continue;
    const Pair made{::accept(listener_, nullptr, nullptr), ::socket(AF_INET, SOCK_STREAM, 0)};
    const sockaddr_in address = loopback(server_port);
    const int on = 1;
    for (const int end : {made.client, made.server}) ::setsockopt(end, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    if (::connect(made.server, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0)
      pairs.push_back(made);
    else
      made.close();
  }
  for (const Pair& pair : pairs) pair.close();
}

}  // namespace spindrift::test
