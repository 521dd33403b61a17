#include <spindrift/access/base64url.h>
#include <spindrift/access/room_token.h>

namespace spindrift::access {

NewRoomToken makeRoomToken(core::Role role) {
  constexpr std::size_t kTokenBytes = 32;
  NewRoomToken out{.token = toBase64Url(randomBytes(kTokenBytes)),
                   .kept = {.role = role, .salt = randomBytes(kRoomTokenSaltBytes)}};
  out.kept.digest = digestOf(out.kept.salt, out.token);
  return out;
}

std::optional<std::size_t> findRoomToken(std::string_view token, const std::vector<RoomToken>& known) {
  std::optional<std::size_t> found;
  for (std::size_t k = 0; k < known.size(); ++k) {
    if (isEqual(digestOf(known[k].salt, token), known[k].digest)) found = k;
  }
  return found;
}

}  // namespace spindrift::access
