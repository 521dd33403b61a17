#include <algorithm>
#include <cmath>
#include <cstdint>

#include <spindrift/service/drain.h>

namespace spindrift::service {

v1::Draining beginDrain(net::Server& network, std::chrono::milliseconds closes_in, const std::string& go_to) {
  /// A server that is started again can take this many clients per second: handshake, greeting and keyframes.
  constexpr double kReturnsPerS = 200.0;
  constexpr double kRestart_s = 1.0;  // shortest time in which a server comes back
  const double closes_in_s = std::chrono::duration<double>(closes_in).count();
  const double spread_s = static_cast<double>(network.stats().open_session_count) / kReturnsPerS;
  v1::Draining out;
  out.set_closes_in_s(closes_in_s);
  out.set_go_to(go_to);
  out.set_reconnect_after_min_s(go_to.empty() ? closes_in_s + kRestart_s : 0.0);
  out.set_reconnect_after_max_s(go_to.empty() ? closes_in_s + kRestart_s + std::max(0.5, spread_s) : closes_in_s);
  network.drain(std::chrono::seconds(static_cast<std::int64_t>(std::ceil(closes_in_s + kRestart_s))));
  return out;
}

}  // namespace spindrift::service
