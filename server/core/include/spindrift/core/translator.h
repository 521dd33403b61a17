// Another protocol over a session: stands between the messages that the server speaks and those of the client.
#pragma once

#include <vector>

#include <spindrift/core/bytes.h>

namespace spindrift::core {

/// One per session. Its calls come one at a time.
class Translator {
 public:
  struct Outgoing {
    SharedBytes bytes;
    bool is_text = false;
  };
  /// Consequences of a client's message.
  struct Incoming {
    std::vector<Bytes> messages;       ///< of the server's protocol, from the client, in order
    std::vector<SharedBytes> answers;  ///< wait among the session's answers, then come to send() unchanged
  };

  virtual ~Translator() = default;
  /// Returns what the client would have said first in the server's protocol.
  [[nodiscard]] virtual Incoming open() = 0;
  /// Takes a whole message of the client, untrusted bytes.
  [[nodiscard]] virtual Incoming receive(ByteView message, bool is_text) = 0;
  /// Takes a message that is about to be sent, once it has left the outbox, so that frames which are dropped there are
  /// never translated. Returns the client's messages, none for what the client's protocol does not have.
  [[nodiscard]] virtual std::vector<Outgoing> send(ByteView message) = 0;
};

}  // namespace spindrift::core
