#include <utility>

#include <nats/nats.h>

#include <spindrift/bus/key_values.h>

namespace spindrift::bus {
namespace {

constexpr std::int64_t kTimeout_ms = 2'000;

core::Error failure(const std::string& what, natsStatus status) {
  const char* detail = nats_GetLastError(nullptr);
  return {core::ErrorCode::kUnavailable, "NATS: " + what + " failed (" + natsStatus_GetText(status) +
                                             (detail && *detail ? std::string(": ") + detail : std::string()) + ")"};
}

class NatsKeyValues final : public KeyValues {
 public:
  NatsKeyValues(jsCtx* context, kvStore* store) : context_(context), store_(store) {}
  NatsKeyValues(const NatsKeyValues&) = delete;
  NatsKeyValues& operator=(const NatsKeyValues&) = delete;
  ~NatsKeyValues() override {
    kvStore_Destroy(store_);
    jsCtx_Destroy(context_);
  }

  core::Result<std::map<std::string, KeyValue>> all() override {
    std::map<std::string, KeyValue> out;
    kvKeysList keys{};
    const natsStatus listed = kvStore_Keys(&keys, store_, nullptr);
    if (listed == NATS_NOT_FOUND) return out;  // there is no key
    if (listed != NATS_OK) return failure("listing keys", listed);
    natsStatus status = NATS_OK;
    for (int k = 0; k < keys.Count && status == NATS_OK; ++k) {
      kvEntry* entry = nullptr;
      status = kvStore_Get(&entry, store_, keys.Keys[k]);
      if (status == NATS_NOT_FOUND) {  // removed meanwhile
        status = NATS_OK;
        continue;
      }
      if (status != NATS_OK) break;
      const auto* bytes = static_cast<const std::uint8_t*>(kvEntry_Value(entry));
      out[keys.Keys[k]] = {core::Bytes(bytes, bytes + kvEntry_ValueLen(entry)), kvEntry_Revision(entry)};
      kvEntry_Destroy(entry);
    }
    kvKeysList_Destroy(&keys);
    if (status != NATS_OK) return failure("reading a key", status);
    return out;
  }

  core::Result<std::optional<std::uint64_t>> set(const std::string& key, core::ByteView value,
                                                 std::uint64_t revision) override {
    std::uint64_t made = 0;
    const int size = static_cast<int>(value.size());
    const natsStatus status = revision == 0 ? kvStore_Create(&made, store_, key.c_str(), value.data(), size)
                                            : kvStore_Update(&made, store_, key.c_str(), value.data(), size, revision);
    if (status == NATS_OK) return std::optional(made);
    // The client reports a wrong revision as a general error of JetStream.
    if (status == NATS_ERR || status == NATS_MISMATCH) return std::optional<std::uint64_t>();
    return failure("setting '" + key + "'", status);
  }

  core::Result<void> remove(const std::string& key) override {
    const natsStatus status = kvStore_Delete(store_, key.c_str());
    if (status != NATS_OK && status != NATS_NOT_FOUND) return failure("removing '" + key + "'", status);
    return {};
  }

 private:
  jsCtx* context_;
  kvStore* store_;
};

}  // namespace

core::Result<std::unique_ptr<KeyValues>> KeyValues::open(Bus& bus, const std::string& bucket) {
  jsOptions options;
  jsOptions_Init(&options);
  options.Wait = kTimeout_ms;
  jsCtx* context = nullptr;
  natsStatus status = natsConnection_JetStream(&context, static_cast<natsConnection*>(bus.connection()), &options);
  if (status != NATS_OK) return failure("JetStream", status);
  kvStore* store = nullptr;
  status = js_KeyValue(&store, context, bucket.c_str());
  if (status == NATS_NOT_FOUND) {
    kvConfig config;
    kvConfig_Init(&config);
    config.Bucket = bucket.c_str();
    config.History = 1;
    status = js_CreateKeyValue(&store, context, &config);
  }
  if (status != NATS_OK) {
    jsCtx_Destroy(context);
    core::Error error = failure("opening the bucket '" + bucket + "'", status);
    error.message += "; the NATS server needs JetStream: nats-server -js";
    return error;
  }
  return std::unique_ptr<KeyValues>(std::make_unique<NatsKeyValues>(context, store));
}

}  // namespace spindrift::bus
