#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <spindrift/script/junit.h>
#include <spindrift/script/script.h>

#include "expectations.h"
#include "held_time.h"
#include "script_client.h"

namespace spindrift::script {
namespace {

constexpr double kPatience_s = 5.0;
/// With a held clock, for answers and for the frame of a tick that was made: on a machine of any speed.
constexpr double kHeldPatience_s = 60.0;

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
    if (script.hold_clock()) {
      held_.emplace(holder(), script.seed(),
                    [this](ScriptClient& client, v1::Command command, double within_s, Outcome& why) {
                      return ask(client, std::move(command), within_s, why);
                    });
    }
  }

  ScriptReport run() {
    ScriptReport out;
    out.step_count = script_.steps_size();
    const auto held_begin = Clock::now();
    if (const Outcome begun = beginHeld(); !begun.passed) {
      out.steps.push_back({0, script_.clients(0).name(), "take_clock", "", false, begun.detail, since_s(held_begin)});
      goodbye();
      return out;
    }
    for (int k = 0; k < script_.steps_size(); ++k) {
      const v1::ScriptStep& step = script_.steps(k);
      const auto step_begin = Clock::now();
      Outcome outcome = waitUntil(step.at_s());
      if (outcome.passed) outcome = carryOut(step, *clients_.at(step.client()));
      out.steps.push_back(
          {k, step.client(), describe(step), step.note(), outcome.passed, outcome.detail, since_s(step_begin)});
      if (!outcome.passed && !script_.keep_going()) break;
    }
    out.held = reportHeld();
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

  // Time

  ScriptClient& holder() { return *clients_.at(script_.clients(0).name()); }

  Outcome beginHeld() {
    if (!held_) return {true, ""};
    if (Outcome there = connected(holder()); !there.passed) return there;
    return held_->begin();
  }

  /// Waits until this time since the start, of the script or of the water.
  Outcome waitUntil(double at_s) {
    if (held_) return held_->advanceTo(at_s);
    wait(at_s - since_s(begin_), [] { return false; });
    return {true, ""};
  }

  std::optional<HeldReport> reportHeld() {
    if (!held_) return std::nullopt;
    (void)held_->settle();  // after a failure there may be nobody to do it
    const auto& events = holder().received.event_counts;
    const auto recovered = events.find(v1::ROOM_EVENT_KIND_RECOVERED);
    return HeldReport{.seed = script_.seed(),
                      .tick_count = held_->madeCount(),
                      .made_s = held_->made_s(),
                      .state_hash = held_->hash(),
                      .recovered_count = recovered == events.end() ? 0 : recovered->second};
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

  /// The same for what frames of a layer show, which the client subscribes to: looks at each once, until one shows what
  /// is wanted.
  Outcome awaitFrame(ScriptClient& client, v1::Layer layer, double duration_s, const std::function<Seen()>& look) {
    client.needLayer(layer);
    if (held_) return awaitHeldFrame(client, layer, look);
    std::uint64_t looked_count = 0;
    Seen seen{.is_wanted = false, .what = "no frame of " + v1::Layer_Name(layer)};
    const auto holds = [&] {
      const std::uint64_t frame_count = client.received.tallies[layer].frame_count;
      if (!seen.is_wanted && std::exchange(looked_count, frame_count) != frame_count) seen = look();
      return seen.is_wanted;
    };
    return await(client, duration_s, holds, [&] { return seen.what; });
  }

  /// The same with a held clock: looks at the newest tick only, because no time passes.
  Outcome awaitHeldFrame(ScriptClient& client, v1::Layer layer, const std::function<Seen()>& look) {
    if (Outcome settled = held_->settle(); !settled.passed) return settled;
    const auto is_there = [&] {
      const LayerTally& tally = client.received.tallies[layer];
      return tally.frame_count > 0 && tally.tick >= held_->tick();
    };
    const Outcome there = await(client, kHeldPatience_s, is_there, [] { return std::string(); });
    if (!there.passed) return {false, fmt::format("no frame of tick {}{}", held_->tick(), there.detail)};
    const Seen seen = look();
    return {seen.is_wanted,
            fmt::format("{} at {:.3f} s{}", seen.what, held_->made_s(), seen.is_wanted ? "" : ", out of bounds")};
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
      case v1::ScriptStep::kHash:
        return expectHash(step.hash());
      case v1::ScriptStep::kWait:
        if (held_) return held_->advanceBy(step.wait().duration_s());
        wait(step.wait().duration_s(), [] { return false; });
        return client.end() ? Outcome{false, "the connection ended: " + endOf(client)} : Outcome{true, ""};
      case v1::ScriptStep::kSurface:
        return awaitFrame(client, v1::LAYER_SURFACE, patience_s(step.surface()),
                          [&] { return seenSurface(step.surface(), client.received); });
      case v1::ScriptStep::kGauge:
        return awaitFrame(client, v1::LAYER_DIAGNOSTICS, patience_s(step.gauge()),
                          [&] { return seenGauge(step.gauge(), client.received); });
      case v1::ScriptStep::kBoat:
        return expectBoat(step.boat(), client);
      case v1::ScriptStep::kParticles:
        return awaitFrame(client, v1::LAYER_PARTICLES, patience_s(step.particles()),
                          [&] { return seenParticles(step.particles(), client.received); });
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

  /// Sends a command. Returns its answer, or null with the reason in `why`.
  const v1::ServerMessage* ask(ScriptClient& client, v1::Command command, double within_s, Outcome& why) {
    const std::uint64_t id = client.command(std::move(command));
    const Outcome answered = await(
        client, within_s, [&] { return client.received.answers.contains(id); }, [] { return std::string(); });
    if (answered.passed) return &client.received.answers[id];
    why = {false, "no answer" + answered.detail};
    return nullptr;
  }

  Outcome expectHash(const v1::ExpectHash& step) {
    if (Outcome settled = held_->settle(); !settled.passed) return settled;
    const std::uint64_t hash = *held_->hash();
    std::string detail = fmt::format("{} at {:.3f} s", hashText(hash), held_->made_s());
    const auto same = hashes_.find(step.same_as());
    const std::optional<std::uint64_t> wanted = step.has_is()           ? std::optional(step.is())
                                                : same != hashes_.end() ? std::optional(same->second)
                                                                        : std::nullopt;
    const bool passed = !wanted || *wanted == hash;
    if (!passed) detail += "; wanted " + hashText(*wanted);
    if (!step.save().empty()) hashes_[step.save()] = hash;
    return {passed, std::move(detail)};
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
    Outcome why;
    const double within_s = held_ && !step.has_within_s() ? kHeldPatience_s : patience_s(step);
    const v1::ServerMessage* const answered = ask(client, std::move(command), within_s, why);
    if (!answered) return why;
    const v1::ServerMessage& answer = *answered;
    if (answer.has_ack()) {
      if (held_) held_->commandApplied(answer.ack().applied_tick());
      if (!step.save_boat().empty()) boats_[step.save_boat()] = answer.ack().boat_id();
      const bool wanted = step.rejected() == v1::REJECT_REASON_UNSPECIFIED;
      const std::string hash = answer.ack().has_state_hash() ? ", hash " + hashText(answer.ack().state_hash()) : "";
      return {wanted, fmt::format("applied at tick {}{}{}", answer.ack().applied_tick(), hash,
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

  Outcome expectBoat(const v1::ExpectBoat& step, ScriptClient& client) {
    std::uint32_t boat_id = step.boat_id();
    if (!step.boat().empty()) {
      const auto saved = boats_.find(step.boat());
      if (saved == boats_.end()) return {false, "no boat was saved as \"" + step.boat() + "\""};
      boat_id = saved->second;
    }
    return awaitFrame(client, v1::LAYER_BODIES, patience_s(step),
                      [&] { return seenBoat(step, boat_id, client.received); });
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
  std::map<std::string, std::uint64_t> hashes_;  ///< that were saved
  std::optional<HeldTime> held_;                 ///< with hold_clock
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
