// A session's place among those that may be open.
#pragma once

#include <atomic>
#include <string>

#include "server_context.h"

namespace spindrift::net {

/// Reserved before the handshake, so that many simultaneous handshakes cannot exceed the limits; given back at the end
/// of the session.
class SessionPlace {
 public:
  /// Both outlive it.
  SessionPlace(ServerContext& context, const std::string& address)
      : context_(context),
        address_(address),
        is_free_(++context.reserved_session_count <= context.options.max_session_count),
        is_in_share_(is_free_ && context.addresses.takeSession(address)) {}
  SessionPlace(const SessionPlace&) = delete;
  SessionPlace& operator=(const SessionPlace&) = delete;
  ~SessionPlace() {
    if (is_at_foxglove_) --context_.foxglove_session_count;
    if (is_in_share_) context_.addresses.releaseSession(address_);
    --context_.reserved_session_count;
  }

  /// Returns whether there was one below max_session_count.
  [[nodiscard]] bool isFree() const { return is_free_; }
  /// Returns whether it is also below the address's limit.
  [[nodiscard]] bool isInShare() const { return is_in_share_; }
  /// Takes a place among the sessions at /foxglove as well; call it once. Returns whether one was free.
  [[nodiscard]] bool takeFoxglove() {
    is_at_foxglove_ = ++context_.foxglove_session_count <= context_.options.foxglove_session_max_count;
    if (!is_at_foxglove_) --context_.foxglove_session_count;
    return is_at_foxglove_;
  }

 private:
  ServerContext& context_;
  const std::string& address_;
  const bool is_free_;
  const bool is_in_share_;
  bool is_at_foxglove_ = false;
};

}  // namespace spindrift::net
