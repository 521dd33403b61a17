#include <fmt/format.h>

#include <spindrift/access/room_token.h>
#include <spindrift/service/access_control.h>
#include <spindrift/wire/server_message.h>

namespace spindrift::service {
namespace {

/// What the files of a room say; tokens that no server can have made are left out.
std::vector<access::RoomToken> tokensOf(const v1::RoomAccess& kept) {
  std::vector<access::RoomToken> out;
  for (const v1::KeptToken& one : kept.tokens()) {
    const auto role = wire::fromWire(one.role());
    access::RoomToken token{.role = role.value_or(core::Role::kViewer), .salt = one.salt()};
    if (!role || one.digest().size() != token.digest.size()) continue;
    std::copy(one.digest().begin(), one.digest().end(), token.digest.begin());
    out.push_back(std::move(token));
  }
  return out;
}

}  // namespace

AccessControl::AccessControl(AccessOptions options)
    : access_(std::move(options.access)),
      people_(options.person_commands_per_s, 2.0 * options.person_commands_per_s),
      audit_(std::move(options.audit_file)) {}

core::Result<access::Grant> AccessControl::resolve(std::string_view token, const std::vector<RoomTokens>& rooms,
                                                   std::chrono::system_clock::time_point now) const {
  auto grant = access_.get()->resolve(token, now);
  if (grant || grant.error().message != access::kUnknownToken) return grant;
  for (const RoomTokens& room : rooms) {
    const std::vector<access::RoomToken> known = tokensOf(room.tokens);
    if (const auto number = access::findRoomToken(token, known)) {
      return access::Grant{.role = known[*number].role,
                           .subject = fmt::format("token {} of room {}", *number + 1, room.room),
                           .rooms = std::vector<std::string>{room.room}};
    }
  }
  return grant;
}

core::Result<std::optional<access::Grant>> AccessControl::resolveForwarded(
    std::string_view authorization, std::chrono::system_clock::time_point now) const {
  const auto token = access::Access::bearerToken(authorization);
  if (!token) return token.error();
  auto grant = access_.get()->resolve(*token, now);
  if (grant) return std::optional(*std::move(grant));
  if (grant.error().message == access::kUnknownToken) return std::optional<access::Grant>();
  return grant.error();
}

bool AccessControl::takeCommand(const std::string& person) {
  return person.empty() || people_.take(person, std::chrono::steady_clock::now());
}

std::string AccessControl::busy() const {
  return fmt::format(
      "more than {:g} commands per second after a burst of {:g} by one person, over all sessions and rooms: slow down",
      people_.commandsPerSecond(), people_.burstCount());
}

core::Result<MadeTokens> makeTokens(const v1::CreateRoom& wanted) {
  const auto refuse = [](std::string why) { return core::invalid("tokens: " + std::move(why)); };
  if (static_cast<std::size_t>(wanted.tokens_size()) > access::kRoomTokenMaxCount)
    return refuse(fmt::format("{} are asked for; at most {}", wanted.tokens_size(), access::kRoomTokenMaxCount));
  MadeTokens out;
  for (const int number : wanted.tokens()) {
    const auto role = wire::fromWire(static_cast<v1::Role>(number));
    if (!role) return refuse("write ROLE_VIEWER, ROLE_PLAYER or ROLE_OPERATOR for each");
    const access::NewRoomToken made = access::makeRoomToken(*role);
    v1::KeptToken& kept = *out.kept.add_tokens();
    kept.set_role(wire::toWire(*role));
    kept.set_salt(made.kept.salt);
    kept.set_digest(made.kept.digest.data(), made.kept.digest.size());
    v1::RoomToken& shown = *out.shown.Add();
    shown.set_role(wire::toWire(*role));
    shown.set_token(made.token);
  }
  return out;
}

}  // namespace spindrift::service
