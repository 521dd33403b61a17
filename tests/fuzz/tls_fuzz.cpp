// TLS as a client attacks it, and files of certificates and keys. The first byte says what is tried:
// 0: the bytes of a client that is not one of TLS, or not a whole one.
// 1: a real client whose bytes are changed at one place on their way: the place (two bytes, little endian; ffff: none),
//    the byte that is added there, what the client is like, the size of the server's buffer, then pieces that it sends,
//    each after its length; a length of 0 asks for new keys or another handshake.
// 2: two PEM files, certificates and key, divided by a byte of 0.
// 3: the length of a certificate (two bytes, little endian), the certificate and a key as DER; they are made PEM here.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/ssl.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <unistd.h>

#include <spindrift/core/bytes.h>

#include "certificates.h"
#include "fuzz.h"
#include "temporary_folder.h"
#include "tls_context.h"
#include "tls_credentials.h"
#include "transport.h"

namespace spindrift::fuzz {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;

/// What all inputs use. Files are in a folder of its own.
struct Fixture {
  Fixture() {
    spdlog::set_level(spdlog::level::off);
    // Without the system's authorities, whose reading takes most of the time.
    must(::setenv("SSL_CERT_FILE", (folder.path() / "none").c_str(), 1) == 0, "setenv");
    const auto made = test::writeCertificate(folder.path(), "tried");
    files = {.certificate_file = made.certificate, .key_file = made.key};
    auto loaded = net::TlsCredentials::load(files);
    must(static_cast<bool>(loaded), "the target's own certificate loads");
    running = *std::move(loaded);
    server = running->context();
  }
  test::TemporaryFolder folder;
  net::TlsFiles files;                           ///< written anew for every input that is one of files
  std::unique_ptr<net::TlsCredentials> running;  ///< reads them again
  std::shared_ptr<net::TlsContext> server;       ///< with the target's own certificate
};
Fixture& fixture() {
  static Fixture one;
  return one;
}

/// The server's side of a connection: shakes hands, sends back all that it reads, and shuts down at the end.
class Server {
 public:
  Server(asio::io_context& io, int socket, std::size_t buffer_bytes) : stream_(io), buffer_(buffer_bytes) {
    stream_.socket().assign(asio::ip::tcp::v4(), socket);
    stream_.useServerTls(*fixture().server);
  }

  void begin(asio::const_buffer received) {
    ++pending_count_;
    stream_.handshake(received, [this](error_code error, std::size_t) {
      answered();
      const std::string reason = stream_.tlsReasonOf(error);
      must(!reason.empty() && reason.find('\n') == std::string::npos, "the reason of a failed handshake is one line");
      is_open_ = !error;
      if (is_open_)
        read();
      else
        stream_.close();
    });
  }

  [[nodiscard]] bool isOpen() const { return is_open_; }
  [[nodiscard]] bool isDone() const { return pending_count_ == 0; }
  [[nodiscard]] const core::Bytes& received() const { return received_; }

 private:
  void answered() {
    must(pending_count_ > 0, "every operation calls its handler once");
    --pending_count_;
  }

  void read() {
    ++pending_count_;
    stream_.read(asio::buffer(buffer_), [this](error_code error, std::size_t count) {
      answered();
      must(count <= buffer_.size(), "no more is read than the buffer holds");
      if (error) return end();
      received_.insert(received_.end(), buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(count));
      echo(0, count);
    });
  }

  void echo(std::size_t done, std::size_t count) {
    if (done == count) return read();
    ++pending_count_;
    // Up to four parts, which become one record.
    std::array<asio::const_buffer, 4> parts;
    const std::size_t part_count = std::min(parts.size(), count - done);
    const std::size_t part_size = (count - done) / part_count;
    for (std::size_t k = 0; k < part_count; ++k) {
      const std::size_t begin = done + k * part_size;
      const std::size_t end = k + 1 == part_count ? count : begin + part_size;
      parts[k] = asio::buffer(&buffer_[begin], end - begin);
    }
    stream_.write(std::span(parts).first(part_count), [this, done, count](error_code error, std::size_t written) {
      answered();
      must(written <= count - done, "no more is written than there is");
      if (error || written == 0) return end();
      echo(done + written, count);
    });
  }

  void end() {
    ++pending_count_;
    stream_.linger(boost::beast::role_type::server, [this](error_code, std::size_t) { answered(); });
  }

  net::Transport stream_;
  core::Bytes buffer_;
  core::Bytes received_;
  bool is_open_ = false;
  int pending_count_ = 0;
};

/// Two ends of a connection that needs no network.
struct Connection {
  explicit Connection(std::size_t buffer_bytes) : server(io, open(), buffer_bytes) {}
  ~Connection() { hangUp(); }

  int open() {
    std::array<int, 2> ends{};
    must(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends.data()) == 0, "socketpair");
    client = ends[0];
    return ends[1];
  }
  void hangUp() {
    if (client >= 0) ::close(std::exchange(client, -1));
  }
  void send(core::ByteView bytes) const {
    (void)::send(client, bytes.data(), bytes.size(), MSG_NOSIGNAL);  // the server may have closed
  }
  /// Lets the server work; returns what it has sent.
  core::Bytes turn() {
    io.restart();
    io.poll();
    core::Bytes out;
    std::array<std::uint8_t, 16384> piece;
    for (;;) {
      const ssize_t count = ::recv(client, piece.data(), piece.size(), 0);
      if (count <= 0) return out;
      out.insert(out.end(), piece.begin(), piece.begin() + count);
    }
  }
  /// The client has gone: everything ends.
  void finish() {
    hangUp();
    io.restart();
    io.run_for(std::chrono::seconds(5));
    must(server.isDone(), "a connection whose peer has gone ends");
  }

  asio::io_context io;
  int client = -1;
  Server server;
};

void tryBytes(core::ByteView input) {
  if (input.empty()) return;
  // A connection reads before it knows that TLS comes.
  const std::size_t early = std::min<std::size_t>(input[0], input.size() - 1);
  const core::ByteView content = input.subspan(1);
  Connection connection(512);
  connection.server.begin({content.data(), early});
  (void)connection.turn();
  connection.send(content.subspan(early));
  for (int k = 0; k < 4; ++k) (void)connection.turn();
  must(!connection.server.isOpen(), "bytes that were made without the server's do not complete a handshake");
  connection.finish();
}

/// The client of OpenSSL, in memory.
class Client {
 public:
  enum Kind : std::uint8_t { kTls12 = 1, kOtherProtocol = 2, kVanishes = 4, kHttp = 8 };

  explicit Client(std::uint8_t kind) {
    static SSL_CTX* const context = [] {
      SSL_CTX* const out = SSL_CTX_new(TLS_client_method());
      SSL_CTX_set_session_cache_mode(out, SSL_SESS_CACHE_OFF);
      return out;
    }();
    ssl_ = SSL_new(context);
    SSL_set_bio(ssl_, BIO_new(BIO_s_mem()), BIO_new(BIO_s_mem()));
    SSL_set_connect_state(ssl_);
    if ((kind & kTls12) != 0) SSL_set_max_proto_version(ssl_, TLS1_2_VERSION);
    static constexpr std::string_view kHttpName = "\x08http/1.1";
    static constexpr std::string_view kOtherName = "\x02h2";
    if ((kind & (kOtherProtocol | kHttp)) != 0) {
      const std::string_view name = (kind & kOtherProtocol) != 0 ? kOtherName : kHttpName;
      SSL_set_alpn_protos(ssl_, reinterpret_cast<const unsigned char*>(name.data()),
                          static_cast<unsigned>(name.size()));
    }
  }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  ~Client() { SSL_free(ssl_); }

  bool shakeHands() { return SSL_do_handshake(ssl_) == 1; }
  void take(core::ByteView bytes) { BIO_write(SSL_get_rbio(ssl_), bytes.data(), static_cast<int>(bytes.size())); }
  core::Bytes give() {
    core::Bytes out(BIO_ctrl_pending(SSL_get_wbio(ssl_)));
    if (!out.empty()) BIO_read(SSL_get_wbio(ssl_), out.data(), static_cast<int>(out.size()));
    return out;
  }
  bool write(core::ByteView piece) {
    std::size_t written = 0;
    return SSL_write_ex(ssl_, piece.data(), piece.size(), &written) == 1 && written == piece.size();
  }
  void read() {
    std::array<std::uint8_t, 1024> piece;
    std::size_t count = 0;
    while (SSL_read_ex(ssl_, piece.data(), piece.size(), &count) == 1)
      echoed.insert(echoed.end(), piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(count));
  }
  void renew() {
    if (SSL_version(ssl_) == TLS1_3_VERSION)
      SSL_key_update(ssl_, SSL_KEY_UPDATE_REQUESTED);
    else
      SSL_renegotiate(ssl_);
  }
  void sayGoodbye() { SSL_shutdown(ssl_); }

  core::Bytes echoed;

 private:
  SSL* ssl_ = nullptr;
};

/// Changes one byte of a stream.
class Tamperer {
 public:
  Tamperer(std::size_t place, std::uint8_t change) : place_(place), change_(change) {}
  core::Bytes pass(core::Bytes bytes) {
    if (change_ != 0 && place_ >= passed_ && place_ - passed_ < bytes.size()) {
      bytes[place_ - passed_] ^= change_;
      has_changed_ = true;
    }
    passed_ += bytes.size();
    return bytes;
  }
  [[nodiscard]] bool hasChanged() const { return has_changed_; }

 private:
  const std::size_t place_;
  const std::uint8_t change_;
  std::size_t passed_ = 0;
  bool has_changed_ = false;
};

bool isPrefix(const core::Bytes& part, const core::Bytes& whole) {
  return part.size() <= whole.size() && std::equal(part.begin(), part.end(), whole.begin());
}

void tryTampering(core::ByteView input) {
  if (input.size() < 5) return;
  const std::size_t place = input[0] | input[1] << 8;
  const std::uint8_t kind = input[3];
  Tamperer tamperer(place, input[2]);
  Connection connection(1 + std::size_t{input[4]} * 16);
  Client client(kind);
  input = input.subspan(5);
  const auto exchange = [&] {
    for (int k = 0; k < 6; ++k) {
      connection.send(tamperer.pass(client.give()));
      client.take(connection.turn());
    }
  };
  connection.server.begin({});
  bool is_connected = false;
  for (int k = 0; k < 4 && !is_connected; ++k) {
    is_connected = client.shakeHands();
    exchange();
  }
  const bool is_acceptable = (kind & Client::kOtherProtocol) == 0;
  if (!tamperer.hasChanged())
    must(connection.server.isOpen() == is_acceptable, "a whole client is served if it speaks HTTP/1.1, and only then");
  core::Bytes sent;
  bool has_renewed = false;
  while (is_connected && !input.empty()) {
    const std::size_t length = std::min<std::size_t>(input[0], input.size() - 1);
    const core::ByteView piece = input.subspan(1, length);
    input = input.subspan(1 + length);
    if (length == 0) {
      client.renew();
      has_renewed = true;
    } else if (client.write(piece)) {
      sent.insert(sent.end(), piece.begin(), piece.end());
    }
    exchange();
    client.read();
  }
  if ((kind & Client::kVanishes) == 0) client.sayGoodbye();
  exchange();
  client.read();
  connection.finish();
  const core::Bytes& received = connection.server.received();
  must(isPrefix(received, sent), "the server reads what the client wrote, and nothing else");
  must(isPrefix(client.echoed, received), "the client reads what the server wrote");
  if (!tamperer.hasChanged() && is_acceptable && !has_renewed) {
    must(received.size() == sent.size(), "all that was written is read");
    must(client.echoed.size() == sent.size(), "and comes back");
  }
  ERR_clear_error();
}

void write(const std::string& file, std::string_view content) {
  std::ofstream(file, std::ios::binary) << content;
}

std::string pemOf(const char* name, std::string_view der) {
  std::string base64(4 * (der.size() / 3 + 1) + 1, '\0');
  const int count = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(base64.data()),
                                    reinterpret_cast<const unsigned char*>(der.data()), static_cast<int>(der.size()));
  base64.resize(static_cast<std::size_t>(count));
  std::string out = std::string("-----BEGIN ") + name + "-----\n";
  for (std::size_t at = 0; at < base64.size(); at += 64) out += base64.substr(at, 64) + "\n";
  return out + "-----END " + name + "-----\n";
}

void checkRefusal(const core::Error& error) {
  must(error.message.starts_with("--tls-"), "a refusal names the option");
  must(error.message.find('\n') == std::string::npos && error.message.size() < 1000, "a refusal is one line");
}

void tryFiles(std::string_view certificate, std::string_view key) {
  const net::TlsFiles& files = fixture().files;
  write(files.certificate_file, certificate);
  write(files.key_file, key);
  auto loaded = net::TlsCredentials::load(files);
  if (loaded) {
    must((*loaded)->context() != nullptr, "what is loaded can be used");
    (void)(*loaded)->expires();
  } else {
    checkRefusal(loaded.error());
  }
  auto trusted = net::TlsContext::forClient(files.certificate_file);
  if (!trusted) checkRefusal(trusted.error());
  net::TlsCredentials& running = *fixture().running;
  const auto before = running.context();
  const std::uint64_t reload_count = running.reloadCount() + running.failureCount();
  running.reload();
  must((running.context() != before) == static_cast<bool>(loaded),
       "a running server takes files over if they would be loaded, and only then");
  must(running.reloadCount() + running.failureCount() == reload_count + 1, "a reload is counted");
  must(ERR_peek_error() == 0, "no error of OpenSSL is left for the next operation of this thread");
}

}  // namespace
}  // namespace spindrift::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace spindrift;
  if (size == 0) return 0;
  const core::ByteView input(data + 1, size - 1);
  if (data[0] % 4 == 0) return fuzz::tryBytes(input), 0;
  if (data[0] % 4 == 1) return fuzz::tryTampering(input), 0;
  const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
  if (data[0] % 4 == 2) {
    const std::size_t end = std::min(text.find('\0'), text.size());
    fuzz::tryFiles(text.substr(0, end), text.substr(std::min(end + 1, text.size())));
  } else if (text.size() >= 2) {
    const std::size_t length = std::min<std::size_t>(input[0] | input[1] << 8, text.size() - 2);
    fuzz::tryFiles(fuzz::pemOf("CERTIFICATE", text.substr(2, length)),
                   fuzz::pemOf("PRIVATE KEY", text.substr(2 + length)));
  }
  return 0;
}
