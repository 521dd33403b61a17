#include <cstdio>
#include <sstream>

#include <spindrift/access/access.h>
#include <spindrift/core/room_name.h>

namespace spindrift::access {
namespace {

using std::chrono::system_clock;

/// "2030-01-31T12:00:00Z".
std::optional<system_clock::time_point> parseUtc(const std::string& text) {
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, second = 0;
  char end = 0, more = 0;
  if (std::sscanf(text.c_str(), "%4d-%2d-%2dT%2d:%2d:%2d%c%c", &year, &month, &day, &hour, &minute, &second, &end,
                  &more) != 7 ||
      end != 'Z') {
    return std::nullopt;
  }
  using namespace std::chrono;
  const year_month_day date{std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                            std::chrono::day(static_cast<unsigned>(day))};
  constexpr int kFirstYear = 1970, kLastYear = 2200;  // clocks count nanoseconds in 64 bits
  if (!date.ok() || year < kFirstYear || year > kLastYear || hour < 0 || hour > 23 || minute < 0 || minute > 59 ||
      second < 0 || second > 59)
    return std::nullopt;
  return sys_days(date) + hours(hour) + minutes(minute) + seconds(second);
}

/// "main,lab" as a list; nullopt if a name is one that no room has, or there are too many.
std::optional<std::vector<std::string>> parseRooms(std::string_view text) {
  std::vector<std::string> out;
  for (;;) {
    const std::size_t comma = text.find(',');
    const std::string_view name = text.substr(0, comma);
    if (!core::isRoomName(name) || out.size() == kTokenRoomMaxCount) return std::nullopt;
    out.emplace_back(name);
    if (comma == std::string_view::npos) return out;
    text.remove_prefix(comma + 1);
  }
}

/// Takes one option behind a token. Returns why not, or an empty string. The option is not repeated: it may be half of
/// a token with a space in it.
std::string takeOption(const std::string& option, Grant& grant) {
  const auto valueOf = [&](std::string_view name) -> std::optional<std::string> {
    if (!option.starts_with(name)) return std::nullopt;
    return option.substr(name.size());
  };
  if (const auto until = valueOf("until=")) {
    if (grant.expires) return "until= is given twice";
    grant.expires = parseUtc(*until);
    return grant.expires ? "" : "until= has to read until=2030-01-31T12:00:00Z (UTC)";
  }
  if (const auto rooms = valueOf("room=")) {
    if (grant.rooms) return "room= is given twice: write room=ONE,OTHER";
    grant.rooms = parseRooms(*rooms);
    return grant.rooms ? ""
                       : "room= has to be a list of 1 to " + std::to_string(kTokenRoomMaxCount) +
                             " rooms with ',' between them, each with " + std::string(core::kRoomNameRule);
  }
  if (const auto subject = valueOf("sub=")) {
    if (grant.is_person) return "sub= is given twice";
    if (subject->empty() || subject->size() > kSubjectMaxBytes)
      return "sub= has to name a person, with 1 to " + std::to_string(kSubjectMaxBytes) + " bytes";
    grant.subject = *subject;
    grant.is_person = true;
    return "";
  }
  return "after the token only room=, sub= and until=2030-01-31T12:00:00Z (UTC) are allowed";
}

}  // namespace

core::Result<Access> Access::parse(std::string_view text, const std::string& label, std::optional<core::Role> guest) {
  Access out;
  out.guest_ = guest;
  std::istringstream lines{std::string(text)};
  int line_number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++line_number;
    const std::string place = label + ":" + std::to_string(line_number);
    std::istringstream words(line.substr(0, line.find('#')));
    std::string role_word, secret;
    if (!(words >> role_word)) continue;
    const auto refuse = [&](const std::string& why) { return core::invalid(place + ": " + why); };
    const auto role = core::parseRole(role_word);
    if (!role) return refuse("the first word is not a role: write viewer, player or operator, then the token");
    if (!(words >> secret)) return refuse("a token has to follow the role");
    if (secret.size() < kTokenMinBytes) {
      return refuse("the token has " + std::to_string(secret.size()) + " characters; at least " +
                    std::to_string(kTokenMinBytes) + ", as `openssl rand -hex 16` makes them");
    }
    if (secret.size() > kTokenMaxBytes) {
      return refuse("the token has " + std::to_string(secret.size()) + " characters; at most " +
                    std::to_string(kTokenMaxBytes));
    }
    Token token{.digest = digestOf(secret), .grant = {.role = *role, .subject = place}};
    for (std::string option; words >> option;) {
      if (const std::string why = takeOption(option, token.grant); !why.empty()) return refuse(why);
    }
    for (const Token& known : out.tokens_) {
      if (isEqual(known.digest, token.digest)) return refuse("the same token is on an earlier line");
    }
    out.tokens_.push_back(std::move(token));
  }
  return out;
}

void Access::acceptJwts(std::vector<JwtKey> keys, JwtRules rules) {
  jwt_keys_ = std::move(keys);
  jwt_rules_ = std::move(rules);
}

core::Result<Grant> Access::resolve(std::string_view token, system_clock::time_point now) const {
  if (token.empty()) {
    if (guest_) return Grant{.role = *guest_};
    return core::invalid("this server takes no guests: send a token");
  }
  if (token.size() > kTokenMaxBytes) {
    return core::invalid("the token is longer than " + std::to_string(kTokenMaxBytes) + " bytes");
  }
  const Digest digest = digestOf(token);
  const Token* found = nullptr;
  for (const Token& known : tokens_) {  // all of them, so that the time tells nothing
    if (isEqual(known.digest, digest)) found = &known;
  }
  if (!found && !jwt_keys_.empty() && looksLikeJwt(token)) return verifyJwt(token, jwt_keys_, jwt_rules_, now);
  if (!found) return core::invalid(std::string(kUnknownToken));
  if (found->grant.expires && *found->grant.expires <= now) {
    return core::invalid("the token has expired: ask for a new one");
  }
  return found->grant;
}

std::string otherRoom(std::string_view room) {
  return "the token is not for room '" + std::string(room) + "': ask for one that is, or join another room";
}

core::Result<std::string> Access::bearerToken(std::string_view authorization) {
  if (authorization.empty()) return std::string();
  constexpr std::string_view kScheme = "Bearer ";
  if (!authorization.starts_with(kScheme) || authorization.size() == kScheme.size()) {
    return core::invalid("the Authorization header has to read: Bearer TOKEN");
  }
  return std::string(authorization.substr(kScheme.size()));
}

}  // namespace spindrift::access
