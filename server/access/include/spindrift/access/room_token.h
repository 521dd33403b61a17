// Tokens that belong to one room: made when it is opened, kept with it as salted digests.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <spindrift/access/digest.h>
#include <spindrift/core/sender.h>

namespace spindrift::access {

inline constexpr std::size_t kRoomTokenMaxCount = 16;
inline constexpr std::size_t kRoomTokenSaltBytes = 16;

/// Digest of a token, from which the token cannot be found.
struct RoomToken {
  core::Role role = core::Role::kViewer;
  std::string salt;  ///< kRoomTokenSaltBytes random bytes
  Digest digest{};   ///< of salt and token
};

struct NewRoomToken {
  std::string token;  ///< 43 characters of base64url: 256 random bits. Shown once.
  RoomToken kept;
};

NewRoomToken makeRoomToken(core::Role role);
/// Returns the number of the token in `known`, or nullopt. Compares with all of them, in constant time each.
std::optional<std::size_t> findRoomToken(std::string_view token, const std::vector<RoomToken>& known);

}  // namespace spindrift::access
