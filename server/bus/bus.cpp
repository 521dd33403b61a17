#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <random>
#include <thread>
#include <utility>
#include <vector>

#include <boost/algorithm/string/join.hpp>
#include <boost/algorithm/string/split.hpp>
#include <nats/nats.h>
#include <spdlog/spdlog.h>

#include <spindrift/bus/bus.h>
#include <spindrift/core/files.h>

#include "parts.h"

namespace spindrift::bus {
namespace {

constexpr std::int64_t kConnectTimeout_ms = 2'000;
constexpr std::int64_t kReconnectWait_ms = 100;
constexpr std::int64_t kReconnectJitter_ms = 100;
/// Two pings unanswered: the connection is dead. Clients wait for frames meanwhile, so it is short.
constexpr std::int64_t kPingInterval_ms = 1'000;
constexpr int kPingsOutMaxCount = 2;
/// What waits during a reconnection. Messages are dropped then, except those that are on their way into the buffer.
constexpr int kReconnectBufferBytes = 1 << 20;
constexpr std::int64_t kWriteDeadline_ms = 2'000;
/// What may wait for the socket; a second of frames for a few rooms.
constexpr std::size_t kWaitingMaxBytes = 32u << 20;

std::vector<std::string> urlsOf(const std::string& list) {
  std::vector<std::string> out;
  return boost::algorithm::split(out, list, [](char c) { return c == ','; });
}

class NatsBus;

class NatsSubscription final : public Subscription {
 public:
  NatsSubscription(NatsBus& bus, Bus::Handler handler)
      : bus_(bus), handler_(std::make_shared<const Bus::Handler>(std::move(handler))) {}
  NatsSubscription(const NatsSubscription&) = delete;
  NatsSubscription& operator=(const NatsSubscription&) = delete;
  ~NatsSubscription() override;

  bool start(natsConnection* connection, const std::string& subject, std::size_t waiting_max_bytes);

 private:
  /// Outlives the subscription until NATS has made its last call.
  struct Shared {
    std::recursive_mutex mutex;  ///< a handler may end its own subscription
    NatsSubscription* self = nullptr;
  };
  static void arrived(natsConnection*, natsSubscription*, natsMsg* message, void* shared);
  static void ended(void* shared);
  void handle(core::ByteView part);

  NatsBus& bus_;
  const std::shared_ptr<const Bus::Handler> handler_;
  PartCollector parts_;
  std::shared_ptr<Shared> shared_ = std::make_shared<Shared>();
  natsSubscription* subscription_ = nullptr;
};

class NatsBus final : public Bus {
 public:
  NatsBus() = default;
  NatsBus(const NatsBus&) = delete;
  NatsBus& operator=(const NatsBus&) = delete;
  ~NatsBus() override {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    wake_.notify_all();
    if (sender_.joinable()) sender_.join();
    if (!connection_) return;
    natsConnection_Close(connection_);
    // NATS makes its last calls from a thread of its own; closed() is the very last.
    std::unique_lock lock(mutex_);
    wake_.wait(lock, [this] { return closed_; });
    lock.unlock();
    natsConnection_Destroy(connection_);
  }

  core::Result<void> connect(const BusOptions& options);
  void publish(const std::string& subject, core::ByteView head, core::ByteView body) override;
  std::unique_ptr<Subscription> subscribe(const std::string& subject, std::size_t waiting_max_bytes,
                                          Handler handler) override {
    auto out = std::make_unique<NatsSubscription>(*this, std::move(handler));
    if (!out->start(connection_, subject, waiting_max_bytes)) return nullptr;
    return out;
  }
  [[nodiscard]] bool isConnected() const override {
    return natsConnection_Status(connection_) == NATS_CONN_STATUS_CONNECTED;
  }
  [[nodiscard]] BusStats stats() const override {
    return {.is_connected = isConnected(),
            .dropped_message_count = dropped_message_count,
            .reconnect_count = reconnect_count};
  }
  [[nodiscard]] void* connection() const override { return connection_; }

  std::atomic<std::uint64_t> dropped_message_count{0};
  std::atomic<std::uint64_t> reconnect_count{0};

 private:
  static void closed(natsConnection*, void* self) {
    auto* const bus = static_cast<NatsBus*>(self);
    const std::lock_guard lock(bus->mutex_);
    bus->closed_ = true;
    bus->wake_.notify_all();  // under the lock: the bus is destroyed as soon as it is free
  }
  static void disconnected(natsConnection*, void* self) {
    {
      const std::lock_guard lock(static_cast<NatsBus*>(self)->mutex_);
      if (static_cast<NatsBus*>(self)->stopping_) return;
    }
    spdlog::warn(
        "the connection to NATS ({}) broke; rooms continue, watchers behind edges see no frames until it is back",
        static_cast<NatsBus*>(self)->url_);
  }
  static void reconnected(natsConnection*, void* self) {
    ++static_cast<NatsBus*>(self)->reconnect_count;
    spdlog::info("connected to NATS again ({})", static_cast<NatsBus*>(self)->url_);
  }
  static void failed(natsConnection*, natsSubscription*, natsStatus status, void* self) {
    if (status == NATS_SLOW_CONSUMER)
      ++static_cast<NatsBus*>(self)->dropped_message_count;
    else
      spdlog::warn("NATS: {}", natsStatus_GetText(status));
  }

  /// Writing to a socket may block, callers must not: a thread does it.
  void send();

  struct Waiting {
    std::string subject;
    core::Bytes part;
  };

  std::string url_;  ///< without a password
  natsConnection* connection_ = nullptr;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Waiting> waiting_;
  std::size_t waiting_bytes_ = 0;
  bool stopping_ = false;
  bool closed_ = false;
  std::thread sender_;
  std::atomic<std::uint64_t> last_message_{std::uint64_t{std::random_device()()} << 32u};
};

core::Result<void> NatsBus::connect(const BusOptions& options) {
  url_ = withoutPassword(options.url);
  natsOptions* raw = nullptr;
  natsStatus status = natsOptions_Create(&raw);
  const std::unique_ptr<natsOptions, decltype(&natsOptions_Destroy)> settings(raw, natsOptions_Destroy);
  const std::vector<std::string> urls = urlsOf(options.url);
  std::vector<const char*> servers;
  for (const std::string& url : urls) servers.push_back(url.c_str());
  const auto set = [&](natsStatus outcome) {
    if (status == NATS_OK) status = outcome;
  };
  set(natsOptions_SetServers(raw, servers.data(), static_cast<int>(servers.size())));
  set(natsOptions_SetName(raw, options.name.c_str()));
  set(natsOptions_SetTimeout(raw, kConnectTimeout_ms));
  set(natsOptions_SetMaxReconnect(raw, -1));
  set(natsOptions_SetReconnectWait(raw, kReconnectWait_ms));
  set(natsOptions_SetReconnectJitter(raw, kReconnectJitter_ms, kReconnectJitter_ms));
  set(natsOptions_SetReconnectBufSize(raw, kReconnectBufferBytes));
  set(natsOptions_SetPingInterval(raw, kPingInterval_ms));
  set(natsOptions_SetMaxPingsOut(raw, kPingsOutMaxCount));
  set(natsOptions_SetWriteDeadline(raw, kWriteDeadline_ms));
  set(natsOptions_SetSendAsap(raw, true));
  set(natsOptions_UseGlobalMessageDelivery(raw, true));  // one thread: handlers run in the order of arrival
  set(natsOptions_SetNoEcho(raw, true));
  set(natsOptions_SetDisconnectedCB(raw, &NatsBus::disconnected, this));
  set(natsOptions_SetReconnectedCB(raw, &NatsBus::reconnected, this));
  set(natsOptions_SetClosedCB(raw, &NatsBus::closed, this));
  set(natsOptions_SetErrorHandler(raw, &NatsBus::failed, this));
  // Without this the client would speak plain text to a server that offers no TLS, or to whoever stands in its place.
  const bool is_secure = std::ranges::any_of(urls, [](const std::string& url) { return url.starts_with("tls://"); });
  if (is_secure || !options.ca_file.empty()) set(natsOptions_SetSecure(raw, true));
  if (!options.ca_file.empty()) {
    constexpr std::size_t kPemMaxBytes = 4u << 20;
    const auto authorities = core::readText(options.ca_file, kPemMaxBytes, "a PEM file", "is it the right file?");
    if (!authorities)
      return core::Error{authorities.error().code, "--nats-ca " + options.ca_file + ": " + authorities.error().message};
    set(natsOptions_SetCATrustedCertificates(raw, authorities->c_str()));
  }
  if (status == NATS_OK) status = natsConnection_Connect(&connection_, raw);
  if (status == NATS_OK) {
    sender_ = std::thread([this] { send(); });
    return {};
  }
  const char* detail = nats_GetLastError(nullptr);
  return core::unavailable("no connection to NATS at " + url_ + " (" + natsStatus_GetText(status) +
                           (detail && *detail ? std::string(": ") + detail : std::string()) +
                           "): start nats-server there, or give another URL");
}

void NatsBus::publish(const std::string& subject, core::ByteView head, core::ByteView body) {
  const std::size_t size = head.size() + body.size();
  const std::size_t part_count = std::max<std::size_t>(1, (size + kPartMaxBytes - 1) / kPartMaxBytes);
  if (!isConnected() || part_count > kPartMaxCount) {
    ++dropped_message_count;
    return;
  }
  const std::uint64_t number = ++last_message_;
  std::vector<Waiting> parts(part_count);
  for (std::size_t k = 0; k < part_count; ++k) {
    const std::size_t begin = k * kPartMaxBytes;
    const std::size_t end = std::min(size, begin + kPartMaxBytes);
    core::Bytes& part = parts[k].part;
    part.reserve(kPartHeadBytes + end - begin);
    part.resize(kPartHeadBytes);
    writePartHead({number, static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(part_count)}, part.data());
    const auto append = [&](core::ByteView bytes, std::size_t offset) {  // those of `bytes` that belong to this part
      const std::size_t first = std::clamp(begin, offset, offset + bytes.size());
      const std::size_t last = std::clamp(end, offset, offset + bytes.size());
      const core::ByteView piece = bytes.subspan(first - offset, last - first);
      part.insert(part.end(), piece.begin(), piece.end());
    };
    append(head, 0);
    append(body, head.size());
    parts[k].subject = subject;
  }
  {
    const std::lock_guard lock(mutex_);
    if (waiting_bytes_ + size > kWaitingMaxBytes) {
      ++dropped_message_count;
      return;
    }
    for (Waiting& part : parts) {
      waiting_bytes_ += part.part.size();
      waiting_.push_back(std::move(part));
    }
  }
  wake_.notify_one();
}

void NatsBus::send() {
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [&] { return stopping_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    const Waiting next = std::move(waiting_.front());
    waiting_.pop_front();
    waiting_bytes_ -= next.part.size();
    lock.unlock();
    const natsStatus status =
        natsConnection_Publish(connection_, next.subject.c_str(), next.part.data(), static_cast<int>(next.part.size()));
    if (status != NATS_OK) ++dropped_message_count;
    lock.lock();
  }
}

bool NatsSubscription::start(natsConnection* connection, const std::string& subject, std::size_t waiting_max_bytes) {
  shared_->self = this;
  // NATS keeps one reference until ended().
  auto kept = std::make_unique<std::shared_ptr<Shared>>(shared_);
  if (natsConnection_Subscribe(&subscription_, connection, subject.c_str(), &NatsSubscription::arrived, kept.get()) !=
      NATS_OK) {
    return false;
  }
  natsSubscription_SetPendingLimits(subscription_, -1, static_cast<int>(waiting_max_bytes));
  natsSubscription_SetOnCompleteCB(subscription_, &NatsSubscription::ended, kept.get());
  // Fails only if the subscription has ended already; then a few bytes stay until the end of the process.
  (void)kept.release();
  return true;
}

NatsSubscription::~NatsSubscription() {
  {
    const std::lock_guard lock(shared_->mutex);
    shared_->self = nullptr;
  }
  if (!subscription_) return;
  natsSubscription_Unsubscribe(subscription_);
  natsSubscription_Destroy(subscription_);
}

void NatsSubscription::arrived(natsConnection*, natsSubscription*, natsMsg* message, void* closure) {
  const std::unique_ptr<natsMsg, decltype(&natsMsg_Destroy)> owned(message, natsMsg_Destroy);
  const std::shared_ptr<Shared> shared = *static_cast<std::shared_ptr<Shared>*>(closure);
  const std::lock_guard lock(shared->mutex);
  if (!shared->self) return;
  shared->self->handle({reinterpret_cast<const std::uint8_t*>(natsMsg_GetData(message)),
                        static_cast<std::size_t>(natsMsg_GetDataLength(message))});
}

void NatsSubscription::ended(void* closure) {
  delete static_cast<std::shared_ptr<Shared>*>(closure);
}

void NatsSubscription::handle(core::ByteView part) {
  std::uint64_t lost = 0;
  const auto message = parts_.take(part, lost);
  bus_.dropped_message_count += lost;
  if (!message) return;
  const auto handler = handler_;  // it may end this subscription
  try {
    (*handler)(*message);
  } catch (const std::exception& error) {  // NATS is written in C
    spdlog::error("a message from the bus could not be handled: {}", error.what());
  }
}

}  // namespace

core::Result<std::unique_ptr<Bus>> Bus::connect(const BusOptions& options) {
  auto bus = std::make_unique<NatsBus>();
  if (auto connected = bus->connect(options); !connected) return connected.error();
  return std::unique_ptr<Bus>(std::move(bus));
}

std::string withoutPassword(const std::string& url) {
  std::vector<std::string> urls = urlsOf(url);
  for (std::string& one : urls) {
    const std::size_t scheme = one.find("://");
    const std::size_t host = scheme == std::string::npos ? 0 : scheme + 3;
    const std::size_t at = one.rfind('@');
    if (at != std::string::npos && at >= host) one.erase(host, at + 1 - host);
  }
  return boost::algorithm::join(urls, ",");
}

}  // namespace spindrift::bus
