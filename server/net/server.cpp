// The listener and the I/O threads: start, accept, stop.
#include <cerrno>
#include <exception>
#include <memory>
#include <thread>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <spdlog/spdlog.h>

#include <spindrift/net/server.h>

#include "connection.h"
#include "server_context.h"

namespace spindrift::net {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

/// Out of file descriptors or memory: retrying at once would only spin.
constexpr std::chrono::milliseconds kAcceptPause{100};
/// Frames of one moment of the water that come within this time are written together in rooms with many sessions; see
/// Hub::kGatherSessionCount. The layers are encoded within this time.
constexpr std::chrono::milliseconds kGatherTime{1};
/// stop() waits this much longer than close_timeout.
constexpr std::chrono::seconds kStopGrace{1};

class ServerImpl final : public Server {
 public:
  ServerImpl(const ServerOptions& options, TrustedNetworks proxies, std::unique_ptr<TlsCredentials> credentials,
             Application& application)
      : context_{options, std::move(proxies), std::move(credentials), application},
        accept_strand_(newStrand()),
        acceptor_(accept_strand_) {
    context_.hub.gatherFrames(
        [this](std::function<void()> wake) {
          const auto timer = std::make_shared<asio::steady_timer>(io_, kGatherTime);
          timer->async_wait([timer, wake = std::move(wake)](const boost::system::error_code& error) {
            if (!error) wake();
          });
        },
        [this](std::function<void()> write) { asio::post(io_, std::move(write)); });
  }
  ServerImpl(const ServerImpl&) = delete;
  ServerImpl& operator=(const ServerImpl&) = delete;
  // stop() throws only without memory, or for a thread that does not exist.
  ~ServerImpl() override { stop(); }  // NOLINT(bugprone-exception-escape)

  core::Result<void> listen();
  void run();
  void drain(std::chrono::seconds retry_after) override {
    context_.retry_after_s = std::max<std::int64_t>(1, retry_after.count());
  }
  void reloadCertificate() override;

  std::uint16_t port() const override { return port_; }
  Hub& hub() override { return context_.hub; }
  ServerStats stats() const override;
  void stop() override;

 private:
  /// Returns an executor whose handlers run one at a time. A single thread needs no lock for that.
  asio::any_io_executor newStrand() {
    if (context_.options.thread_count <= 1) return io_.get_executor();
    return asio::make_strand(io_);
  }
  core::Result<void> bind(const asio::ip::address& address);
  asio::awaitable<void> acceptLoop();
  asio::awaitable<void> watchCertificate();

  ServerContext context_;
  asio::io_context io_;
  asio::any_io_executor accept_strand_;
  tcp::acceptor acceptor_;
  asio::executor_work_guard<asio::io_context::executor_type> work_{io_.get_executor()};
  std::uint16_t port_ = 0;
  std::uint64_t last_connection_id_ = 0;
  asio::steady_timer watch_timer_{accept_strand_};  ///< of watchCertificate()
  std::mutex stop_mutex_;
  bool stopped_ = false;
  std::vector<std::thread> threads_;
};

core::Result<void> ServerImpl::listen() {
  const ServerOptions& options = context_.options;
  boost::system::error_code error;
  const auto address = asio::ip::make_address(options.address, error);
  if (error) {
    return core::unavailable("the address \"" + options.address + "\" (port " + std::to_string(options.port) +
                             ") is not an IP address: give one such as 127.0.0.1, 0.0.0.0 or ::1 with --address");
  }
  if (options.listening_socket) {
    acceptor_.assign(address.is_v6() ? tcp::v6() : tcp::v4(), *options.listening_socket, error);
    if (error) {
      return core::unavailable("the listening socket in descriptor " + std::to_string(*options.listening_socket) +
                               " cannot be used (" + error.message() + "): pass a TCP socket that listens");
    }
  } else if (const core::Result<void> bound = bind(address); !bound) {
    return bound;
  }
  port_ = acceptor_.local_endpoint().port();
  // Logged before any thread exists: the first line initialises shared state of the logger, unseen by the thread
  // sanitizer.
  spdlog::debug("port {} is open", port_);
  return {};
}

core::Result<void> ServerImpl::bind(const asio::ip::address& address) {
  const ServerOptions& options = context_.options;
  const std::string port_text = std::to_string(options.port);
  boost::system::error_code error;
  const tcp::endpoint endpoint(address, options.port);
  const auto step = [&error](auto&& action) {
    if (!error) action();
  };
  step([&] { acceptor_.open(endpoint.protocol(), error); });
  // On Linux this only allows ports of connections in TIME_WAIT; a second listener is still refused.
  step([&] { acceptor_.set_option(asio::socket_base::reuse_address(true), error); });
  step([&] { acceptor_.bind(endpoint, error); });
  step([&] { acceptor_.listen(asio::socket_base::max_listen_connections, error); });
  const std::string where = "port " + port_text + " on " + options.address;
  if (error == boost::system::errc::address_in_use) {
    return core::unavailable(where + " is in use: stop the other program or choose another with --port");
  }
  if (error == boost::system::errc::address_not_available) {
    return core::unavailable(
        where + " is not available: this machine does not have that address; choose another with --address");
  }
  if (error == boost::system::errc::permission_denied) {
    return core::unavailable(where + " needs more rights than this user has: choose one above 1023 with --port");
  }
  if (error) return core::unavailable(where + " cannot be listened on (" + error.message() + "): choose another");
  return {};
}

void ServerImpl::run() {
  context_.application.serverStarts(context_.hub);
  asio::co_spawn(accept_strand_, acceptLoop(), [](const std::exception_ptr& failure) {
    try {
      if (failure) std::rethrow_exception(failure);
    } catch (const std::exception& error) {
      spdlog::critical("the listener failed: {}", error.what());
    }
  });
  if (context_.credentials) asio::co_spawn(accept_strand_, watchCertificate(), asio::detached);
  const std::size_t thread_count = std::max<std::size_t>(1, context_.options.thread_count);
  for (std::size_t k = 0; k < thread_count; ++k) {
    threads_.emplace_back([this] {
      while (true) {
        try {
          io_.run();
          return;
        } catch (const std::exception& error) {
          spdlog::error("an I/O handler failed: {}", error.what());
        }
      }
    });
  }
}

asio::awaitable<void> ServerImpl::acceptLoop() {
  RareLine failed;
  RareLine refused;
  while (acceptor_.is_open()) {
    auto [error, socket] = co_await acceptor_.async_accept(newStrand(), kToken);
    if (error == asio::error::operation_aborted) break;
    if (error) {
      context_.counters.add(&ServerStats::failed_accept_count);
      if (const auto count = failed.count(Clock::now())) {
        spdlog::warn("{} new connections could not be accepted ({}); {} are open and continue", *count, error.message(),
                     context_.connections.count());
      }
      asio::steady_timer pause(accept_strand_, kAcceptPause);
      (void)co_await pause.async_wait(kToken);
      continue;
    }
    const std::uint64_t id = ++last_connection_id_;
    auto connection = std::make_shared<Connection>(id, std::move(socket), context_);
    if (context_.connections.add(id, connection)) {
      connection->start();
    } else {
      context_.counters.refused(Refused::kConnection);
      if (const auto count = refused.count(Clock::now())) {
        spdlog::warn("{} new connections were closed without a reply: the limit of {} open ones is reached", *count,
                     context_.connections.maxCount());
      }
    }
  }
}

asio::awaitable<void> ServerImpl::watchCertificate() {
  while (acceptor_.is_open()) {
    watch_timer_.expires_after(context_.options.tls_watch_interval);
    const auto [error] = co_await watch_timer_.async_wait(kToken);
    if (error) co_return;
    context_.credentials->reloadIfChanged();
  }
}

void ServerImpl::reloadCertificate() {
  if (!context_.credentials) return;
  asio::post(accept_strand_, [this] { context_.credentials->reload(); });
}

ServerStats ServerImpl::stats() const {
  ServerStats out = context_.counters.stats();
  out.open_connection_count = context_.connections.count();
  out.connection_max_count = context_.connections.maxCount();
  if (const TlsCredentials* const credentials = context_.credentials.get()) {
    out.tls_reload_count = credentials->reloadCount();
    out.failed_tls_reload_count = credentials->failureCount();
    out.certificate_expires = credentials->expires();
  }
  const Waiting waiting = context_.hub.waiting();
  out.waiting_control_count = waiting.answer_count + waiting.state_count;
  out.waiting_frame_count = waiting.frame_count;
  return out;
}

void ServerImpl::stop() {
  const std::lock_guard lock(stop_mutex_);
  if (std::exchange(stopped_, true) || threads_.empty()) return;
  const auto deadline = Clock::now() + context_.options.close_timeout + kStopGrace;
  asio::post(accept_strand_, [this] {
    boost::system::error_code ignored;
    acceptor_.close(ignored);
    watch_timer_.cancel();
  });
  context_.connections.close();
  for (const auto& connection : context_.connections.all()) connection->shutDown();
  if (!context_.connections.waitEmpty(deadline)) {
    for (const auto& connection : context_.connections.all()) connection->cut();
    // All sockets are closed. Only running application callbacks are left; the threads wait for them too.
    context_.connections.waitEmpty(Clock::time_point::max());
  }
  work_.reset();
  io_.stop();
  for (std::thread& thread : threads_) thread.join();
  spdlog::debug("port {} is closed", port_);
}

}  // namespace

core::Result<std::unique_ptr<Server>> Server::start(const ServerOptions& options, Application& application) {
  auto proxies = TrustedNetworks::parse(options.trusted_proxies);
  if (!proxies) return core::Error{proxies.error().code, "--trust-proxy " + proxies.error().message};
  std::unique_ptr<TlsCredentials> credentials;
  if (options.tls) {
    auto loaded = TlsCredentials::load(*options.tls);
    if (!loaded) return loaded.error();
    credentials = *std::move(loaded);
  }
  auto server = std::make_unique<ServerImpl>(options, *std::move(proxies), std::move(credentials), application);
  const core::Result<void> listening = server->listen();
  if (!listening) return listening.error();
  server->run();
  return std::unique_ptr<Server>(std::move(server));
}

}  // namespace spindrift::net
