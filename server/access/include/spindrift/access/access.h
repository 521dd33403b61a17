// Access control: tokens with what they allow, and the role of clients without a token.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <spindrift/access/digest.h>
#include <spindrift/access/grant.h>
#include <spindrift/access/jwt.h>
#include <spindrift/core/result.h>
#include <spindrift/core/sender.h>

namespace spindrift::access {

/// Immutable after construction; any thread.
class Access {
 public:
  /// Makes an access without tokens, in which clients are operators: a server for one user.
  Access() = default;

  /// Parses the text of the token file: one token per line,
  ///   ROLE TOKEN [room=NAME,…] [sub=PERSON] [until=2030-01-31T12:00:00Z]
  /// and '#' begins a comment. `guest` is the role of clients without a token; nullopt: they are refused. Error
  /// kInvalidInput contains `label`, the line and the reason, never a token. Only digests of the tokens are kept.
  static core::Result<Access> parse(std::string_view text, const std::string& label, std::optional<core::Role> guest);

  /// Accepts JSON Web Tokens of these keys, too.
  void acceptJwts(std::vector<JwtKey> keys, JwtRules rules);

  /// Returns what a token allows, and in which rooms (Grant::allows()); the empty token is that of a client without
  /// one. The error gives the reason of a refusal and never contains the token.
  [[nodiscard]] core::Result<Grant> resolve(std::string_view token, std::chrono::system_clock::time_point now) const;
  /// Returns the token of an `Authorization: Bearer TOKEN` header; empty for an empty header. kInvalidInput for other
  /// schemes.
  static core::Result<std::string> bearerToken(std::string_view authorization);

  [[nodiscard]] std::optional<core::Role> guest() const { return guest_; }
  [[nodiscard]] std::size_t tokenCount() const { return tokens_.size(); }
  [[nodiscard]] std::size_t jwtKeyCount() const { return jwt_keys_.size(); }

 private:
  struct Token {
    Digest digest;
    Grant grant;
  };
  std::vector<Token> tokens_;
  std::vector<JwtKey> jwt_keys_;
  JwtRules jwt_rules_;
  std::optional<core::Role> guest_ = core::Role::kOperator;
};

/// Returns the line for a client whose token is not for this room.
std::string otherRoom(std::string_view room);

/// Error of a token that nothing here knows: another list of tokens may know it.
inline constexpr std::string_view kUnknownToken = "this server does not know that token";

}  // namespace spindrift::access
