#include "nats_process.h"

#include <array>
#include <stdexcept>

#include <arpa/inet.h>
#include <boost/json.hpp>
#include <sys/socket.h>
#include <unistd.h>

namespace spindrift::test {

void NatsProcess::start() {
  const auto log = folder_ / "nats.log";
  std::filesystem::remove(log);
  const auto port = [](int known) { return std::to_string(known == 0 ? -1 : known); };
  process_ = std::make_unique<LoggedProcess>("/usr/sbin/nats-server -a 127.0.0.1 -js -sd '" + data().string() +
                                                 "' -p " + port(port_) + " -m " + port(monitor_port_),
                                             log);
  const std::string text = process_->waitForLog("Server is ready");
  if (text.empty()) throw std::runtime_error("nats-server does not start: " + process_->log());
  const auto number_after = [&](const std::string& mark) {
    const std::size_t at = text.find(mark);
    if (at == std::string::npos) throw std::runtime_error("nats-server does not say '" + mark + "': " + text);
    return std::stoi(text.substr(at + mark.size()));
  };
  port_ = number_after("client connections on 127.0.0.1:");
  monitor_port_ = number_after("http monitor on 127.0.0.1:");
}

void NatsProcess::kill() {
  process_->signal(SIGKILL);
  process_->wait();
}

std::string NatsProcess::ask(const std::string& subject) const {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port());
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    throw std::runtime_error("no connection to the NATS server of the test");
  const std::string request =
      "CONNECT {\"verbose\":false}\r\nSUB _INBOX.test 1\r\nPUB " + subject + " _INBOX.test 0\r\n\r\n";
  (void)::send(socket, request.data(), request.size(), MSG_NOSIGNAL);
  const timeval patience{5, 0};
  ::setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  std::string text;
  std::array<char, 65536> bytes{};
  const auto complete = [&]() -> std::string {  // MSG SUBJECT NUMBER SIZE, then so many bytes
    const std::size_t head = text.find("MSG ");
    const std::size_t end = text.find("\r\n", head);
    if (head == std::string::npos || end == std::string::npos) return "";
    const std::size_t size = std::stoul(text.substr(text.rfind(' ', end) + 1));
    return text.size() < end + 2 + size ? "" : text.substr(end + 2, size);
  };
  while (complete().empty()) {
    const ssize_t count = ::recv(socket, bytes.data(), bytes.size(), 0);
    if (count <= 0) break;
    text.append(bytes.data(), static_cast<std::size_t>(count));
  }
  ::close(socket);
  if (complete().empty()) throw std::runtime_error("NATS did not answer " + subject + ": " + text);
  return complete();
}

int NatsProcess::endConsumers(const std::string& bucket) const {
  const auto listed = boost::json::parse(ask("$JS.API.CONSUMER.NAMES.KV_" + bucket));
  int count = 0;
  for (const auto& name : listed.at("consumers").as_array()) {
    (void)ask("$JS.API.CONSUMER.DELETE.KV_" + bucket + "." + std::string(name.as_string()));
    ++count;
  }
  return count;
}

void NatsProcess::removeBucket(const std::string& bucket) const {
  (void)ask("$JS.API.STREAM.DELETE.KV_" + bucket);
}

}  // namespace spindrift::test
