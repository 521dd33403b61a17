#include <chrono>
#include <optional>
#include <utility>

#include <nats/nats.h>
#include <spdlog/spdlog.h>

#include <spindrift/bus/key_values.h>

#include "key_copy.h"

namespace spindrift::bus {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::int64_t kTimeout_ms = 2'000;
/// A watch can end without a word: its consumer lives in the memory of the NATS server, and one that is set up again
/// after the bucket was made anew waits for revisions that the new one has not. So the bucket's newest revision is
/// compared with that of the copy, which costs NATS one small request whatever the number of keys.
constexpr std::chrono::seconds kCheckInterval{2};
/// A watch that has not told a change so long after the bucket had it is made anew.
constexpr std::chrono::milliseconds kLagMax{500};

core::Error failure(const std::string& what, natsStatus status) {
  const char* detail = nats_GetLastError(nullptr);
  return {core::ErrorCode::kUnavailable, "NATS: " + what + " failed (" + natsStatus_GetText(status) +
                                             (detail && *detail ? std::string(": ") + detail : std::string()) + ")"};
}

class NatsKeyValues final : public KeyValues {
 public:
  NatsKeyValues(Bus& bus, std::string bucket) : bus_(bus), bucket_(std::move(bucket)) {}
  NatsKeyValues(const NatsKeyValues&) = delete;
  NatsKeyValues& operator=(const NatsKeyValues&) = delete;
  ~NatsKeyValues() override {
    endWatch();
    kvStore_Destroy(store_);
    jsCtx_Destroy(context_);
  }

  core::Result<void> open();

  core::Result<KeyValueMap> copy() override {
    if (Clock::now() >= next_check_) return all();
    if (auto ready = makeReady(); !ready) return ready.error();
    if (auto taken = take(0); !taken) return taken.error();
    return copy_.values();
  }
  core::Result<KeyValueMap> all() override {
    if (auto ready = makeReady(); !ready) return ready.error();
    if (auto checked = check(); !checked) return checked.error();
    next_check_ = Clock::now() + kCheckInterval;
    return copy_.values();
  }

  core::Result<std::uint64_t> set(const std::string& key, core::ByteView value, std::uint64_t revision) override {
    if (auto ready = makeReady(); !ready) return ready.error();
    std::uint64_t made = 0;
    const int size = static_cast<int>(value.size());
    const natsStatus status = revision == 0 ? kvStore_Create(&made, store_, key.c_str(), value.data(), size)
                                            : kvStore_Update(&made, store_, key.c_str(), value.data(), size, revision);
    if (status == NATS_OK) {
      keep(key, copy_.wrote(key, value, made));
      return made;
    }
    next_check_ = {};  // what the copy says may be old
    // The client reports a wrong revision as a general error of JetStream.
    if (status == NATS_ERR || status == NATS_MISMATCH) return std::uint64_t{0};
    return failure("setting '" + key + "'", status);
  }

  core::Result<void> remove(const std::string& key) override {
    if (auto ready = makeReady(); !ready) return ready;
    const natsStatus status = kvStore_Delete(store_, key.c_str());
    if (status != NATS_OK && status != NATS_NOT_FOUND) return failure("removing '" + key + "'", status);
    return {};
  }

 private:
  /// Watches the bucket, anew after a reconnection: the watch of before may be gone, and the bucket another one.
  core::Result<void> makeReady();
  /// Opens the bucket, makes it if it does not exist, and takes all its values.
  core::Result<void> watch();
  /// Compares the copy with the bucket and takes what is missing.
  core::Result<void> check();
  /// Takes the changes that have come, and waits for them up to this revision.
  core::Result<void> take(std::uint64_t up_to);
  /// One change, or the end of the first values.
  void take(kvEntry& entry);
  struct State {
    std::uint64_t revision = 0;  ///< of the newest change
    std::int64_t made_ns = 0;    ///< when the bucket was made, by the clock of NATS
  };
  /// One round trip; nullopt: there is no such bucket.
  core::Result<std::optional<State>> state();
  void keep(const std::string& key, bool is_kept) {
    if (is_kept || std::exchange(said_limit_, true)) return;
    spdlog::error(
        "the key '{}' of the bucket '{}' on NATS is left out, like others after it: this process takes {} keys with "
        "values of at most {} bytes; remove what does not belong there",
        key, bucket_, KeyCopy::kKeyMaxCount, KeyCopy::kValueMaxBytes);
  }
  core::Error fail(const std::string& what, natsStatus status) {
    endWatch();
    return failure(what + " the bucket '" + bucket_ + "'", status);
  }
  void endWatch() {
    if (watcher_) kvWatcher_Destroy(std::exchange(watcher_, nullptr));
  }

  Bus& bus_;
  const std::string bucket_;
  jsCtx* context_ = nullptr;
  kvStore* store_ = nullptr;
  kvWatcher* watcher_ = nullptr;  ///< null: the copy is not valid
  std::uint64_t watched_reconnect_count_ = 0;
  std::int64_t made_ns_ = 0;  ///< of the watched bucket
  KeyCopy copy_;
  Clock::time_point next_check_{};
  bool said_limit_ = false;
};

core::Result<void> NatsKeyValues::open() {
  jsOptions options;
  jsOptions_Init(&options);
  options.Wait = kTimeout_ms;
  const natsStatus status =
      natsConnection_JetStream(&context_, static_cast<natsConnection*>(bus_.connection()), &options);
  if (status != NATS_OK) return failure("JetStream", status);
  return makeReady();
}

core::Result<void> NatsKeyValues::makeReady() {
  if (!bus_.isConnected()) {
    return core::unavailable("NATS: the bucket '" + bucket_ + "' cannot be read: there is no connection");
  }
  const std::uint64_t reconnect_count = bus_.stats().reconnect_count;
  if (watcher_ && reconnect_count == watched_reconnect_count_) return {};
  watched_reconnect_count_ = reconnect_count;
  return watch();
}

core::Result<void> NatsKeyValues::watch() {
  endWatch();
  copy_ = {};
  kvStore_Destroy(std::exchange(store_, nullptr));
  natsStatus status = js_KeyValue(&store_, context_, bucket_.c_str());
  if (status == NATS_NOT_FOUND) {
    kvConfig config;
    kvConfig_Init(&config);
    config.Bucket = bucket_.c_str();
    config.History = 1;
    status = js_CreateKeyValue(&store_, context_, &config);
  }
  if (status != NATS_OK) {
    core::Error error = fail("opening", status);
    error.message += "; the NATS server needs JetStream: nats-server -js";
    return error;
  }
  const auto before = state();
  if (!before) return before.error();
  if (!*before) return fail("reading", NATS_NOT_FOUND);
  made_ns_ = (*before)->made_ns;
  status = kvStore_WatchAll(&watcher_, store_, nullptr);
  for (const auto until = Clock::now() + std::chrono::milliseconds(kTimeout_ms); status == NATS_OK;) {
    if (Clock::now() >= until) return fail("reading", NATS_TIMEOUT);
    kvEntry* entry = nullptr;
    status = kvWatcher_Next(&entry, watcher_, kTimeout_ms);
    if (status != NATS_OK) break;
    if (!entry) {  // these were all
      copy_.complete((*before)->revision);
      return {};
    }
    take(*entry);
    kvEntry_Destroy(entry);
  }
  return fail("reading", status);
}

core::Result<std::optional<NatsKeyValues::State>> NatsKeyValues::state() {
  jsStreamInfo* info = nullptr;
  const natsStatus status = js_GetStreamInfo(&info, context_, ("KV_" + bucket_).c_str(), nullptr, nullptr);
  if (status == NATS_NOT_FOUND) return std::optional<State>();
  if (status != NATS_OK) return fail("asking for the state of", status);
  const State out{.revision = info->State.LastSeq, .made_ns = info->Created};
  jsStreamInfo_Destroy(info);
  return std::optional(out);
}

core::Result<void> NatsKeyValues::check() {
  const auto now = state();
  if (!now) return now.error();
  if (!*now || (*now)->made_ns != made_ns_ || (*now)->revision < copy_.revision()) {
    spdlog::warn("the bucket '{}' that was watched on NATS is gone: watching the present one", bucket_);
    return watch();
  }
  if (auto taken = take((*now)->revision); !taken) return taken;
  if (copy_.revision() >= (*now)->revision) return {};
  spdlog::warn("the watch of the bucket '{}' on NATS ended at revision {}, the bucket is at {}: watching it again",
               bucket_, copy_.revision(), (*now)->revision);
  return watch();
}

core::Result<void> NatsKeyValues::take(std::uint64_t up_to) {
  const auto until = Clock::now() + kLagMax;
  while (true) {
    const bool waits = copy_.revision() < up_to && Clock::now() < until;
    kvEntry* entry = nullptr;
    const natsStatus status = kvWatcher_Next(&entry, watcher_, waits ? kLagMax.count() : 1);
    if (status == NATS_TIMEOUT) return {};
    if (status != NATS_OK) return fail("watching", status);
    if (!entry) continue;
    take(*entry);
    kvEntry_Destroy(entry);
  }
}

void NatsKeyValues::take(kvEntry& entry) {
  const std::string key = kvEntry_Key(&entry);
  const std::uint64_t revision = kvEntry_Revision(&entry);
  if (kvEntry_Operation(&entry) != kvOp_Put) return copy_.remove(key, revision);
  const auto* bytes = static_cast<const std::uint8_t*>(kvEntry_Value(&entry));
  keep(key, copy_.put(key, {bytes, static_cast<std::size_t>(kvEntry_ValueLen(&entry))}, revision));
}

}  // namespace

core::Result<std::unique_ptr<KeyValues>> KeyValues::open(Bus& bus, const std::string& bucket) {
  auto out = std::make_unique<NatsKeyValues>(bus, bucket);
  if (auto opened = out->open(); !opened) return opened.error();
  return std::unique_ptr<KeyValues>(std::move(out));
}

}  // namespace spindrift::bus
