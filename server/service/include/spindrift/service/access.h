// Access control: tokens with their roles, and the role of clients without a token.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/core/sender.h>

namespace spindrift::service {

/// Minimum length of a token; shorter ones could be guessed.
inline constexpr std::size_t kTokenMinBytes = 16;

struct Grant {
  core::Role role = core::Role::kViewer;
  std::optional<std::chrono::system_clock::time_point> expires;  ///< never if not set
};

/// Immutable after construction; any thread.
class Access {
 public:
  /// Without tokens, clients are operators: a server for one user.
  Access() = default;

  /// Parses the text of the token file: one token per line, `ROLE TOKEN [until=2030-01-31T12:00:00Z]`, '#' begins a
  /// comment. `guest` is the role of clients without a token; nullopt: they are refused. Error kInvalidInput contains
  /// `label`, the line and the reason, never a token.
  static core::Result<Access> parse(std::string_view text, const std::string& label, std::optional<core::Role> guest);

  /// Returns the grant of a token; the empty token is that of a client without one. The error gives the reason of a
  /// refusal and never contains the token.
  [[nodiscard]] core::Result<Grant> resolve(std::string_view token, std::chrono::system_clock::time_point now) const;
  /// Returns the token of an `Authorization: Bearer TOKEN` header; empty for an empty header. kInvalidInput for other
  /// schemes.
  static core::Result<std::string> bearerToken(std::string_view authorization);

  [[nodiscard]] std::optional<core::Role> guest() const { return guest_; }
  [[nodiscard]] std::size_t tokenCount() const { return tokens_.size(); }

 private:
  struct Token {
    std::string secret;
    Grant grant;
  };
  std::vector<Token> tokens_;
  std::optional<core::Role> guest_ = core::Role::kOperator;
};

}  // namespace spindrift::service
