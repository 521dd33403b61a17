#include <cstdint>
#include <cstdio>
#include <sstream>

#include <spindrift/service/access.h>

namespace spindrift::service {
namespace {

using core::Error;
using core::ErrorCode;
using std::chrono::system_clock;

/// The duration does not depend on where the two differ, so it tells nothing about a token.
bool equalsInConstantTime(std::string_view a, std::string_view b) {
  std::uint32_t difference = a.size() == b.size() ? 0 : 1;
  for (std::size_t k = 0; k < a.size(); ++k) {
    difference |= static_cast<unsigned char>(a[k]) ^ static_cast<unsigned char>(b.empty() ? 0 : b[k % b.size()]);
  }
  return difference == 0;
}

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
  constexpr int kLastYear = 2200;  // clocks count nanoseconds in 64 bits
  if (!date.ok() || year > kLastYear || hour < 0 || hour > 23 || minute < 0 || minute > 59 || second < 0 || second > 59)
    return std::nullopt;
  return sys_days(date) + hours(hour) + minutes(minute) + seconds(second);
}

}  // namespace

core::Result<Access> Access::parse(std::string_view text, const std::string& label, std::optional<core::Role> guest) {
  Access out;
  out.guest_ = guest;
  std::istringstream lines{std::string(text)};
  int line_number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++line_number;
    std::istringstream words(line.substr(0, line.find('#')));
    std::string role_word, secret, option, more;
    if (!(words >> role_word)) continue;
    const auto refuse = [&](const std::string& why) {
      return Error{ErrorCode::kInvalidInput, label + ":" + std::to_string(line_number) + ": " + why};
    };
    const auto role = core::parseRole(role_word);
    if (!role) return refuse("the first word is no role: write viewer, player or operator, then the token");
    if (!(words >> secret)) return refuse("a token has to follow the role");
    if (secret.size() < kTokenMinBytes) {
      return refuse("the token has " + std::to_string(secret.size()) + " characters; at least " +
                    std::to_string(kTokenMinBytes) + ", as `openssl rand -hex 16` makes them");
    }
    Token token{.secret = secret, .grant = {.role = *role, .expires = std::nullopt}};
    if (words >> option) {
      constexpr std::string_view kUntil = "until=";
      token.grant.expires = option.starts_with(kUntil) ? parseUtc(option.substr(kUntil.size())) : std::nullopt;
      if (!token.grant.expires || words >> more) {
        return refuse("after the token only until=2030-01-31T12:00:00Z (UTC) may stand");
      }
    }
    for (const Token& known : out.tokens_) {
      if (known.secret == secret) return refuse("the same token stands on an earlier line");
    }
    out.tokens_.push_back(std::move(token));
  }
  return out;
}

core::Result<Grant> Access::resolve(std::string_view token, system_clock::time_point now) const {
  if (token.empty()) {
    if (guest_) return Grant{.role = *guest_, .expires = std::nullopt};
    return Error{ErrorCode::kInvalidInput, "this server takes no guests: send a token"};
  }
  const Token* found = nullptr;
  for (const Token& known : tokens_) {
    if (equalsInConstantTime(known.secret, token)) found = &known;
  }
  if (!found) return Error{ErrorCode::kInvalidInput, "this server does not know that token"};
  if (found->grant.expires && *found->grant.expires <= now) {
    return Error{ErrorCode::kInvalidInput, "the token has expired: ask for a new one"};
  }
  return found->grant;
}

core::Result<std::string> Access::bearerToken(std::string_view authorization) {
  if (authorization.empty()) return std::string();
  constexpr std::string_view kScheme = "Bearer ";
  if (!authorization.starts_with(kScheme) || authorization.size() == kScheme.size()) {
    return Error{ErrorCode::kInvalidInput, "the Authorization header has to read: Bearer TOKEN"};
  }
  return std::string(authorization.substr(kScheme.size()));
}

}  // namespace spindrift::service
