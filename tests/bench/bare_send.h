// The least that a broadcast can cost: one thread that hands the same frame to the kernel once per reader.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <thread>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <pthread.h>

#include <spindrift/core/bytes.h>

namespace spindrift::bench {

/// Answers the handshakes of `reader_count` WebSocket clients, one after the other, then sends each frame to all of
/// them, with blocking calls on sockets with the server's options. Nothing is read.
class BareSender {
 public:
  /// `frame` makes the next frame, of at least 126 bytes.
  BareSender(std::size_t reader_count, double rate_hz, std::function<core::SharedBytes()> frame);
  BareSender(const BareSender&) = delete;
  BareSender& operator=(const BareSender&) = delete;
  /// Ends it; the clients must have connected.
  ~BareSender();

  [[nodiscard]] std::uint16_t port() const { return acceptor_.local_endpoint().port(); }
  /// Time of the thread, with that of making the frames.
  [[nodiscard]] double cpu_s();
  [[nodiscard]] std::uint64_t sentFrameCount() const { return sent_frame_count_; }

 private:
  void run(std::size_t reader_count, double rate_hz, const std::function<core::SharedBytes()>& frame);

  boost::asio::io_context io_;
  boost::asio::ip::tcp::acceptor acceptor_;
  std::atomic<bool> stopping_{false};
  std::atomic<std::uint64_t> sent_frame_count_{0};
  std::thread thread_;
};

/// CPU time of a thread of this process that runs.
double threadCpu_s(pthread_t thread);

}  // namespace spindrift::bench
