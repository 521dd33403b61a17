// The stream below HTTP and WebSocket: TCP, or TLS over TCP. Beast reads and writes through functions without
// templates: what lies below them, OpenSSL included, is compiled once and not for each of Beast's operations, for one
// allocation per operation.
#pragma once

#include <chrono>
#include <concepts>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/async_result.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/role.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/container/static_vector.hpp>
#include <boost/system/error_code.hpp>

namespace spindrift::net {

/// Completion token: co_await returns a tuple that begins with the error code, and throws nothing.
inline constexpr auto kToken = boost::asio::as_tuple(boost::asio::use_awaitable);

/// Settings of many connections: certificate and key of a server, or the authorities that a client trusts. Thread-safe.
struct TlsContext;

/// Models AsyncStream of Beast. Used on its executor, a strand; one read and one write may be in progress at a time.
/// Movable; a moved-from stream can only be destroyed.
class Transport {
 public:
  using executor_type = boost::beast::tcp_stream::executor_type;
  /// Called on the executor, never before the function that took it returns.
  using Handler = std::function<void(boost::system::error_code, std::size_t)>;
  /// Most buffers of one write; asio passes no more to the kernel, either.
  static constexpr std::size_t kPartMaxCount = 64;
  using Parts = boost::container::static_vector<boost::asio::const_buffer, kPartMaxCount>;

  template <typename Socket>
  explicit Transport(Socket&& socket_or_executor) requires(!std::is_base_of_v<Transport, std::remove_cvref_t<Socket>>)
      : state_(std::make_shared<State>(std::forward<Socket>(socket_or_executor))) {}
  Transport(const Transport&) = default;
  Transport(Transport&&) = default;
  virtual ~Transport() = default;

  executor_type get_executor() { return state_->tcp.get_executor(); }
  boost::beast::tcp_stream& tcp() { return state_->tcp; }
  boost::asio::ip::tcp::socket& socket() { return state_->tcp.socket(); }
  /// Deadline of all operations from now on; the stream is closed when it passes.
  void expires_after(std::chrono::nanoseconds duration) { state_->tcp.expires_after(duration); }
  void expires_never() { state_->tcp.expires_never(); }
  /// Closes the socket at once.
  void close() { state_->tcp.close(); }

  /// From here on everything but tcp() goes through TLS; call async_handshake() next.
  void useServerTls(TlsContext& context);
  /// The same at the client's side. `host`: name or IP address that the server's certificate must have.
  void useClientTls(TlsContext& context, const std::string& host);
  [[nodiscard]] bool isTls() const { return state_->tls != nullptr; }
  /// Says for people why a TLS handshake failed with this error.
  [[nodiscard]] std::string tlsReasonOf(const boost::system::error_code& error) const;

  /// Reads at least one byte. The bytes of `into` stay valid until the handler is called.
  virtual void read(boost::asio::mutable_buffer into, Handler handler);
  /// Writes the beginning of `parts`, which has at least one and none that is empty; reports how much. The bytes stay
  /// valid until then, the array of parts only during the call.
  virtual void write(std::span<const boost::asio::const_buffer> parts, Handler handler);

  /// TLS only. `received`: bytes that were read from tcp() before; they stay valid until the handler is called.
  void handshake(boost::asio::const_buffer received, Handler handler);
  /// Ends our side, TLS and TCP, and then reads and drops what the peer still sends until it ends its own, for at most
  /// kLingerTime and kLingerBytes; then the socket is closed. Without this, bytes that nobody has read would reset the
  /// connection, and the peer could lose our last words (RFC 9112 section 9.6). Reports no error. `role`: a client lets
  /// the server end its side first (RFC 6455 section 7.1.1).
  void linger(boost::beast::role_type role, Handler handler);
  static constexpr std::chrono::seconds kLingerTime{1};
  static constexpr std::size_t kLingerBytes = 4 * 1024 * 1024;

  template <typename Token>
  auto async_handshake(boost::asio::const_buffer received, Token&& token) {
    return boost::asio::async_initiate<Token, Signature>(
        [this, received](auto handler) { handshake(received, shared(std::move(handler))); }, token);
  }

  template <typename Token>
  auto async_linger(Token&& token) {
    return boost::asio::async_initiate<Token, Signature>(
        [this](auto handler) { linger(boost::beast::role_type::server, shared(std::move(handler))); }, token);
  }

  template <typename Buffers, typename Token>
  auto async_read_some(const Buffers& buffers, Token&& token) {
    return boost::asio::async_initiate<Token, Signature>(
        [this](auto handler, const Buffers& into) {
          read(firstOf<boost::container::static_vector<boost::asio::mutable_buffer, 1>>(into)[0],
               shared(std::move(handler)));
        },
        token, buffers);
  }

  template <typename Buffers, typename Token>
  auto async_write_some(const Buffers& buffers, Token&& token) {
    return boost::asio::async_initiate<Token, Signature>(
        [this](auto handler, const Buffers& from) {
          const auto parts = firstOf<Parts>(from);
          write({parts.data(), parts.size()}, shared(std::move(handler)));
        },
        token, buffers);
  }

  /// Wraps a handler that can only be moved into one that can be copied. It keeps the state, because Beast may drop a
  /// stream whose operations have not ended.
  template <typename Handling>
  Handler shared(Handling handler) {
    struct Kept {
      std::shared_ptr<State> state;
      Handling handler;
    };
    return [kept = std::make_shared<Kept>(Kept{state_, std::move(handler)})](
               const boost::system::error_code& error, std::size_t bytes_count) { kept->handler(error, bytes_count); };
  }

 private:
  struct Tls;
  using Signature = void(boost::system::error_code, std::size_t);

  struct State {
    template <typename Socket>
    explicit State(Socket&& socket_or_executor) : tcp(std::forward<Socket>(socket_or_executor)) {}
    boost::beast::tcp_stream tcp;
    std::shared_ptr<Tls> tls;  ///< null without TLS; destroyed before `tcp`, which it uses
  };

  /// The first buffers that are not empty, as many as fit; one empty buffer if all are empty.
  template <typename Vector, typename Buffers>
  static Vector firstOf(const Buffers& buffers) {
    Vector out;
    for (auto at = boost::asio::buffer_sequence_begin(buffers);
         at != boost::asio::buffer_sequence_end(buffers) && out.size() < out.capacity(); ++at) {
      const typename Vector::value_type part = *at;
      if (part.size() > 0) out.push_back(part);
    }
    if (out.empty()) out.emplace_back();
    return out;
  }

  std::shared_ptr<State> state_;
};

/// Beast closes a stream after a timeout with this function, found by its type.
inline void beast_close_socket(Transport& stream) {
  stream.close();
}

/// Beast ends a connection with these functions after the close frames, found by the type of the stream. Its own
/// function for TCP closes the socket after one read.
template <std::derived_from<Transport> Stream, typename Handler>
void async_teardown(boost::beast::role_type role, Stream& stream, Handler&& handler) {
  stream.linger(role, stream.shared([kept = std::forward<Handler>(handler)](const boost::system::error_code& error,
                                                                            std::size_t) mutable { kept(error); }));
}
void teardown(boost::beast::role_type role, Transport& stream, boost::system::error_code& error);

}  // namespace spindrift::net
