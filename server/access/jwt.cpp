#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <openssl/err.h>
#include <openssl/evp.h>

#include <spindrift/access/base64url.h>
#include <spindrift/access/digest.h>
#include <spindrift/access/jwt.h>
#include <spindrift/core/room_name.h>

#include "json_object.h"

namespace spindrift::access {
namespace {

namespace json = boost::json;
using std::chrono::system_clock;

constexpr double kLastTime_s = 7258118400.0;  // the year 2200: clocks count nanoseconds in 64 bits

core::Error refusal(std::string why) {
  return core::invalid("the JWT is refused: " + std::move(why));
}

struct Parts {
  std::string_view header, claims, signature;
  std::string_view signed_text;  ///< header and claims with the dot between them
};

std::optional<Parts> split(std::string_view token) {
  const std::size_t first = token.find('.');
  const std::size_t second = first == std::string_view::npos ? first : token.find('.', first + 1);
  if (second == std::string_view::npos || token.find('.', second + 1) != std::string_view::npos) return std::nullopt;
  Parts out{token.substr(0, first), token.substr(first + 1, second - first - 1), token.substr(second + 1),
            token.substr(0, second)};
  if (out.header.empty() || out.claims.empty() || out.signature.empty()) return std::nullopt;
  return out;
}

/// The error completes "its header" or "its claims".
core::Result<json::object> parsePart(std::string_view base64) {
  const auto text = fromBase64Url(base64);
  auto object = text ? parseJsonObject(*text) : core::invalid("no base64url");
  if (!object) return core::Error{object.error().code, "cannot be used: it is " + object.error().message};
  return object;
}

bool isSignedWith(const JwtKey& key, std::string_view text, std::string_view signature) {
  if (key.algorithm == JwtAlgorithm::kHs256) {
    Digest given{};
    if (signature.size() != given.size()) return false;
    std::copy(signature.begin(), signature.end(), given.begin());
    return isEqual(hmacOf(key.secret, text), given);
  }
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(), &EVP_MD_CTX_free);
  const EVP_MD* const hash = key.algorithm == JwtAlgorithm::kRs256 ? EVP_sha256() : nullptr;  // Ed25519 has its own
  const auto bytes = [](std::string_view of) { return reinterpret_cast<const unsigned char*>(of.data()); };
  // RSA keys are used with the padding of PKCS #1 v1.5 unless told otherwise: that of RS256.
  const bool fits = context && EVP_DigestVerifyInit(context.get(), nullptr, hash, nullptr, key.public_key.get()) == 1 &&
                    EVP_DigestVerify(context.get(), bytes(signature), signature.size(), bytes(text), text.size()) == 1;
  ERR_clear_error();
  return fits;
}

/// Returns why no key accepts the signature; nullopt if one does. The header chooses among the keys only.
std::optional<std::string> checkSignature(const Parts& parts, const std::vector<JwtKey>& keys) {
  const auto header = parsePart(parts.header);
  if (!header) return "its header " + header.error().message;
  // Extensions that a recipient has to understand (RFC 7515 section 4.1.11); this one understands none.
  if (header->contains("crit")) return "its header has crit, which is not supported";
  const json::value* const algorithm = header->if_contains("alg");
  if (!algorithm || !algorithm->is_string()) return "its header has no alg";
  const json::value* const id = header->if_contains("kid");
  if (id && !id->is_string()) return "kid in its header is not text";
  const auto signature = fromBase64Url(parts.signature);
  if (!signature) return "its signature is not base64url";
  bool is_known_algorithm = false;
  bool is_known_key = false;
  for (const JwtKey& key : keys) {
    if (nameOf(key.algorithm) != std::string_view(algorithm->get_string())) continue;
    is_known_algorithm = true;
    if (id && !key.id.empty() && key.id != std::string_view(id->get_string())) continue;
    is_known_key = true;
    if (isSignedWith(key, parts.signed_text, *signature)) return std::nullopt;
  }
  if (!is_known_algorithm) return "no key of this server is for the alg in its header";
  if (!is_known_key) return "this server does not know the key that kid in its header names";
  return "its signature does not fit a key of this server";
}

// Claims

/// Reads claims one by one and keeps the first fault.
class Claims {
 public:
  explicit Claims(const json::object& claims) : claims_(claims) {}

  [[nodiscard]] const std::string& fault() const { return fault_; }
  void fail(std::string why) {
    if (fault_.empty()) fault_ = std::move(why);
  }

  [[nodiscard]] const json::value* find(std::string_view claim) const { return claims_.if_contains(claim); }

  /// Empty where it is missing.
  std::string text(const char* claim, std::size_t max_bytes) {
    const json::value* const found = find(claim);
    if (!found) return {};
    if (!found->is_string()) return fail(fmt::format("{} is not text", claim)), std::string();
    const auto& text = found->get_string();
    if (text.size() > max_bytes) {
      return fail(fmt::format("{} has {} bytes; at most {}", claim, text.size(), max_bytes)), std::string();
    }
    return {text.data(), text.size()};
  }

  /// NumericDate (RFC 7519 section 2): seconds since 1970, with or without a fraction.
  std::optional<system_clock::time_point> time(const char* claim) {
    const json::value* const found = find(claim);
    if (!found) return std::nullopt;
    double seconds = 0.0;
    if (found->is_int64())
      seconds = static_cast<double>(found->get_int64());
    else if (found->is_uint64())
      seconds = static_cast<double>(found->get_uint64());
    else if (found->is_double())
      seconds = found->get_double();
    else
      return fail(fmt::format("{} is not a number of seconds", claim)), std::nullopt;
    if (!std::isfinite(seconds) || seconds < 0.0 || seconds > kLastTime_s) {
      return fail(fmt::format("{} is not between 0 and {:.0f} seconds since 1970", claim, kLastTime_s)), std::nullopt;
    }
    return system_clock::time_point(
        std::chrono::duration_cast<system_clock::duration>(std::chrono::duration<double>(seconds)));
  }

  /// A text, or a list of texts; nullopt where it is missing.
  std::optional<std::vector<std::string>> texts(const char* claim, std::size_t max_count, std::size_t max_bytes) {
    const json::value* const found = find(claim);
    if (!found) return std::nullopt;
    std::vector<std::string> out;
    const auto take = [&](const json::value& one) {
      const auto* const text = one.if_string();
      if (!text || text->empty() || text->size() > max_bytes)
        return fail(fmt::format("{} has an entry that is not text of 1 to {} bytes", claim, max_bytes));
      out.emplace_back(text->data(), text->size());
    };
    if (const json::array* const list = found->if_array()) {
      if (list->empty()) fail(fmt::format("{} is an empty list", claim));
      if (list->size() > max_count) {
        fail(fmt::format("{} has {} entries; at most {}", claim, list->size(), max_count));
        return std::nullopt;
      }
      for (const json::value& one : *list) take(one);
    } else {
      take(*found);
    }
    return out;
  }

 private:
  const json::object& claims_;
  std::string fault_;
};

void checkParties(Claims& claims, const JwtRules& rules) {
  constexpr std::size_t kPartyMaxBytes = 1024;
  constexpr std::size_t kAudienceMaxCount = 64;
  if (!rules.issuer.empty() && claims.text("iss", kPartyMaxBytes) != rules.issuer)
    claims.fail("iss is not the issuer that --jwt-issuer names");
  if (rules.audience.empty()) return;
  const auto audiences = claims.texts("aud", kAudienceMaxCount, kPartyMaxBytes);
  if (!audiences || std::ranges::find(*audiences, rules.audience) == audiences->end())
    claims.fail("aud does not name this server (--jwt-audience)");
}

void checkTimes(Claims& claims, system_clock::time_point now, Grant& grant) {
  const auto expires = claims.time("exp");
  const auto begins = claims.time("nbf");
  const auto issued = claims.time("iat");
  if (!expires) return claims.fail("exp is missing: a token has to expire");
  grant.expires = *expires + kJwtLeeway;
  if (*grant.expires <= now) claims.fail("it has expired: ask for a new one");
  if (begins && *begins - kJwtLeeway > now) claims.fail("its time has not begun (nbf)");
  if (issued && *issued - kJwtLeeway > now) claims.fail("it was issued in the future (iat): compare the clocks");
}

}  // namespace

bool looksLikeJwt(std::string_view token) {
  return split(token).has_value();
}

core::Result<Grant> verifyJwt(std::string_view token, const std::vector<JwtKey>& keys, const JwtRules& rules,
                              system_clock::time_point now) {
  if (token.size() > kTokenMaxBytes) return refusal(fmt::format("it is longer than {} bytes", kTokenMaxBytes));
  const auto parts = split(token);
  if (!parts) return refusal("it does not consist of three parts between dots");
  if (auto why = checkSignature(*parts, keys)) return refusal(*std::move(why));
  const auto object = parsePart(parts->claims);
  if (!object) return refusal("the part with its claims " + object.error().message);

  Claims claims(*object);
  Grant grant;
  checkParties(claims, rules);
  checkTimes(claims, now, grant);
  constexpr std::size_t kRoleMaxBytes = 16;
  const auto role = core::parseRole(claims.text("role", kRoleMaxBytes));
  if (!role) claims.fail("role has to be viewer, player or operator");
  grant.role = role.value_or(core::Role::kViewer);
  grant.subject = claims.text("sub", kSubjectMaxBytes);
  grant.is_person = !grant.subject.empty();
  grant.name = claims.text("name", kNameMaxBytes);
  grant.rooms = claims.texts("room", kTokenRoomMaxCount, core::kRoomNameMaxBytes);
  if (grant.rooms && !std::ranges::all_of(*grant.rooms, core::isRoomName))
    claims.fail(fmt::format("room has an entry that is not a name of a room ({})", core::kRoomNameRule));
  if (!claims.fault().empty()) return refusal(claims.fault());
  if (!grant.is_person) grant.subject = "a JWT without sub";
  return grant;
}

}  // namespace spindrift::access
