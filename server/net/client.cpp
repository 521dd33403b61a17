#include <deque>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>

#include <spindrift/net/client.h>

#include "tls_context.h"
#include "transport.h"

namespace spindrift::net {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using asio::ip::tcp;

constexpr std::chrono::seconds kCloseTimeout{2};

using TlsResult = core::Result<std::shared_ptr<TlsContext>>;

class ClientImpl final : public Client, public std::enable_shared_from_this<ClientImpl> {
 public:
  /// `tls`: of the pool; not used for ws://.
  ClientImpl(asio::any_io_executor strand, ClientUrl url, TlsResult tls, const ClientOptions& options,
             ClientEvents events)
      : strand_(std::move(strand)),
        ws_(strand_),
        tls_(std::move(tls)),
        wake_(strand_),
        url_(std::move(url)),
        options_(options),
        events_(std::move(events)) {}

  void start() {
    asio::co_spawn(
        strand_, [self = shared_from_this()] { return self->run(); }, asio::detached);
  }

  bool send(core::SharedBytes message) override {
    {
      const std::lock_guard lock(mutex_);
      if (queue_.size() >= kClientQueueMaxCount) return false;
      queue_.push_back(std::move(message));
    }
    asio::post(strand_, [self = shared_from_this()] { self->wake_.cancel(); });
    return true;
  }

  void close() override {
    asio::post(strand_, [self = shared_from_this()] {
      self->closing_ = true;
      self->wake_.cancel();
    });
  }

  void vanish() override {
    asio::post(strand_, [self = shared_from_this()] { self->cut(); });
  }

 private:
  asio::awaitable<void> run() {
    std::string failure = co_await open();
    if (!failure.empty()) {
      events_.closed(0, failure);
      co_return;
    }
    events_.opened();
    asio::co_spawn(
        strand_, [self = shared_from_this()] { return self->writeLoop(); }, asio::detached);
    if (options_.reads) {
      co_await readLoop();
    } else {
      asio::steady_timer never(strand_, asio::steady_timer::time_point::max());
      until_cut_ = &never;
      if (!is_cut_) (void)co_await never.async_wait(kToken);
      until_cut_ = nullptr;
    }
    is_over_ = true;
    wake_.cancel();
    events_.closed(code_, reason_);
  }

  /// Opens the session; returns an empty string, or the reason of the failure.
  asio::awaitable<std::string> open() {
    if (!tls_) co_return tls_.error().message;
    tcp::resolver resolver(strand_);
    const auto [resolve_error, places] = co_await resolver.async_resolve(url_.host, url_.port, kToken);
    if (resolve_error) co_return url_.host + " is not known: " + resolve_error.message();
    Transport& stream = ws_.next_layer();
    stream.expires_after(options_.connect_timeout);
    const auto [connect_error, place] = co_await stream.tcp().async_connect(places, kToken);
    if (connect_error) co_return "no connection to " + url_.host + ":" + url_.port + ": " + connect_error.message();
    boost::system::error_code ignored;
    stream.socket().set_option(tcp::no_delay(true), ignored);
    if (options_.receive_buffer_bytes > 0) {
      stream.socket().set_option(asio::socket_base::receive_buffer_size(options_.receive_buffer_bytes), ignored);
    }
    if (url_.is_tls) {
      stream.useClientTls(**tls_, url_.host);
      const auto [tls_error, bytes_count] = co_await stream.async_handshake({}, kToken);
      if (tls_error) {
        co_return "no TLS with " + url_.host + ":" + url_.port + ": " + stream.tlsReasonOf(tls_error);
      }
    }
    stream.expires_never();
    ws_.set_option(websocket::stream_base::timeout{options_.connect_timeout, websocket::stream_base::none(), false});
    ws_.set_option(websocket::stream_base::decorator([](websocket::request_type& request) {
      request.set(beast::http::field::sec_websocket_protocol, "spindrift.v1");
    }));
    ws_.binary(true);
    ws_.auto_fragment(false);
    ws_.read_message_max(options_.message_max_bytes);
    websocket::response_type response;
    const auto [error] = co_await ws_.async_handshake(response, url_.host + ":" + url_.port, url_.path, kToken);
    if (error == websocket::error::upgrade_declined) {
      co_return "the server refused the connection with HTTP " + std::to_string(response.result_int()) + ": " +
          std::string(response.body());
    }
    if (error) co_return "the handshake failed: " + error.message();
    co_return std::string();
  }

  asio::awaitable<void> readLoop() {
    beast::flat_buffer buffer;
    while (true) {
      const auto [error, bytes_count] = co_await ws_.async_read(buffer, kToken);
      if (error) {
        code_ = error == websocket::error::closed ? ws_.reason().code : std::uint16_t{0};
        reason_ = error == websocket::error::closed ? std::string(ws_.reason().reason.c_str()) : error.message();
        co_return;
      }
      events_.message({static_cast<const std::uint8_t*>(buffer.data().data()), bytes_count});
      buffer.consume(buffer.size());
    }
  }

  asio::awaitable<void> writeLoop() {
    while (!is_over_ && !is_cut_) {
      core::SharedBytes message = nextMessage();
      if (message) {
        const auto [error, bytes_count] = co_await ws_.async_write(asio::buffer(*message), kToken);
        if (error) co_return cut();
      } else if (closing_) {
        ws_.set_option(websocket::stream_base::timeout{kCloseTimeout, websocket::stream_base::none(), false});
        (void)co_await ws_.async_close(websocket::close_code::normal, kToken);
        co_return;
      } else {
        // send() posts its wake-up to this strand, so it cannot run between this check and the wait.
        wake_.expires_at(asio::steady_timer::time_point::max());
        (void)co_await wake_.async_wait(kToken);
      }
    }
  }

  core::SharedBytes nextMessage() {
    const std::lock_guard lock(mutex_);
    if (queue_.empty()) return nullptr;
    core::SharedBytes out = std::move(queue_.front());
    queue_.pop_front();
    return out;
  }

  void cut() {
    is_cut_ = true;
    beast::get_lowest_layer(ws_).close();
    wake_.cancel();
    if (until_cut_) until_cut_->cancel();
  }

  const asio::any_io_executor strand_;
  websocket::stream<Transport, false> ws_;
  const TlsResult tls_;
  asio::steady_timer wake_;
  const ClientUrl url_;
  const ClientOptions options_;
  const ClientEvents events_;
  asio::steady_timer* until_cut_ = nullptr;
  bool closing_ = false;
  bool is_cut_ = false;
  bool is_over_ = false;
  std::uint16_t code_ = 0;
  std::string reason_;
  std::mutex mutex_;
  std::deque<core::SharedBytes> queue_;
};

class ClientPoolImpl final : public ClientPool {
 public:
  ClientPoolImpl(std::size_t thread_count, std::string ca_file)
      : work_(io_.get_executor()), ca_file_(std::move(ca_file)) {
    for (std::size_t k = 0; k < thread_count; ++k) threads_.emplace_back([this] { io_.run(); });
  }
  ClientPoolImpl(const ClientPoolImpl&) = delete;
  ClientPoolImpl& operator=(const ClientPoolImpl&) = delete;
  ~ClientPoolImpl() override {
    io_.stop();
    for (std::thread& thread : threads_) thread.join();
  }

  std::shared_ptr<Client> connect(const ClientUrl& url, const ClientOptions& options, ClientEvents events) override {
    TlsResult tls = url.is_tls ? tlsContext() : TlsResult(std::shared_ptr<TlsContext>());
    auto client = std::make_shared<ClientImpl>(asio::make_strand(io_), url, std::move(tls), options, std::move(events));
    client->start();
    return client;
  }

  void runFor(std::chrono::milliseconds duration, const std::function<bool()>& done) override {
    const auto deadline = std::chrono::steady_clock::now() + duration;
    while (!done() && std::chrono::steady_clock::now() < deadline) {
      if (io_.run_one_until(deadline) == 0) return;
    }
  }

 private:
  TlsResult tlsContext() {
    const std::lock_guard lock(mutex_);
    if (!tls_) tls_ = TlsContext::forClient(ca_file_);
    return *tls_;
  }

  asio::io_context io_;
  asio::executor_work_guard<asio::io_context::executor_type> work_;
  const std::string ca_file_;
  std::mutex mutex_;
  std::optional<TlsResult> tls_;  ///< made for the first wss://
  std::vector<std::thread> threads_;
};

}  // namespace

core::Result<ClientUrl> ClientUrl::parse(const std::string& url) {
  const auto refuse = [&](const std::string& why) {
    return core::Error{core::ErrorCode::kInvalidInput, "--url '" + url + "': " + why};
  };
  constexpr const char* kForm = "write ws://HOST:PORT or wss://HOST:PORT";
  const bool is_tls = url.starts_with("wss://");
  if (!is_tls && !url.starts_with("ws://")) return refuse(kForm);
  const std::string rest = url.substr(url.find("//") + 2);
  const std::size_t slash = rest.find('/');
  const std::string authority = rest.substr(0, slash);
  ClientUrl out{.host = authority,
                .port = is_tls ? "443" : "80",
                .path = slash == std::string::npos ? "/" : rest.substr(slash),
                .is_tls = is_tls};
  const std::size_t bracket = authority.rfind(']');
  const std::size_t colon = authority.rfind(':');
  if (colon != std::string::npos && (bracket == std::string::npos || colon > bracket)) {
    out.host = authority.substr(0, colon);
    out.port = authority.substr(colon + 1);
  }
  if (out.host.starts_with('[') && out.host.ends_with(']')) out.host = out.host.substr(1, out.host.size() - 2);
  const bool is_port = !out.port.empty() && out.port.size() <= 5 &&
                       out.port.find_first_not_of("0123456789") == std::string::npos && std::stoi(out.port) <= 65535;
  if (out.host.empty() || !is_port) return refuse(kForm);
  boost::system::error_code error;
  const auto address = asio::ip::make_address(out.host, error);
  if (!error && address.is_v6() && address.to_v6().is_link_local() && address.to_v6().scope_id() == 0)
    return refuse("a link-local address needs its interface: write [" + out.host + "%eth0]");
  return out;
}

ClientUrl ClientUrl::inRoom(const std::string& room) const {
  constexpr std::string_view kSocket = "/ws";
  std::string_view base = std::string_view(path).substr(0, path.find('?'));
  const std::string_view parent = base.substr(0, base.rfind('/'));
  const bool is_socket = base.ends_with(kSocket) || parent.ends_with(kSocket);
  if (is_socket && room.empty()) return *this;
  if (is_socket) base = parent.ends_with(kSocket) ? parent.substr(0, parent.size() - kSocket.size()) : parent;
  while (base.ends_with('/')) base.remove_suffix(1);
  ClientUrl out = *this;
  out.path = std::string(base) + std::string(kSocket) + (room.empty() ? "" : "/" + room);
  return out;
}

std::unique_ptr<ClientPool> ClientPool::create(std::size_t thread_count, const std::string& ca_file) {
  return std::make_unique<ClientPoolImpl>(thread_count, ca_file);
}

}  // namespace spindrift::net
