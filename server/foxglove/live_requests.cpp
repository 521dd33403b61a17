#include <boost/json.hpp>

#include <spindrift/codec/stream.h>
#include <spindrift/core/text.h>
#include <spindrift/wire/client_message.h>

#include "live_state.h"
#include "services.h"

namespace spindrift::foxglove::live {
namespace {

namespace json = boost::json;

constexpr std::size_t kQuotedMaxBytes = 64;

std::optional<std::uint32_t> idIn(const json::object& object, std::string_view name) {
  const json::value* const value = object.if_contains(name);
  if (!value || !value->is_number()) return std::nullopt;
  boost::system::error_code error;
  const auto id = value->to_number<std::uint32_t>(error);
  return error ? std::nullopt : std::optional(id);
}

std::optional<std::string> textIn(const json::object& object, std::string_view name) {
  const json::value* const value = object.if_contains(name);
  if (!value || !value->is_string()) return std::nullopt;
  return std::string(value->get_string());
}

/// Returns the array of this name, or an empty one.
const json::array& listIn(const json::object& object, std::string_view name) {
  static const json::array none;
  const json::value* const value = object.if_contains(name);
  return value && value->is_array() ? value->get_array() : none;
}

std::string quoted(std::string_view text) {
  return "'" + core::cleanText(text, kQuotedMaxBytes) + "'";
}

}  // namespace

core::Translator::Incoming LiveSession::open() {
  v1::ClientMessage message;
  v1::Hello& hello = *message.mutable_hello();
  hello.mutable_version()->set_major(wire::kWireMajor);
  hello.mutable_version()->set_minor(wire::kWireMinor);
  hello.set_client("Foxglove");
  hello.set_name("Foxglove");
  hello.set_token(token_);
  say(message);
  return std::exchange(turn_, {});
}

core::Translator::Incoming LiveSession::receive(core::ByteView message, bool is_text) {
  if (is_text)
    readText(message);
  else
    readBinary(message);
  if (fault_count_ > 1) fault_ += " (and " + std::to_string(fault_count_ - 1) + " more)";
  if (fault_count_ > 0) answer(status(StatusLevel::kError, fault_));
  fault_.clear();
  fault_count_ = 0;
  return std::exchange(turn_, {});
}

void LiveSession::answer(const Outgoing& message) {
  core::Bytes kept{kOwnMessage, static_cast<std::uint8_t>(message.is_text)};
  kept.insert(kept.end(), message.bytes->begin(), message.bytes->end());
  turn_.answers.push_back(core::share(std::move(kept)));
}

void LiveSession::fault(std::string why) {
  if (fault_count_++ == 0) fault_ = std::move(why);
}

void LiveSession::say(const v1::ClientMessage& message) {
  const std::string bytes = message.SerializeAsString();
  turn_.messages.emplace_back(bytes.begin(), bytes.end());
}

void LiveSession::readText(core::ByteView message) {
  boost::system::error_code error;
  json::parse_options options;
  options.max_depth = kJsonMaxDepth;
  const json::value parsed =
      json::parse(json::string_view(reinterpret_cast<const char*>(message.data()), message.size()), error, {}, options);
  if (error || !parsed.is_object())
    return fault("a text message has to be a JSON object" + (error ? ": " + error.message() : std::string()));
  const json::object& object = parsed.get_object();
  const std::string op = textIn(object, "op").value_or("");
  if (op == "subscribe") return subscribe(object);
  if (op == "unsubscribe") return unsubscribe(object);
  if (op == "getParameters") return getParameters(object);
  if (op == "setParameters") return setParameters(object);
  if (op == "subscribeParameterUpdates") return watchParameters(object, true);
  if (op == "unsubscribeParameterUpdates") return watchParameters(object, false);
  fault("op " + quoted(op) + " is not supported: the capabilities in serverInfo are");
}

void LiveSession::readBinary(core::ByteView message) {
  constexpr std::uint8_t kServiceCall = 2;
  constexpr std::size_t kHeadBytes = 1 + 3 * sizeof(std::uint32_t);
  if (message.empty() || message.front() != kServiceCall) {
    return fault("binary message with the opcode " + (message.empty() ? "(none)" : std::to_string(message.front())) +
                 ": only 2, a call of a service, is supported");
  }
  if (message.size() < kHeadBytes) return fault("a call of a service has at least 13 bytes");
  const auto number = [&](std::size_t at) {
    return static_cast<std::uint32_t>(message[at]) | static_cast<std::uint32_t>(message[at + 1]) << 8 |
           static_cast<std::uint32_t>(message[at + 2]) << 16 | static_cast<std::uint32_t>(message[at + 3]) << 24;
  };
  const Call wanted{number(1), number(5)};
  const std::size_t encoding_bytes = number(9);
  if (encoding_bytes > message.size() - kHeadBytes)
    return fault("a call of a service ends within the name of its encoding");
  const std::string_view rest(reinterpret_cast<const char*>(message.data()) + kHeadBytes, message.size() - kHeadBytes);
  call(wanted, rest.substr(0, encoding_bytes), rest.substr(encoding_bytes));
}

void LiveSession::watch(v1::Layer layer) {
  v1::ClientMessage message;
  v1::Subscribe& wanted = *message.mutable_subscribe();
  wanted.set_layer(layer);
  wanted.set_max_rate_hz((subscribed() & topicsOf(layer)).any() ? kLiveRate_hz : 0.0);
  wanted.set_level(codec::hasLevels(layer) ? codec::toWire(kLiveLevel) : v1::LEVEL_FULL);
  wanted.set_adapts(codec::hasLevels(layer));
  say(message);
}

void LiveSession::subscribe(const json::object& message) {
  const TopicSet before = subscribed();
  for (const json::value& entry : listIn(message, "subscriptions")) {
    const json::object* const object = entry.if_object();
    const auto id = object ? idIn(*object, "id") : std::nullopt;
    const auto channel = object ? idIn(*object, "channelId") : std::nullopt;
    if (!id || !channel) {
      fault("a subscription needs an id and a channelId, whole numbers from 0 to 4294967295");
    } else if (*channel == 0 || *channel > kTopicCount || !offered_[*channel - 1]) {
      fault("there is no channel " + std::to_string(*channel));
    } else if (subscriptions_.contains(*id)) {
      fault("the id " + std::to_string(*id) + " belongs to another subscription: unsubscribe it first");
    } else if (subscribed()[*channel - 1]) {
      fault("channel " + std::to_string(*channel) + " is subscribed already, once is enough");
    } else {
      subscriptions_[*id] = static_cast<Topic>(*channel - 1);
    }
  }
  std::set<v1::Layer> layers;
  for (const Channel& channel : allChannels()) {
    const auto topic = static_cast<std::size_t>(channel.topic);
    if (subscribed()[topic] && !before[topic]) layers.insert(channel.layer);
  }
  // Also where the layer is watched already: the new channel begins with a frame, even if the room stands still.
  for (const v1::Layer layer : layers) watch(layer);
}

void LiveSession::unsubscribe(const json::object& message) {
  for (const json::value& entry : listIn(message, "subscriptionIds")) {
    boost::system::error_code error;
    const auto id = entry.is_number() ? entry.to_number<std::uint32_t>(error) : 0;
    const auto ended = error || !entry.is_number() ? subscriptions_.end() : subscriptions_.find(id);
    if (ended == subscriptions_.end()) {
      fault("there is no subscription " + quoted(json::serialize(entry)));
      continue;
    }
    const v1::Layer layer = allChannels()[static_cast<std::size_t>(ended->second)].layer;
    subscriptions_.erase(ended);
    if ((subscribed() & topicsOf(layer)).none()) watch(layer);
  }
}

TopicSet LiveSession::subscribed() const {
  TopicSet out;
  for (const auto& [id, topic] : subscriptions_) out.set(static_cast<std::size_t>(topic));
  return out;
}

// Parameters

std::set<std::string> LiveSession::namesIn(const json::object& message) const {
  std::set<std::string> out;
  const json::array& names = listIn(message, "parameterNames");
  for (const json::value& name : names) {
    if (name.is_string() && parameters_.contains(std::string(name.get_string()))) out.emplace(name.get_string());
  }
  if (names.empty())
    for (const auto& [name, value] : parameters_) out.insert(name);
  return out;
}

std::vector<std::pair<std::string, double>> LiveSession::valuesOf(const std::set<std::string>& names) const {
  std::vector<std::pair<std::string, double>> out;
  for (const std::string& name : names) {
    if (const auto known = parameters_.find(name); known != parameters_.end()) out.emplace_back(*known);
  }
  return out;
}

void LiveSession::getParameters(const json::object& message) {
  answer(parameterValues(valuesOf(namesIn(message)), textIn(message, "id")));
}

void LiveSession::watchParameters(const json::object& message, bool are_watched) {
  for (const std::string& name : namesIn(message)) {
    if (are_watched)
      watched_parameters_.insert(name);
    else
      watched_parameters_.erase(name);
  }
}

void LiveSession::setParameters(const json::object& message) {
  Change change{.id = textIn(message, "id"), .names = {}};
  const std::uint64_t change_id = ++last_change_id_;
  for (const json::value& entry : listIn(message, "parameters")) {
    const json::object* const object = entry.if_object();
    const auto name = object ? textIn(*object, "name") : std::nullopt;
    const json::value* const value = object ? object->if_contains("value") : nullptr;
    if (!name) {
      fault("a parameter needs a name");
      continue;
    }
    change.names.insert(*name);
    if (!value || !value->is_number()) {
      fault("parameter " + quoted(*name) + ": the value has to be a number");
    } else if (commands_.size() >= kLiveCommandMaxCount) {
      fault("parameter " + quoted(*name) + ": " + std::to_string(kLiveCommandMaxCount) +
            " commands are under way, the limit: wait for their answers");
    } else {
      commands_[++last_command_id_] = change_id;
      ++change.left_count;
      v1::ClientMessage command;
      command.mutable_command()->set_command_id(last_command_id_);
      command.mutable_command()->mutable_set_parameter()->set_path(*name);
      command.mutable_command()->mutable_set_parameter()->set_value(value->to_number<double>());
      say(command);
    }
  }
  if (change.left_count > 0) {
    changes_[change_id] = std::move(change);
  } else if (change.id) {
    answer(parameterValues(valuesOf(change.names), change.id));
  }
}

// Services

void LiveSession::call(const Call& wanted, std::string_view encoding, std::string_view request) {
  const auto refuse = [&](const std::string& why) { answer(serviceFailure(wanted.service_id, wanted.call_id, why)); };
  const auto services = allServices();
  if (wanted.service_id == 0 || wanted.service_id > services.size())
    return refuse("there is no service " + std::to_string(wanted.service_id));
  if (encoding != "json") return refuse("encoding " + quoted(encoding) + " is not supported: use json");
  if (commands_.size() >= kLiveCommandMaxCount) {
    return refuse(std::to_string(kLiveCommandMaxCount) + " commands are under way, the limit: wait for their answers");
  }
  auto command = commandOf(services[wanted.service_id - 1], request);
  if (!command) return refuse(command.error().message);
  commands_[++last_command_id_] = wanted;
  command->set_command_id(last_command_id_);
  v1::ClientMessage message;
  *message.mutable_command() = *std::move(command);
  say(message);
}

}  // namespace spindrift::foxglove::live
