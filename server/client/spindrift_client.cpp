#include <exception>
#include <memory>
#include <new>
#include <string>
#include <utility>

#include <spindrift_client.h>

#include "session.h"

using spindrift::client::Clock;
using spindrift::client::Outcome;
using spindrift::client::Points;
using spindrift::client::PointsAnswer;
using spindrift::client::Session;
namespace v1 = spindrift::v1;

struct spindrift_room {
  explicit spindrift_room(Session::Options options) : session(std::move(options)) {}
  Session session;
};

namespace {

constexpr double kAnswerWithin_s = 10.0;
constexpr double kPatienceMax_s = 86'400.0;
constexpr std::uint32_t kIntervalMax_ticks = 3600;
constexpr std::uint32_t kStepMax_ticks = 600;

std::string& lastError() {
  thread_local std::string text;
  return text;
}

/// Runs a call and keeps the text of its failure; no exception leaves the library.
template <typename Call>
spindrift_status guarded(Call&& call) noexcept {
  try {
    Outcome outcome = call();
    if (outcome.status != SPINDRIFT_OK) lastError() = std::move(outcome.text);
    return outcome.status;
  } catch (const std::bad_alloc&) {
    lastError().clear();
    return SPINDRIFT_NO_MEMORY;
  } catch (const std::exception& error) {
    try {
      lastError() = error.what();
    } catch (...) {
    }
    return SPINDRIFT_NO_MEMORY;
  }
}

Outcome badArgument(const std::string& text) {
  return {SPINDRIFT_BAD_ARGUMENT, text};
}

bool isPatience(double seconds) {
  return seconds >= 0.0 && seconds <= kPatienceMax_s;
}

Clock::duration durationOf(double seconds) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

std::string textOf(const char* text) {
  return text == nullptr ? "" : text;
}

Points pointsOf(const float* x_m, const float* z_m, size_t count) {
  return {{x_m, x_m + count}, {z_m, z_m + count}};
}

std::string countText(size_t count) {
  return "count " + std::to_string(count) + ": expected 1 to " + std::to_string(SPINDRIFT_MAX_POINTS) + " points";
}

void write(const PointsAnswer& answer, spindrift_moment* moment, spindrift_sample* samples, size_t count) {
  if (moment != nullptr) *moment = answer.moment;
  const v1::QueryResult& values = answer.values;
  if (static_cast<size_t>(values.elevation_m_size()) != count) return;
  const auto at = [](const google::protobuf::RepeatedField<float>& field, int k) {
    return k < field.size() ? field[k] : 0.0f;
  };
  for (int k = 0; k < static_cast<int>(count); ++k) {
    samples[k] = {at(values.elevation_m(), k),    at(values.vertical_speed_mps(), k),
                  at(values.velocity_x_mps(), k), at(values.velocity_z_mps(), k),
                  at(values.slope_x(), k),        at(values.slope_z(), k),
                  at(values.depth_m(), k),        at(values.wet_ratio(), k),
                  at(values.foam_ratio(), k),     0};
  }
  for (const std::uint32_t outside : values.outside()) {
    if (outside < count) samples[outside].outside = 1;
  }
}

}  // namespace

const char* spindrift_error(void) {
  return lastError().c_str();
}

spindrift_status spindrift_connect(const spindrift_options* options, double patience_s, spindrift_room** room) {
  return guarded([&]() -> Outcome {
    if (options == nullptr || room == nullptr) return badArgument("options and room have to be given");
    *room = nullptr;
    if (!isPatience(patience_s))
      return badArgument("patience_s " + std::to_string(patience_s) + ": expected 0 to 86400");
    const double within_s = options->answer_within_s == 0.0 ? kAnswerWithin_s : options->answer_within_s;
    if (!isPatience(within_s))
      return badArgument("answer_within_s " + std::to_string(within_s) + ": expected 0 to 86400");
    std::string url = textOf(options->url);
    if (url.starts_with("http")) url.replace(0, 4, "ws");
    const auto parsed = spindrift::net::ClientUrl::parse(url);
    if (!parsed) return badArgument("url '" + textOf(options->url) + "': expected http://HOST:PORT");
    auto made = std::make_unique<spindrift_room>(Session::Options{.url = parsed->inRoom(textOf(options->room)),
                                                                  .identity = {.program = "spindrift C library",
                                                                               .name = textOf(options->name),
                                                                               .token = textOf(options->token),
                                                                               .resume_key = ""},
                                                                  .ca_file = textOf(options->ca_file),
                                                                  .answer_within = durationOf(within_s)});
    Outcome outcome = made->session.waitJoined(durationOf(patience_s));
    if (outcome.status == SPINDRIFT_OK) *room = made.release();
    return outcome;
  });
}

void spindrift_disconnect(spindrift_room* room) {
  delete room;
}

spindrift_status spindrift_state(spindrift_room* room) {
  return guarded([&] { return room->session.state(); });
}

uint64_t spindrift_connection_count(spindrift_room* room) {
  return room->session.connectionCount();
}

spindrift_status spindrift_query(spindrift_room* room, const float* x_m, const float* z_m, size_t count,
                                 spindrift_moment* moment, spindrift_sample* samples) {
  return guarded([&]() -> Outcome {
    if (count == 0 || count > SPINDRIFT_MAX_POINTS) return badArgument(countText(count));
    if (x_m == nullptr || z_m == nullptr || samples == nullptr)
      return badArgument("x_m, z_m and samples have to be given");
    PointsAnswer answer;
    Outcome outcome = room->session.query(pointsOf(x_m, z_m, count), answer);
    if (outcome.status == SPINDRIFT_OK) write(answer, moment, samples, count);
    return outcome;
  });
}

spindrift_status spindrift_follow(spindrift_room* room, const float* x_m, const float* z_m, size_t count,
                                  uint32_t interval_ticks) {
  return guarded([&]() -> Outcome {
    if (count == 0) return room->session.follow({}, 1);
    if (count > SPINDRIFT_MAX_POINTS) return badArgument(countText(count));
    if (x_m == nullptr || z_m == nullptr) return badArgument("x_m and z_m have to be given");
    if (interval_ticks == 0 || interval_ticks > kIntervalMax_ticks)
      return badArgument("interval_ticks " + std::to_string(interval_ticks) + ": expected 1 to 3600");
    return room->session.follow(pointsOf(x_m, z_m, count), interval_ticks);
  });
}

spindrift_status spindrift_newest(spindrift_room* room, uint64_t after, double patience_s, spindrift_moment* moment,
                                  spindrift_sample* samples, size_t count) {
  return guarded([&]() -> Outcome {
    if (samples == nullptr) return badArgument("samples have to be given");
    if (!isPatience(patience_s))
      return badArgument("patience_s " + std::to_string(patience_s) + ": expected 0 to 86400");
    PointsAnswer answer;
    Outcome outcome = room->session.newest(after, durationOf(patience_s), count, answer);
    if (outcome.status != SPINDRIFT_BAD_ARGUMENT) write(answer, moment, samples, count);
    return outcome;
  });
}

spindrift_status spindrift_take_clock(spindrift_room* room, double speed, double timeout_s) {
  return guarded([&] {
    v1::Command command;
    command.mutable_take_clock()->set_speed(speed);
    command.mutable_take_clock()->set_timeout_s(timeout_s);
    v1::Ack ack;
    return room->session.command(std::move(command), ack);
  });
}

spindrift_status spindrift_step(spindrift_room* room, uint32_t tick_count, uint64_t* tick, uint64_t* state_hash) {
  return guarded([&]() -> Outcome {
    if (tick_count == 0 || tick_count > kStepMax_ticks)
      return badArgument("tick_count " + std::to_string(tick_count) + ": expected 1 to 600");
    v1::Command command;
    command.mutable_step()->set_tick_count(tick_count);
    command.mutable_step()->set_waits(true);
    v1::Ack ack;
    Outcome outcome = room->session.command(std::move(command), ack, true);
    if (outcome.status != SPINDRIFT_OK) return outcome;
    if (tick != nullptr) *tick = ack.applied_tick();
    if (state_hash != nullptr) *state_hash = ack.state_hash();
    return outcome;
  });
}

spindrift_status spindrift_release_clock(spindrift_room* room) {
  return guarded([&] {
    v1::Command command;
    command.mutable_release_clock();
    v1::Ack ack;
    return room->session.command(std::move(command), ack);
  });
}
