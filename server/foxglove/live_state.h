// The state of a session of Foxglove's protocol. live_requests.cpp reads what the client sends, live_session.cpp writes
// what it gets.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <boost/json/object.hpp>

#include <spindrift/foxglove/live_session.h>

#include "live_messages.h"

namespace spindrift::foxglove::live {

/// First byte of a session's own messages while they wait among its answers: no message of the wire begins with it,
/// because there is no field 0. The second one says whether the message is text.
inline constexpr std::uint8_t kOwnMessage = 0;

class LiveSession final : public core::Translator {
 public:
  explicit LiveSession(std::string token) : token_(std::move(token)) {}

  [[nodiscard]] Incoming open() override;
  [[nodiscard]] Incoming receive(core::ByteView message, bool is_text) override;
  [[nodiscard]] std::vector<Outgoing> send(core::ByteView message) override;

 private:
  /// A call of a service whose command is under way.
  struct Call {
    std::uint32_t service_id = 0;
    std::uint32_t call_id = 0;
  };
  /// setParameters whose commands are under way.
  struct Change {
    std::optional<std::string> id;
    std::set<std::string> names;
    std::size_t left_count = 0;
  };

  // From the client.
  void readText(core::ByteView message);
  void readBinary(core::ByteView message);
  void subscribe(const boost::json::object& message);
  void unsubscribe(const boost::json::object& message);
  void getParameters(const boost::json::object& message);
  void setParameters(const boost::json::object& message);
  void watchParameters(const boost::json::object& message, bool are_watched);
  void call(const Call& call, std::string_view encoding, std::string_view request);
  /// Adds a message of the wire.
  void say(const v1::ClientMessage& message);
  void answer(const Outgoing& message);
  /// Notes what is wrong with the message; the client gets the first fault and the number of the others.
  void fault(std::string why);
  /// Subscribes to the layer as the client's subscriptions need it.
  void watch(v1::Layer layer);
  /// Returns the known names of a request, or all that there are if it has none.
  [[nodiscard]] std::set<std::string> namesIn(const boost::json::object& message) const;
  [[nodiscard]] std::vector<std::pair<std::string, double>> valuesOf(const std::set<std::string>& names) const;

  // To the client.
  void greet(const v1::Greeting& greeting, std::vector<Outgoing>& out);
  void change(const v1::ParameterChanged& changed, std::vector<Outgoing>& out);
  void forward(const std::vector<Message>& messages, std::vector<Outgoing>& out);
  /// `rejection`: null if the command was carried out.
  void end(std::uint64_t command_id, const v1::Ack& ack, const v1::Reject* rejection, std::vector<Outgoing>& out);
  [[nodiscard]] TopicSet subscribed() const;

  const std::string token_;
  Incoming turn_;  ///< of the message that is read
  std::string fault_;
  std::size_t fault_count_ = 0;

  bool is_greeted_ = false;
  Converter converter_;
  TopicSet offered_;
  std::map<std::uint32_t, Topic> subscriptions_;  ///< by the client's ids; at most one per topic
  std::map<std::string, double> parameters_;      ///< of the room's scene
  std::set<std::string> watched_parameters_;      ///< among them
  std::uint64_t last_command_id_ = 0;
  std::uint64_t last_change_id_ = 0;
  std::map<std::uint64_t, std::variant<Call, std::uint64_t>> commands_;  ///< under way: a call, or the id of a change
  std::map<std::uint64_t, Change> changes_;                              ///< with commands under way
  std::optional<std::uint64_t> clock_ns_;  ///< the client's; nullopt: its next time may be any
};

}  // namespace spindrift::foxglove::live
