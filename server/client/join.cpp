#include <algorithm>
#include <array>
#include <random>

#include <spindrift/client/join.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::client {

v1::ClientMessage hello(const Identity& identity) {
  v1::ClientMessage message;
  v1::Hello& out = *message.mutable_hello();
  out.mutable_version()->set_major(wire::kWireMajor);
  out.mutable_version()->set_minor(wire::kWireMinor);
  out.set_client(identity.program);
  out.set_name(identity.name);
  out.set_token(identity.token);
  out.set_resume_key(identity.resume_key);
  return message;
}

std::optional<Move> planMove(const v1::Draining& draining, const net::ClientUrl& url) {
  Move move{.url = url, .at = {}};
  if (!draining.go_to().empty()) {
    const auto other = net::ClientUrl::parse(draining.go_to());
    if (!other) return std::nullopt;
    move.url = *other;
    move.url.path = url.path;
  }
  const double range_s = std::max(0.0, draining.reconnect_after_max_s() - draining.reconnect_after_min_s());
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::random_device entropy;
  const double wait_s = std::clamp(draining.reconnect_after_min_s() + range_s * share(entropy), 0.0, 60.0);
  using Clock = std::chrono::steady_clock;
  move.at = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(wait_s));
  return move;
}

bool isFinal(std::uint16_t code, const std::string& reason) {
  constexpr std::array<std::uint16_t, 7> kFinal = {1002, 1003, 1007, 1008, 4401, 4404, 4409};
  if (code != 0) return std::ranges::find(kFinal, code) != kFinal.end();
  return std::ranges::any_of(std::array{"HTTP 400", "HTTP 401", "HTTP 403", "HTTP 404"},
                             [&](const char* status) { return reason.find(status) != std::string::npos; });
}

}  // namespace spindrift::client
