// One client of the soak: decides at random what to do next, and checks what it receives.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <spindrift/bench/soak.h>
#include <spindrift/codec/frame_decoder.h>
#include <spindrift/net/client.h>

#include "soak_tally.h"

namespace spindrift::bench {

/// What all clients share.
struct SoakCrowd {
  using Clock = std::chrono::steady_clock;

  /// Adds to the present interval and, unless `measured` is false, to the total.
  template <typename Change>
  void count(Change change, bool measured = true) {
    change(interval);
    if (measures && measured) change(total);
  }
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
  std::size_t below(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(random); }
  /// Time until something happens that happens so often; a day if never.
  Clock::duration untilNext(double per_s);

  const SoakOptions& options;
  std::vector<net::ClientUrl> urls;
  std::unique_ptr<net::ClientPool> pool;
  std::mt19937 random;
  SoakTally total;
  SoakTally interval;
  bool measures = false;
};

class SoakClient {
 public:
  using Clock = SoakCrowd::Clock;

  /// `is_witness`: decodes its frames.
  SoakClient(SoakCrowd& crowd, bool is_witness, Clock::time_point first_try)
      : crowd_(crowd), is_witness_(is_witness), try_at_(first_try) {}

  /// Does what is due.
  void turn(Clock::time_point now);
  [[nodiscard]] bool isOpen() const { return is_open_; }

 private:
  struct Sent {
    Clock::time_point at;
    bool is_heavy = false;
    bool is_measured = false;  ///< not in the warm-up: the answer counts as the command does
  };

  void connect();
  void opened();
  void ended(int code);
  void leave(Clock::time_point now);
  void take(core::ByteView bytes);
  void takeGreeting(const v1::Greeting& greeting);
  void takeAnswer(std::uint64_t command_id, const v1::ServerMessage& message);
  void checkFrame(const v1::LayerFrame& frame);
  void checkDiagnostics(const v1::Diagnostics& diagnostics);

  void subscribe(v1::Layer layer, double rate_hz, v1::Level level, v1::Packing packing, bool adapts);
  void changeLevel();
  void sendWave();
  void beginStroke(Clock::time_point now);
  void continueStroke(Clock::time_point now);
  void launchOrRemoveBoat();
  void steer();
  void send(v1::ClientMessage message, bool is_heavy);
  void giveUpAnswers(Clock::time_point now);

  SoakCrowd& crowd_;
  const bool is_witness_;
  std::shared_ptr<net::Client> client_;
  std::string room_path_;
  bool was_open_ = false;
  bool is_open_ = false;
  bool is_greeted_ = false;
  bool leaves_ = false;
  bool comes_back_ = false;  ///< as the same person
  std::string resume_key_;
  Clock::time_point try_at_;
  Clock::time_point leave_at_;
  Clock::time_point next_stroke_;
  Clock::time_point next_wave_;
  Clock::time_point next_point_;
  Clock::time_point next_boat_;
  Clock::time_point next_steering_;
  Clock::time_point next_level_;
  int points_left_ = 0;
  Clock::time_point last_frame_;  ///< time of the last frame on this connection; zero before the first
  std::uint32_t stroke_id_ = 0;
  double stroke_x_m_ = 0.0;
  double stroke_z_m_ = 0.0;
  double stroke_dx_m_ = 0.0;
  double stroke_dz_m_ = 0.0;
  double half_x_m_ = 1.0;  ///< of the part of the water where it acts
  double half_z_m_ = 1.0;
  std::size_t boat_max_count_ = 0;
  std::uint32_t boat_ = 0;         ///< its own; 0: none
  std::set<std::uint32_t> boats_;  ///< all in the room
  std::uint64_t last_command_ = 0;
  std::map<std::uint64_t, Sent> waiting_;
  codec::PackedSurfaceDecoder surface_;
  codec::PackedFoamDecoder foam_;
  codec::PackedFloaterDecoder floaters_;
};

}  // namespace spindrift::bench
