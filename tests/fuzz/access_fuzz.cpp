// Who may: a byte that says what is tried, then a token, the header and claims of a token that gets the right signature
// (so that the checks behind it are reached), a JWK set, a public key, or a file of tokens.
#include <algorithm>
#include <string>

#include <spindrift/access/access.h>
#include <spindrift/access/base64url.h>
#include <spindrift/access/digest.h>
#include <spindrift/core/room_name.h>

#include "fuzz.h"

namespace spindrift::fuzz {
namespace {

using std::chrono::system_clock;

const std::string kSecret = "a-secret-of-at-least-32-characters";
const system_clock::time_point kNow{std::chrono::seconds(1'800'000'000)};

/// Tokens are long words. The fuzzer knows the words of the messages, so these cannot be looked for in the input.
bool hasLongWord(std::string_view text) {
  constexpr std::size_t kWordMaxBytes = 32;
  for (std::size_t begin = 0, end = 0; end != std::string_view::npos; begin = end + 1) {
    end = text.find(' ', begin);
    if (text.substr(begin, end == std::string_view::npos ? end : end - begin).size() > kWordMaxBytes) return true;
  }
  return false;
}

void checkError(const core::Error& error) {
  must(!error.message.empty() && std::ranges::none_of(error.message, [](char c) { return c >= 0 && c < ' '; }),
       "a refusal is one line");
  must(!hasLongWord(error.message), "a refusal does not repeat a token");
}

void checkGrant(const access::Grant& grant) {
  must(grant.subject.size() <= access::kSubjectMaxBytes && grant.name.size() <= access::kNameMaxBytes,
       "subject and name keep their bounds");
  must(grant.is_person <= !grant.subject.empty(), "a person has a subject");
  must(grant.expires && *grant.expires > kNow, "an accepted token ends later");
  if (!grant.rooms) return;
  must(!grant.rooms->empty() && grant.rooms->size() <= access::kTokenRoomMaxCount, "rooms keep their bound");
  for (const std::string& room : *grant.rooms)
    must(!room.empty() && room.size() <= core::kRoomNameMaxBytes, "a room has a name");
}

std::string signatureOf(std::string_view text) {
  const access::Digest digest = access::hmacOf(kSecret, text);
  return access::toBase64Url({reinterpret_cast<const char*>(digest.data()), digest.size()});
}

core::Result<access::Grant> verified(std::string_view token) {
  static const std::vector<access::JwtKey> keys{
      {.algorithm = access::JwtAlgorithm::kHs256, .id = "", .secret = kSecret, .public_key = {}}};
  auto grant = access::verifyJwt(token, keys, {}, kNow);
  if (!grant) checkError(grant.error());
  return grant;
}

void tryToken(std::string_view token) {
  if (const auto bytes = access::fromBase64Url(token))
    must(access::toBase64Url(*bytes) == token, "bytes have one encoding only");
  const auto grant = verified(token);
  if (!grant) return;
  checkGrant(*grant);
  const std::size_t dot = token.rfind('.');
  must(token.substr(dot + 1) == signatureOf(token.substr(0, dot)), "only tokens with the right signature are accepted");
}

void trySigned(std::string_view text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view claims = end < text.size() ? text.substr(end + 1) : std::string_view();
  const std::string to_sign = access::toBase64Url(text.substr(0, end)) + "." + access::toBase64Url(claims);
  if (const auto grant = verified(to_sign + "." + signatureOf(to_sign))) checkGrant(*grant);
}

void tryKeySet(std::string_view text) {
  const auto keys = access::parseKeySet(text, "keys");
  if (!keys) return checkError(keys.error());
  must(!keys->empty() && keys->size() <= access::kJwtKeyMaxCount, "a set has keys, up to its bound");
  for (const access::JwtKey& key : *keys) {
    const bool is_secret = key.algorithm == access::JwtAlgorithm::kHs256;
    must(is_secret ? key.secret.size() >= access::kJwtSecretMinBytes : key.public_key != nullptr, "a key is complete");
  }
  (void)access::verifyJwt("eyJhbGciOiJSUzI1NiJ9.e30.AAAA", *keys, {}, kNow);
  (void)access::verifyJwt("eyJhbGciOiJFZERTQSJ9.e30.AAAA", *keys, {}, kNow);
}

void tryPem(std::string_view text) {
  if (const auto key = access::parsePublicKey(text, "key"); !key) checkError(key.error());
  if (const auto key = access::parseSecret(text, "key"); !key) checkError(key.error());
}

void tryTokenFile(std::string_view text) {
  const auto access = access::Access::parse(text, "tokens", std::nullopt);
  if (!access) return checkError(access.error());
  (void)access->resolve(text, kNow);
  must(!access->resolve("", kNow), "without guests every client needs a token");
}

}  // namespace
}  // namespace spindrift::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace spindrift;
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data + 1), size - 1);
  switch (data[0] % 5) {
    case 0:
      fuzz::tryToken(text);
      break;
    case 1:
      fuzz::trySigned(text);
      break;
    case 2:
      fuzz::tryKeySet(text);
      break;
    case 3:
      fuzz::tryPem(text);
      break;
    default:
      fuzz::tryTokenFile(text);
      break;
  }
  return 0;
}
