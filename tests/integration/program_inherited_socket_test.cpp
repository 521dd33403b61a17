// `spindrift serve` with a listening socket that another program opened (socket activation, sd_listen_fds(3)).
#include <csignal>
#include <memory>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "program_fixture.h"

namespace spindrift::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// A socket on a free port of the loopback interface, as the program that starts the server would hold it.
class LoopbackSocket {
 public:
  enum class State { kBound, kListening };
  explicit LoopbackSocket(State state = State::kListening) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size_bytes = sizeof address;
    const bool is_bound = ::bind(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0 &&
                          (state == State::kBound || ::listen(socket_, 8) == 0) &&
                          ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size_bytes) == 0;
    port_ = is_bound ? ntohs(address.sin_port) : 0;
  }
  LoopbackSocket(const LoopbackSocket&) = delete;
  LoopbackSocket& operator=(const LoopbackSocket&) = delete;
  ~LoopbackSocket() { ::close(socket_); }
  int descriptor() const { return socket_; }
  std::uint16_t port() const { return port_; }

 private:
  int socket_;
  std::uint16_t port_ = 0;
};

class InheritedSocketOfServe : public ProgramTest {
 protected:
  /// Starts `serve` with `descriptor` as number 3. The shell knows the process id, which the variable has to hold.
  std::unique_ptr<ChildProcess> start(int descriptor, const std::string& count, const std::string& process = "$$") {
    return std::make_unique<ChildProcess>(
        "/bin/sh",
        std::vector<std::string>{"-c", "export LISTEN_PID=" + process + "; exec \"$0\" \"$@\"", SPINDRIFT_PROGRAM,
                                 "serve", "--scene", smallScene(), "--device", "software", "--address", "0.0.0.0",
                                 "--port", "0"},
        std::vector<std::string>{"LISTEN_FDS=" + count, "LISTEN_FDNAMES=spindrift.socket"}, descriptor);
  }
  /// Connects and asks for /healthz, without waiting for the answer.
  static RawTcp asking(std::uint16_t port) {
    RawTcp client;
    EXPECT_TRUE(client.connect("127.0.0.1", port));
    EXPECT_TRUE(client.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"));
    return client;
  }
  static void expectRefusal(ChildProcess& child, const std::vector<std::string>& words) {
    const auto exit_code = child.wait();
    expectOneErrorLine({exit_code.value_or(-1), child.out(), child.err()}, 2, words);
  }
};

TEST_F(InheritedSocketOfServe, ServesClientsThatConnectedBeforeTheStart) {
  const LoopbackSocket socket;
  for (int k = 0; k < 2; ++k) {
    RawTcp early = asking(socket.port());
    const auto server = start(socket.descriptor(), "1");
    const auto line = server->waitForLine("Spindrift is ready: ");
    if (!line && server->wait() == 3) GTEST_SKIP() << server->err();
    ASSERT_TRUE(line) << server->err();
    EXPECT_EQ(*line, "Spindrift is ready: http://127.0.0.1:" + std::to_string(socket.port()) + "/");
    EXPECT_THAT(early.receiveAll(), StartsWith("HTTP/1.1 200 "));
    server->signal(SIGTERM);
    EXPECT_EQ(server->wait(), 0);
    EXPECT_THAT(server->err(), HasSubstr("--address and --port have no effect"));
    // No warning about clients from other machines: the socket is bound to the loopback, whatever --address says.
    EXPECT_THAT(server->out(), Not(HasSubstr("Link of the operator")));
    EXPECT_THAT(server->err(), Not(HasSubstr("no roles are configured")));
  }
}

TEST_F(InheritedSocketOfServe, SocketsForAnotherProcessAreLeftAlone) {
  const LoopbackSocket socket;
  const auto server = start(socket.descriptor(), "1", "1");
  const auto line = server->waitForLine("Spindrift is ready: ");
  if (!line && server->wait() == 3) GTEST_SKIP() << server->err();
  ASSERT_TRUE(line) << server->err();
  EXPECT_THAT(*line, StartsWith("Spindrift is ready: http://0.0.0.0:"));
  EXPECT_THAT(*line, Not(HasSubstr(":" + std::to_string(socket.port()) + "/")));
}

TEST_F(InheritedSocketOfServe, AnythingButOneListeningSocketIsRefused) {
  const LoopbackSocket socket;
  expectRefusal(*start(socket.descriptor(), "2"), {"LISTEN_FDS is \"2\"", "exactly 1", "ListenStream"});
  expectRefusal(*start(socket.descriptor(), "one"), {"LISTEN_FDS is \"one\"", "exactly 1"});
  expectRefusal(*start(-1, "1"), {"descriptor 3", "is not a socket", "ListenStream"});
  const LoopbackSocket bound(LoopbackSocket::State::kBound);
  expectRefusal(*start(bound.descriptor(), "1"), {"descriptor 3", "does not listen"});
  int pair[2];
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair), 0);
  expectRefusal(*start(pair[0], "1"), {"descriptor 3", "does not listen"});
  ::close(pair[0]);
  ::close(pair[1]);
}

}  // namespace
}  // namespace spindrift::test
