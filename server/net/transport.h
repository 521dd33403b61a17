// The stream below HTTP and WebSocket: TCP, or TLS over TCP. One class for both, so that connections and sessions have
// one code path. A plain stream costs one test of a pointer per operation; operations of TLS go through TlsLayer, with
// one allocation each.
#pragma once

#include <functional>
#include <memory>
#include <utility>

#include <boost/asio/async_result.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/websocket/teardown.hpp>
#include <boost/container/static_vector.hpp>

#include "tls_layer.h"

namespace spindrift::net {

/// Models AsyncStream of Beast. Used on its executor, a strand. Movable; a moved-from stream can only be destroyed.
class Transport {
 public:
  using executor_type = boost::beast::tcp_stream::executor_type;

  template <typename Socket>
  explicit Transport(Socket&& socket_or_executor) requires(!std::is_base_of_v<Transport, std::remove_cvref_t<Socket>>)
      : state_(std::make_shared<State>(std::forward<Socket>(socket_or_executor))) {}

  executor_type get_executor() { return state_->tcp.get_executor(); }
  boost::beast::tcp_stream& tcp() { return state_->tcp; }
  boost::asio::ip::tcp::socket& socket() { return state_->tcp.socket(); }
  /// Deadline of all operations from now on; the stream is closed when it passes.
  void expires_after(std::chrono::nanoseconds duration) { state_->tcp.expires_after(duration); }
  void expires_never() { state_->tcp.expires_never(); }
  /// Closes the socket at once.
  void close() { state_->tcp.close(); }

  [[nodiscard]] bool isTls() const { return state_->tls != nullptr; }
  /// From here on everything but tcp() goes through the layer; call handshake() next.
  void useTls(std::unique_ptr<TlsLayer> layer) { state_->tls = std::move(layer); }
  /// Null without TLS.
  [[nodiscard]] TlsLayer* tls() const { return state_->tls.get(); }

  /// TLS only. `received`: bytes that were read from tcp() before.
  template <typename Token>
  auto async_handshake(boost::asio::const_buffer received, Token&& token) {
    return boost::asio::async_initiate<Token, Signature>(
        [state = state_, received](auto handler) {
          state->tls->handshake(received, shared(state, std::move(handler)));
        },
        token);
  }

  /// TLS only: see TlsLayer::shutdown().
  template <typename Token>
  auto async_shutdown(Token&& token) {
    return boost::asio::async_initiate<Token, Signature>(
        [state = state_](auto handler) { state->tls->shutdown(shared(state, std::move(handler))); }, token);
  }

  template <typename Buffers, typename Token>
  auto async_read_some(const Buffers& buffers, Token&& token) {
    return boost::asio::async_initiate<Token, Signature>(
        [](auto handler, const std::shared_ptr<State>& state, const Buffers& into) {
          if (!state->tls) return state->tcp.async_read_some(into, std::move(handler));
          state->tls->read(firstOf<boost::asio::mutable_buffer, 1>(into)[0], shared(state, std::move(handler)));
        },
        token, state_, buffers);
  }

  template <typename Buffers, typename Token>
  auto async_write_some(const Buffers& buffers, Token&& token) {
    return boost::asio::async_initiate<Token, Signature>(
        [](auto handler, const std::shared_ptr<State>& state, const Buffers& from) {
          if (!state->tls) return state->tcp.async_write_some(from, std::move(handler));
          const auto parts = firstOf<boost::asio::const_buffer, kTlsPartMaxCount>(from);
          state->tls->write({parts.data(), parts.size()}, shared(state, std::move(handler)));
        },
        token, state_, buffers);
  }

 private:
  using Signature = void(boost::system::error_code, std::size_t);

  struct State {
    template <typename Socket>
    explicit State(Socket&& socket_or_executor) : tcp(std::forward<Socket>(socket_or_executor)) {}
    boost::beast::tcp_stream tcp;
    std::unique_ptr<TlsLayer> tls;  ///< destroyed before `tcp`, which it uses
  };

  /// Wraps a handler that can only be moved into one that can be copied. It keeps the state, because Beast may drop a
  /// stream whose operations have not ended.
  template <typename Handler>
  static TlsLayer::Handler shared(std::shared_ptr<State> state, Handler handler) {
    return [state = std::move(state), kept = std::make_shared<Handler>(std::move(handler))](
               const boost::system::error_code& error, std::size_t bytes_count) { (*kept)(error, bytes_count); };
  }

  static constexpr std::size_t kTlsPartMaxCount = 16;

  /// The first buffers that are not empty, at most `kMaxCount`; one empty buffer if there are none.
  template <typename Buffer, std::size_t kMaxCount, typename Buffers>
  static boost::container::static_vector<Buffer, kMaxCount> firstOf(const Buffers& buffers) {
    boost::container::static_vector<Buffer, kMaxCount> out;
    for (auto at = boost::asio::buffer_sequence_begin(buffers);
         at != boost::asio::buffer_sequence_end(buffers) && out.size() < kMaxCount; ++at) {
      const Buffer part = *at;
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

/// Beast ends a connection with these functions after the close frames, found by the type of the stream.
template <typename Handler>
void async_teardown(boost::beast::role_type role, Transport& stream, Handler&& handler) {
  if (!stream.isTls()) {
    return boost::beast::websocket::async_teardown(role, stream.socket(), std::forward<Handler>(handler));
  }
  stream.async_shutdown([kept = std::forward<Handler>(handler)](const boost::system::error_code& error,
                                                                std::size_t) mutable { kept(error); });
}
inline void teardown(boost::beast::role_type role, Transport& stream, boost::system::error_code& error) {
  boost::beast::websocket::teardown(role, stream.socket(), error);
}

}  // namespace spindrift::net
