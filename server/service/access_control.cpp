#include <algorithm>

#include <fmt/format.h>

#include <spindrift/access/base64url.h>
#include <spindrift/access/digest.h>
#include <spindrift/service/access_control.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::service {
namespace {

/// Returns what a token that was made for the room allows; nullopt for another token. Compares with all of them, in
/// constant time each.
std::optional<access::Grant> grantOf(std::string_view token, const RoomTokens& room) {
  std::optional<access::Grant> out;
  int number = 0;
  for (const v1::KeptToken& kept : room.tokens.tokens()) {
    const auto role = wire::fromWire(kept.role());
    access::Digest digest{};
    if (!role || kept.digest().size() != digest.size()) continue;  // no server can have made it
    std::copy(kept.digest().begin(), kept.digest().end(), digest.begin());
    ++number;
    if (!access::isEqual(access::digestOf(kept.salt(), token), digest)) continue;
    out = access::Grant{.role = *role,
                        .subject = fmt::format("token {} of room {}", number, room.room),
                        .rooms = std::vector<std::string>{room.room}};
  }
  return out;
}

}  // namespace

AccessControl::AccessControl(AccessOptions options)
    : access_(std::make_shared<const access::Access>(std::move(options.access))),
      people_(options.person_commands_per_s, 2.0 * options.person_commands_per_s),
      audit_(std::move(options.audit_file)) {}

core::Result<access::Grant> AccessControl::resolve(std::string_view token, const std::vector<RoomTokens>& rooms,
                                                   std::chrono::system_clock::time_point now) const {
  auto grant = present()->resolve(token, now);
  if (grant || grant.error().message != access::kUnknownToken) return grant;
  for (const RoomTokens& room : rooms) {
    if (auto made = grantOf(token, room)) return *std::move(made);
  }
  return grant;
}

core::Result<std::optional<access::Grant>> AccessControl::resolveForwarded(
    std::string_view authorization, std::chrono::system_clock::time_point now) const {
  const auto token = access::Access::bearerToken(authorization);
  if (!token) return token.error();
  auto grant = present()->resolve(*token, now);
  if (grant) return std::optional(*std::move(grant));
  if (grant.error().message == access::kUnknownToken) return std::optional<access::Grant>();
  return grant.error();
}

void AccessControl::replace(access::Access access) {
  auto next = std::make_shared<const access::Access>(std::move(access));
  const std::lock_guard lock(mutex_);
  access_ = std::move(next);
}

std::shared_ptr<const access::Access> AccessControl::present() const {
  const std::lock_guard lock(mutex_);
  return access_;
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
  constexpr int kMaxCount = 16;
  constexpr std::size_t kTokenBytes = 32;  // 43 characters, which cannot be guessed
  constexpr std::size_t kSaltBytes = 16;
  const auto refuse = [](std::string why) { return core::invalid("tokens: " + std::move(why)); };
  if (wanted.tokens_size() > kMaxCount)
    return refuse(fmt::format("{} are asked for; at most {}", wanted.tokens_size(), kMaxCount));
  MadeTokens out;
  for (const int number : wanted.tokens()) {
    const auto role = wire::fromWire(static_cast<v1::Role>(number));
    if (!role) return refuse("write ROLE_VIEWER, ROLE_PLAYER or ROLE_OPERATOR for each");
    v1::RoomToken& shown = *out.shown.Add();
    shown.set_role(wire::toWire(*role));
    shown.set_token(access::toBase64Url(access::randomBytes(kTokenBytes)));
    v1::KeptToken& kept = *out.kept.add_tokens();
    kept.set_role(shown.role());
    kept.set_salt(access::randomBytes(kSaltBytes));
    const access::Digest digest = access::digestOf(kept.salt(), shown.token());
    kept.set_digest(digest.data(), digest.size());
  }
  return out;
}

}  // namespace spindrift::service
