#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <spindrift/codec/frame_decoder.h>
#include <spindrift/script/script.h>

#include "script_client.h"

namespace spindrift::script {
namespace {

constexpr double kPatience_s = 5.0;

/// Result of a step; empty: success.
struct Outcome {
  bool passed = false;
  std::string detail;
};

template <typename Step>
double patience_s(const Step& step) {
  return step.has_within_s() ? step.within_s() : kPatience_s;
}

double quantile(std::vector<double> values, double ratio) {
  if (values.empty()) return 0.0;
  std::ranges::sort(values);
  return values[std::min(values.size() - 1, static_cast<std::size_t>(ratio * static_cast<double>(values.size())))];
}

class Runner {
 public:
  Runner(const v1::Script& script, const net::ClientUrl& url, const std::string& ca_file)
      : script_(script), pool_(net::ClientPool::create(0, ca_file)) {
    for (const v1::ScriptClient& setup : script.clients()) {
      clients_.emplace(setup.name(), std::make_unique<ScriptClient>(setup, *pool_, url));
    }
  }

  ScriptReport run() {
    ScriptReport out;
    out.step_count = script_.steps_size();
    for (int k = 0; k < script_.steps_size(); ++k) {
      const v1::ScriptStep& step = script_.steps(k);
      wait(step.at_s() - since_s(begin_), [] { return false; });
      const auto step_begin = Clock::now();
      const Outcome outcome = carryOut(step, *clients_.at(step.client()));
      out.steps.push_back(
          {k, step.client(), describe(step), step.note(), outcome.passed, outcome.detail, since_s(step_begin)});
      if (!outcome.passed && !script_.keep_going()) break;
    }
    for (const v1::ScriptClient& setup : script_.clients()) out.clients.push_back(reportOf(*clients_.at(setup.name())));
    goodbye();
    return out;
  }

 private:
  static std::string describe(const v1::ScriptStep& step) {
    const auto* descriptor = v1::ScriptStep::descriptor();
    std::string out = descriptor->FindFieldByNumber(static_cast<int>(step.what_case()))->name();
    if (step.has_command()) {
      const auto action = static_cast<int>(step.command().command().action_case());
      out += " " + v1::Command::descriptor()->FindFieldByNumber(action)->name();
    }
    return out;
  }

  /// Lets the clients run until `holds` is true or the time is over; returns whether it became true.
  bool wait(double duration_s, const std::function<bool()>& holds) {
    if (holds()) return true;
    if (duration_s <= 0) return false;
    constexpr std::chrono::milliseconds kLook{20};  // at clients that have to move to another server
    const auto duration =
        std::chrono::milliseconds(static_cast<std::chrono::milliseconds::rep>(std::ceil(1e3 * duration_s)));
    for (const auto end = Clock::now() + duration; !holds() && Clock::now() < end;) {
      for (const auto& [name, client] : clients_) client->followDraining();
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
      pool_->runFor(std::min(kLook, left), holds);
    }
    return holds();
  }

  /// The same for conditions that need the connection, which may end meanwhile.
  Outcome await(ScriptClient& client, double duration_s, const std::function<bool()>& holds,
                const std::function<std::string()>& seen) {
    const bool held = wait(duration_s, [&] { return holds() || client.end(); });
    const bool passed = held && holds();
    std::string detail = seen();
    if (!passed)
      detail += client.end() ? "; the connection ended: " + endOf(client) : fmt::format("; waited {} s", duration_s);
    return {passed, std::move(detail)};
  }

  /// The same for what frames of a layer show, which the client subscribes to: `shows` looks at each once, until one
  /// shows what is wanted.
  Outcome awaitFrame(ScriptClient& client, v1::Layer layer, double duration_s, const std::function<bool()>& shows,
                     const std::function<std::string()>& seen) {
    client.needLayer(layer);
    std::uint64_t looked_count = 0;
    bool has_shown = false;
    const auto holds = [&] {
      const std::uint64_t frame_count = client.received.tallies[layer].frame_count;
      if (!has_shown && std::exchange(looked_count, frame_count) != frame_count) has_shown = shows();
      return has_shown;
    };
    return await(client, duration_s, holds, seen);
  }

  static std::string endOf(const ScriptClient& client) {
    return fmt::format("{} {}", client.lastEnd()->code, client.lastEnd()->reason);
  }

  Outcome connected(ScriptClient& client) {
    if (!client.wasConnected()) client.connect();
    return await(
        client, kConnectPatience_s, [&] { return client.isWelcome(); },
        [&] { return std::string(client.isWelcome() ? "connected" : "not connected"); });
  }

  Outcome carryOut(const v1::ScriptStep& step, ScriptClient& client) {
    if (step.has_closed()) {
      if (!client.wasConnected()) client.connect();
      return expectClosed(step.closed(), client);
    }
    if (step.has_connect()) {
      if (client.wasConnected() && !client.end()) return {false, "is connected already"};
      client.connect();
      return connected(client);
    }
    if (Outcome there = connected(client); !there.passed) return there;
    switch (step.what_case()) {
      case v1::ScriptStep::kCommand:
        return command(step.command(), client);
      case v1::ScriptStep::kSubscribe:
        client.subscribe(step.subscribe());
        return {true, ""};
      case v1::ScriptStep::kWait:
        wait(step.wait().duration_s(), [] { return false; });
        return client.end() ? Outcome{false, "the connection ended: " + endOf(client)} : Outcome{true, ""};
      case v1::ScriptStep::kSurface:
        return expectSurface(step.surface(), client);
      case v1::ScriptStep::kGauge:
        return expectGauge(step.gauge(), client);
      case v1::ScriptStep::kBoat:
        return expectBoat(step.boat(), client);
      case v1::ScriptStep::kParticles:
        return expectParticles(step.particles(), client);
      case v1::ScriptStep::kFrames:
        return expectFrames(step.frames(), client);
      case v1::ScriptStep::kGap:
        return expectGap(step.gap(), client);
      case v1::ScriptStep::kPeople:
        return expectPeople(step.people(), client);
      case v1::ScriptStep::kEvent:
        return expectEvent(step.event(), client);
      case v1::ScriptStep::kDisconnect:
        client.disconnect(step.disconnect().vanish());
        return {wait(kPatience_s, [&] { return client.end().has_value(); }), ""};
      default:
        return {false, "this program does not know this kind of step"};
    }
  }

  Outcome command(const v1::ScriptCommand& step, ScriptClient& client) {
    v1::Command command = step.command();
    if (!step.boat().empty()) {
      const auto saved = boats_.find(step.boat());
      if (saved == boats_.end()) return {false, "no boat was saved as \"" + step.boat() + "\""};
      if (command.has_control_boat()) command.mutable_control_boat()->set_boat_id(saved->second);
      if (command.has_move_boat()) command.mutable_move_boat()->set_boat_id(saved->second);
      if (command.has_take_boat()) command.mutable_take_boat()->set_boat_id(saved->second);
      if (command.has_remove_boat()) command.mutable_remove_boat()->set_boat_id(saved->second);
    }
    const std::uint64_t id = client.command(std::move(command));
    const Outcome answered = await(
        client, patience_s(step), [&] { return client.received.answers.contains(id); }, [] { return std::string(); });
    if (!answered.passed) return {false, "no answer" + answered.detail};
    const v1::ServerMessage& answer = client.received.answers[id];
    if (answer.has_ack()) {
      if (!step.save_boat().empty()) boats_[step.save_boat()] = answer.ack().boat_id();
      const bool wanted = step.rejected() == v1::REJECT_REASON_UNSPECIFIED;
      return {wanted, fmt::format("applied at tick {}{}", answer.ack().applied_tick(),
                                  wanted ? "" : "; wanted " + v1::RejectReason_Name(step.rejected()))};
    }
    const v1::Reject& reject = answer.reject();
    const bool wanted = reject.reason() == step.rejected() &&
                        (step.rejected_field().empty() || reject.field() == step.rejected_field());
    return {wanted, fmt::format("rejected: {} {} {}{}", v1::RejectReason_Name(reject.reason()), reject.field(),
                                reject.message(),
                                wanted ? ""
                                       : "; wanted " + (step.rejected() ? v1::RejectReason_Name(step.rejected()) + " " +
                                                                              step.rejected_field()
                                                                        : std::string("an ack")))};
  }

  Outcome expectSurface(const v1::ExpectSurface& step, ScriptClient& client) {
    std::optional<double> seen_m;
    const auto shows = [&] {
      seen_m = elevation_m(client.received.newest[v1::LAYER_SURFACE], step.x_m(), step.z_m());
      return seen_m && (!step.has_min_m() || *seen_m >= step.min_m()) && (!step.has_max_m() || *seen_m <= step.max_m());
    };
    return awaitFrame(client, v1::LAYER_SURFACE, patience_s(step), shows, [&] {
      return seen_m ? fmt::format("elevation {:.4f} m", *seen_m) : std::string("no surface there");
    });
  }

  static std::optional<double> elevation_m(const v1::LayerFrame& frame, double x_m, double z_m) {
    const auto surface = codec::decodeSurface(frame);
    if (!surface) return std::nullopt;
    const auto index = [](double at_m, double side_m, std::uint32_t count) {
      return static_cast<std::int64_t>(std::floor((at_m / side_m + 0.5) * count));
    };
    const std::int64_t i = index(x_m, surface->length_m, surface->count.x);
    const std::int64_t k = index(z_m, surface->width_m, surface->count.z);
    if (i < 0 || k < 0 || i >= surface->count.x || k >= surface->count.z) return std::nullopt;
    return surface->elevation_m[static_cast<std::size_t>(k * surface->count.x + i)];
  }

  Outcome expectGauge(const v1::ExpectGauge& step, ScriptClient& client) {
    std::string seen = "no diagnostics";
    const auto shows = [&] {
      const auto& gauges = client.received.diagnostics.gauges();
      const auto gauge = std::ranges::find(gauges, step.gauge(), &v1::GaugeReading::name);
      if (gauge == gauges.end()) {
        seen = fmt::format("there is no gauge \"{}\"", step.gauge());
        return false;
      }
      seen = fmt::format("elevation {:.4f} m, highest {:.4f} m, lowest {:.4f} m", gauge->elevation_m(),
                         gauge->highest_m(), gauge->lowest_m());
      return (!step.has_min_m() || gauge->elevation_m() >= step.min_m()) &&
             (!step.has_max_m() || gauge->elevation_m() <= step.max_m()) &&
             (!step.has_highest_min_m() || gauge->highest_m() >= step.highest_min_m()) &&
             (!step.has_highest_max_m() || gauge->highest_m() <= step.highest_max_m()) &&
             (!step.has_lowest_min_m() || gauge->lowest_m() >= step.lowest_min_m()) &&
             (!step.has_lowest_max_m() || gauge->lowest_m() <= step.lowest_max_m());
    };
    return awaitFrame(client, v1::LAYER_DIAGNOSTICS, patience_s(step), shows, [&] { return seen; });
  }

  Outcome expectBoat(const v1::ExpectBoat& step, ScriptClient& client) {
    std::uint32_t boat_id = step.boat_id();
    if (!step.boat().empty()) {
      const auto saved = boats_.find(step.boat());
      if (saved == boats_.end()) return {false, "no boat was saved as \"" + step.boat() + "\""};
      boat_id = saved->second;
    }
    std::string seen = "no frame of the boats";
    const auto shows = [&] {
      const auto bodies = codec::decodeBodies(client.received.newest[v1::LAYER_BODIES]);
      if (!bodies) return false;
      const auto boat = std::ranges::find(*bodies, boat_id, &codec::BodySample::boat_id);
      if (boat == bodies->end()) {
        seen = fmt::format("boat {} is not on the water", boat_id);
        return false;
      }
      const double x_m = boat->position_m[0];
      const double z_m = boat->position_m[2];
      seen = fmt::format("boat {} at {:.2f}, {:.2f} m", boat_id, x_m, z_m);
      return !step.has_radius_m() || std::hypot(x_m - step.x_m(), z_m - step.z_m()) <= step.radius_m();
    };
    return awaitFrame(client, v1::LAYER_BODIES, patience_s(step), shows, [&] { return seen; });
  }

  Outcome expectParticles(const v1::ExpectParticles& step, ScriptClient& client) {
    std::uint32_t count = 0;
    const auto shows = [&] {
      const v1::LayerFrame& frame = client.received.newest[v1::LAYER_PARTICLES];
      count = frame.has_particles_fixed12() ? frame.particles_fixed12().count() : frame.particles_by_cell().count();
      return count >= step.min_count() && (!step.has_max_count() || count <= step.max_count());
    };
    return awaitFrame(client, v1::LAYER_PARTICLES, patience_s(step), shows, [&] {
      const bool has_frame = client.received.newest.contains(v1::LAYER_PARTICLES);
      return has_frame ? fmt::format("{} particles", count) : std::string("no frame of the particles");
    });
  }

  Outcome expectFrames(const v1::ExpectFrames& step, ScriptClient& client) {
    const std::uint64_t before_count = client.received.tallies[step.layer()].frame_count;
    const auto came = [&] { return client.received.tallies[step.layer()].frame_count - before_count; };
    return await(
        client, patience_s(step), [&] { return came() >= step.min_count(); },
        [&] { return fmt::format("{} frames", came()); });
  }

  Outcome expectGap(const v1::ExpectGap& step, ScriptClient& client) {
    const double longest_s = client.takeLongestGap_s(step.layer());
    const bool passed = longest_s <= step.longest_s();
    return {passed, fmt::format("longest gap {:.3f} s{}", longest_s,
                                passed ? "" : fmt::format("; wanted at most {} s", step.longest_s()))};
  }

  Outcome expectPeople(const v1::ExpectPeople& step, ScriptClient& client) {
    const auto count = [&] {
      return std::ranges::count_if(client.received.people.people(),
                                   [](const v1::Person& person) { return !person.away(); });
    };
    return await(
        client, patience_s(step), [&] { return count() == step.count(); },
        [&] { return fmt::format("{} people", count()); });
  }

  Outcome expectEvent(const v1::ExpectEvent& step, ScriptClient& client) {
    // Counts events since the previous step of this kind for this client: they may arrive before this step begins.
    std::uint64_t& used_count = used_events_[{client.name(), step.kind()}];
    Outcome out = await(
        client, patience_s(step), [&] { return client.received.event_counts[step.kind()] > used_count; },
        [&] { return v1::RoomEventKind_Name(step.kind()); });
    if (out.passed) ++used_count;
    return out;
  }

  Outcome expectClosed(const v1::ExpectClosed& step, ScriptClient& client) {
    if (!wait(patience_s(step), [&] { return client.lastEnd().has_value(); }))
      return {false, "the connection is still open"};
    const bool passed = step.code() == 0 || client.lastEnd()->code == step.code();
    return {passed, endOf(client) + (passed ? "" : fmt::format("; wanted {}", step.code()))};
  }

  void goodbye() {
    for (const auto& [name, client] : clients_) client->disconnect(false);
    wait(kGoodbyePatience_s, [&] {
      return std::ranges::all_of(clients_, [](const auto& c) { return !c.second->wasConnected() || c.second->end(); });
    });
  }

  static ClientReport reportOf(const ScriptClient& client) {
    const Received& received = client.received;
    ClientReport out{.name = client.name(),
                     .received_bytes = received.byte_count,
                     .malformed_count = received.malformed_count,
                     .layers = {},
                     .answer_count = received.answer_times_ms.size(),
                     .answer_p50_ms = quantile(received.answer_times_ms, 0.5),
                     .answer_p99_ms = quantile(received.answer_times_ms, 0.99)};
    for (const auto& [layer, tally] : received.tallies) {
      if (layer != v1::LAYER_UNSPECIFIED && tally.frame_count > 0)
        out.layers.push_back({v1::Layer_Name(layer), tally.frame_count, tally.state_count, tally.longest_gap_ever_s});
    }
    return out;
  }

  static constexpr double kConnectPatience_s = 15.0;
  static constexpr double kGoodbyePatience_s = 2.0;

  const v1::Script& script_;
  std::unique_ptr<net::ClientPool> pool_;  // declared first: must outlive the clients
  std::map<std::string, std::unique_ptr<ScriptClient>> clients_;
  std::map<std::string, std::uint32_t> boats_;
  std::map<std::pair<std::string, v1::RoomEventKind>, std::uint64_t> used_events_;
  const Clock::time_point begin_ = Clock::now();
};

}  // namespace

bool ScriptReport::passed() const {
  return static_cast<int>(steps.size()) == step_count && std::ranges::all_of(steps, &StepReport::passed);
}

ScriptReport runScript(const v1::Script& script, const net::ClientUrl& url, const std::string& ca_file) {
  return Runner(script, url, ca_file).run();
}

}  // namespace spindrift::script
