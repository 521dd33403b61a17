// Bystanders and commands of a storm. Long because it holds the clients of every kind of storm.
#include "storm.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <random>

#include <spindrift/net/client.h>

namespace spindrift::test {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

core::SharedBytes bytesOf(const v1::ClientMessage& message) {
  core::Bytes out(message.ByteSizeLong());
  message.SerializeWithCachedSizesToArray(out.data());
  return core::share(std::move(out));
}

core::SharedBytes helloOf(const std::string& token) {
  v1::ClientMessage message;
  message.mutable_hello()->mutable_version()->set_major(1);
  message.mutable_hello()->mutable_version()->set_minor(1);
  message.mutable_hello()->set_token(token);
  return bytesOf(message);
}

double seconds(Clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

/// Watches every layer, splashes four times per second, and records late frames and answers.
class Bystander {
 public:
  Bystander(net::ClientPool& pool, const net::ClientUrl& url, const std::string& token) {
    client_ = pool.connect(url, {},
                           {.opened = [this, token] { greet(token); },
                            .message = [this](core::ByteView bytes) { see(bytes); },
                            .closed =
                                [this](std::uint16_t code, const std::string& reason) {
                                  const std::lock_guard lock(mutex_);
                                  loss_ = std::to_string(code) + " " + reason;
                                }});
  }

  /// Gaps count from here on.
  void begin(Clock::time_point now) {
    const std::lock_guard lock(mutex_);
    last_frame_ = now;
    measures_ = true;
  }
  void splash(Clock::time_point now) {
    v1::ClientMessage message;
    {
      const std::lock_guard lock(mutex_);
      message.mutable_command()->set_command_id(++last_command_id_);
      waiting_[last_command_id_] = now;
    }
    message.mutable_command()->mutable_splash()->set_depth_m(0.05);
    message.mutable_command()->mutable_splash()->set_radius_m(0.5);
    (void)client_->send(bytesOf(message));
  }
  [[nodiscard]] std::size_t waitingCount() const {
    const std::lock_guard lock(mutex_);
    return loss_.empty() ? waiting_.size() : 0;
  }
  void report(StormReport& out, Clock::time_point end) {
    const std::lock_guard lock(mutex_);
    if (!loss_.empty()) {
      if (out.lost_count++ == 0) out.first_loss = loss_;
      return;
    }
    out.unanswered_count += waiting_.size();
    out.fewest_frames = std::min(out.fewest_frames, frame_count_);
    out.longest_gap_s = std::max({out.longest_gap_s, longest_gap_s_, seconds(end - last_frame_)});
    out.answers_s.insert(out.answers_s.end(), answers_s_.begin(), answers_s_.end());
  }

 private:
  void greet(const std::string& token) {
    (void)client_->send(helloOf(token));
    for (const v1::Layer layer :
         {v1::LAYER_SURFACE, v1::LAYER_PARTICLES, v1::LAYER_FOAM, v1::LAYER_BODIES, v1::LAYER_DIAGNOSTICS}) {
      v1::ClientMessage message;
      message.mutable_subscribe()->set_layer(layer);
      message.mutable_subscribe()->set_max_rate_hz(20.0);
      message.mutable_subscribe()->set_packing(v1::PACKING_PACKED);
      (void)client_->send(bytesOf(message));
    }
  }

  void see(core::ByteView bytes) {
    const auto now = Clock::now();
    v1::ServerMessage message;
    if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) return;
    const std::lock_guard lock(mutex_);
    if (message.has_frame() && measures_) {
      ++frame_count_;
      longest_gap_s_ = std::max(longest_gap_s_, seconds(now - last_frame_));
      last_frame_ = now;
    }
    if (!message.has_ack() && !message.has_reject()) return;
    const auto id = message.has_ack() ? message.ack().command_id() : message.reject().command_id();
    if (const auto sent = waiting_.extract(id)) answers_s_.push_back(seconds(now - sent.mapped()));
  }

  mutable std::mutex mutex_;
  std::shared_ptr<net::Client> client_;
  std::string loss_;
  bool measures_ = false;
  std::uint64_t frame_count_ = 0;
  double longest_gap_s_ = 0.0;
  Clock::time_point last_frame_{};
  std::uint64_t last_command_id_ = 0;
  std::map<std::uint64_t, Clock::time_point> waiting_;
  std::vector<double> answers_s_;
};

/// One hostile client; it connects again after it was disconnected.
class Visitor {
 public:
  Visitor(net::ClientPool& pool, net::ClientUrl url, Attacker attacker, std::uint32_t seed)
      : pool_(pool), url_(std::move(url)), attacker_(std::move(attacker)), random_(seed) {
    connect();
  }

  /// Sends what is due now; returns the number of messages.
  std::uint64_t act(Clock::time_point now) {
    if (now < next_ || !is_open_) {
      if (is_closed_.exchange(false)) connect();
      return 0;
    }
    next_ = now + interval();
    switch (attacker_.attack) {
      case Attack::kSpeedBursts:
        for (int k = 0; k < 300; ++k) {
          v1::Command command;
          command.mutable_set_speed()->set_speed(0.5 + 0.001 * k);
          send(command);
        }
        return 300;
      case Attack::kConnections:
        if (upTo(2) == 0)
          client_->vanish();
        else
          client_->close();
        return 1;
      case Attack::kBytes: {
        core::Bytes bytes(upTo(400));
        for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random_());
        (void)client_->send(core::share(std::move(bytes)));
        return 1;
      }
      default:
        send(next());
        return 1;
    }
  }

  std::uint64_t closedCount() const { return closed_count_; }

 private:
  void connect() {
    is_open_ = false;
    const bool says_hello = attacker_.attack != Attack::kConnections || upTo(2) == 0;
    client_ = pool_.connect(url_, {},
                            {.opened =
                                 [this, says_hello] {
                                   if (says_hello) (void)client_->send(helloOf(attacker_.token));
                                   is_open_ = true;
                                 },
                             .message = [this](core::ByteView bytes) { see(bytes); },
                             .closed =
                                 [this](std::uint16_t, const std::string&) {
                                   ++closed_count_;
                                   is_open_ = false;
                                   is_closed_ = true;
                                 }});
  }

  /// Reads from the greeting what it can attack.
  void see(core::ByteView bytes) {
    v1::ServerMessage message;
    if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) return;
    const std::lock_guard lock(mutex_);
    if (message.has_greeting()) {
      parameters_.assign(message.greeting().parameters().begin(), message.greeting().parameters().end());
      // Not the frame rate: a room that is set to one frame per second obeys.
      std::erase_if(parameters_, [](const auto& known) { return known.path() == "stream.frame_rate_hz"; });
      scenes_.assign(message.greeting().scenes().begin(), message.greeting().scenes().end());
    }
    if (message.has_ack() && message.ack().boat_id() != 0) last_boat_id_ = message.ack().boat_id();
  }

  Clock::duration interval() {
    switch (attacker_.attack) {
      case Attack::kSpeedBursts:
        return 1s;
      case Attack::kScenes:
      case Attack::kParticleCount:
      case Attack::kConnections:
        return 100ms;
      case Attack::kBytes:
        return 50ms;
      default:
        return 5263us;  // 190 per second
    }
  }

  v1::Command next() {
    switch (attacker_.attack) {
      case Attack::kResets:
        return reset();
      case Attack::kScenes:
        return scene();
      case Attack::kParameters:
        return parameter();
      case Attack::kParticleCount:
        return particleCount();
      case Attack::kBoats:
        return boat();
      default:
        switch (upTo(12)) {
          case 0:
            return reset();
          case 1:
            return upTo(20) == 0 ? scene() : parameter();
          case 2:
            return upTo(20) == 0 ? particleCount() : parameter();
          case 3:
            return time();
          case 4:
          case 5:
            return boat();
          case 6:
            return wave();
          default:
            return splash();
        }
    }
  }

  static v1::Command reset() {
    v1::Command out;
    out.mutable_reset();
    return out;
  }
  v1::Command scene() {
    v1::Command out;
    const std::lock_guard lock(mutex_);
    out.mutable_change_scene()->set_name(scenes_.empty() ? "?" : scenes_[upTo(scenes_.size())]);
    return out;
  }
  v1::Command parameter() {
    v1::Command out;
    const std::lock_guard lock(mutex_);
    if (parameters_.empty()) return reset();
    const auto& chosen = parameters_[upTo(parameters_.size())];
    out.mutable_set_parameter()->set_path(chosen.path());
    out.mutable_set_parameter()->set_value(chosen.step() >= 1 ? std::round(between(chosen.min(), chosen.max()))
                                                              : between(chosen.min(), chosen.max()));
    return out;
  }
  v1::Command particleCount() {
    v1::Command out;
    out.mutable_set_parameter()->set_path("particles.count");
    out.mutable_set_parameter()->set_value(upTo(2) == 0 ? 200'000 : std::round(between(1, 20'000)));
    return out;
  }
  v1::Command time() {
    v1::Command out;
    const auto kind = upTo(3);
    if (kind == 0) out.mutable_set_paused()->set_paused(upTo(2) == 0);
    if (kind == 1) out.mutable_set_speed()->set_speed(between(0.1, 4.0));
    if (kind == 2) out.mutable_step()->set_tick_count(static_cast<std::uint32_t>(1 + upTo(600)));
    return out;
  }
  v1::Command boat() {
    v1::Command out;
    const std::lock_guard lock(mutex_);
    const auto kind = upTo(4);
    if (kind == 0) {
      out.mutable_spawn_boat()->mutable_boat()->set_x_m(between(-10, 10));
      out.mutable_spawn_boat()->mutable_boat()->set_z_m(between(-10, 10));
    }
    if (kind == 1) out.mutable_take_boat()->set_boat_id(static_cast<std::uint32_t>(upTo(20)));
    if (kind == 2) {
      out.mutable_control_boat()->set_boat_id(last_boat_id_);
      out.mutable_control_boat()->set_throttle_ratio(between(-1, 1));
      out.mutable_control_boat()->set_rudder_ratio(between(-1, 1));
    }
    if (kind == 3) out.mutable_remove_boat()->set_boat_id(last_boat_id_);
    return out;
  }
  v1::Command splash() {
    v1::Command out;
    out.mutable_splash()->set_x_m(between(-10, 10));
    out.mutable_splash()->set_z_m(between(-10, 10));
    out.mutable_splash()->set_radius_m(between(0.2, 3));
    out.mutable_splash()->set_depth_m(between(0.05, 2));
    return out;
  }
  v1::Command wave() {
    v1::Command out;
    out.mutable_breaking_wave()->set_amplitude_m(between(0.05, 2));
    out.mutable_breaking_wave()->set_length_m(between(0.5, 10));
    return out;
  }

  void send(v1::Command command) {
    v1::ClientMessage message;
    *message.mutable_command() = std::move(command);
    message.mutable_command()->set_command_id(++last_command_id_);
    (void)client_->send(bytesOf(message));
  }
  std::size_t upTo(std::size_t count) { return random_() % count; }
  double between(double low, double high) { return low + (high - low) * std::generate_canonical<double, 53>(random_); }

  net::ClientPool& pool_;
  const net::ClientUrl url_;
  const Attacker attacker_;
  std::mt19937 random_;  ///< of the thread that calls act()
  std::shared_ptr<net::Client> client_;
  std::atomic<bool> is_open_ = false;
  std::atomic<bool> is_closed_ = false;
  std::atomic<std::uint64_t> closed_count_ = 0;
  Clock::time_point next_{};
  std::uint64_t last_command_id_ = 0;
  std::mutex mutex_;
  std::vector<v1::ParameterDescription> parameters_;
  std::vector<std::string> scenes_;
  std::uint32_t last_boat_id_ = 0;
};

net::ClientUrl urlOf(const StormOptions& options, const std::string& room) {
  return *net::ClientUrl::parse("ws://127.0.0.1:" + std::to_string(options.port) + "/ws/" + room);
}

}  // namespace

StormReport runStorm(const StormOptions& options) {
  constexpr auto kStormPatience = 60s;
  constexpr auto kSplashInterval = 250ms;
  // Callbacks run only inside runFor(); clients must be destroyed before their pools.
  const auto watching = net::ClientPool::create(0);
  const auto attacking = net::ClientPool::create(0);
  std::vector<std::unique_ptr<Bystander>> bystanders;
  std::vector<std::unique_ptr<Visitor>> visitors;
  const auto turn = [&](std::chrono::milliseconds time) {
    watching->runFor(time, [] { return false; });
    attacking->runFor(1ms, [] { return false; });
  };
  for (const std::string& room : options.rooms) {
    for (std::size_t k = 0; k < options.bystander_count; ++k)
      bystanders.push_back(std::make_unique<Bystander>(*watching, urlOf(options, room), options.bystander_token));
  }
  const auto settled = Clock::now() + 1s;
  while (Clock::now() < settled) turn(5ms);
  for (const Attacker& attacker : options.attackers) {
    visitors.push_back(std::make_unique<Visitor>(*attacking, urlOf(options, options.rooms.front()), attacker,
                                                 options.seed + static_cast<std::uint32_t>(visitors.size())));
  }
  StormReport out;
  const auto start = Clock::now();
  const auto stop = start + std::chrono::duration_cast<Clock::duration>(options.duration);
  for (const auto& one : bystanders) one->begin(start);
  auto next_splash = start;
  std::size_t splasher = 0;
  for (auto now = start; now < stop; now = Clock::now()) {
    if (now >= next_splash) {
      next_splash += kSplashInterval / bystanders.size();
      bystanders[splasher++ % bystanders.size()]->splash(now);
    }
    for (const auto& one : visitors) out.attack_count += one->act(now);
    turn(1ms);
  }
  const auto end = Clock::now();
  out.fewest_frames = UINT64_MAX;
  // The last requests may still be answered.
  while (Clock::now() < end + kStormPatience &&
         std::ranges::any_of(bystanders, [](const auto& one) { return one->waitingCount() > 0; }))
    turn(5ms);
  for (const auto& one : bystanders) one->report(out, end);
  for (const auto& one : visitors) out.attackers_closed_count += one->closedCount();
  std::ranges::sort(out.answers_s);
  return out;
}

}  // namespace spindrift::test
