#include "bare_send.h"

#include <chrono>
#include <ctime>
#include <vector>

#include <boost/beast/websocket.hpp>
#include <netinet/tcp.h>
#include <sys/socket.h>

namespace spindrift::bench {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using Clock = std::chrono::steady_clock;

/// As in server/net/connection.cpp.
constexpr int kSendBufferBytes = 512 * 1024;
constexpr int kUnsentLowWaterBytes = 128 * 1024;

void tune(tcp::socket& socket) {
  socket.set_option(tcp::no_delay(true));
  socket.set_option(asio::socket_base::send_buffer_size(kSendBufferBytes));
  (void)::setsockopt(socket.native_handle(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &kUnsentLowWaterBytes,
                     sizeof kUnsentLowWaterBytes);
}

/// RFC 6455 section 5.2: a whole binary message of at least 126 bytes.
core::Bytes framed(const core::Bytes& message) {
  const bool is_short = message.size() <= 0xffff;
  core::Bytes out{0x82, static_cast<std::uint8_t>(is_short ? 126 : 127)};
  for (int shift = is_short ? 8 : 56; shift >= 0; shift -= 8)
    out.push_back(static_cast<std::uint8_t>(std::uint64_t{message.size()} >> shift));
  out.insert(out.end(), message.begin(), message.end());
  return out;
}

}  // namespace

double threadCpu_s(pthread_t thread) {
  clockid_t clock{};
  timespec now{};
  if (pthread_getcpuclockid(thread, &clock) == 0) clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

BareSender::BareSender(std::size_t reader_count, double rate_hz, std::function<core::SharedBytes()> frame)
    : acceptor_(io_, {asio::ip::address_v4::loopback(), 0}),
      thread_([this, reader_count, rate_hz, frame = std::move(frame)] { run(reader_count, rate_hz, frame); }) {}

BareSender::~BareSender() {
  stopping_ = true;
  thread_.join();
}

double BareSender::cpu_s() {
  return threadCpu_s(thread_.native_handle());
}

void BareSender::run(std::size_t reader_count, double rate_hz, const std::function<core::SharedBytes()>& frame) {
  std::vector<boost::beast::websocket::stream<tcp::socket, false>> readers;
  for (std::size_t k = 0; k < reader_count; ++k) {
    auto& reader = readers.emplace_back(acceptor_.accept());
    reader.accept();
    tune(reader.next_layer());
  }
  const auto interval = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / rate_hz));
  for (auto next = Clock::now(); !stopping_; std::this_thread::sleep_until(next += interval)) {
    const core::Bytes bytes = framed(*frame());
    for (auto& reader : readers) {
      const int socket = reader.next_layer().native_handle();
      sent_frame_count_ += ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL) == std::ssize(bytes) ? 1 : 0;
    }
  }
}

}  // namespace spindrift::bench
