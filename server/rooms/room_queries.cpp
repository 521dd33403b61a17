#include <algorithm>
#include <utility>

#include <spindrift/rooms/room_queries.h>

namespace spindrift::rooms {
namespace {

/// Adds the values of the points first to first + count.
void addValues(const sim::SurfaceSamples& from, std::size_t first, std::size_t count, v1::QueryResult& out) {
  const auto add = [&](google::protobuf::RepeatedField<float>& field, float sim::SurfaceSample::*value) {
    field.Reserve(static_cast<int>(count));
    for (std::size_t k = first; k < first + count; ++k) field.AddAlreadyReserved(from.samples[k].*value);
  };
  using Sample = sim::SurfaceSample;
  add(*out.mutable_elevation_m(), &Sample::elevation_m);
  add(*out.mutable_vertical_speed_mps(), &Sample::vertical_speed_mps);
  add(*out.mutable_velocity_x_mps(), &Sample::velocity_x_mps);
  add(*out.mutable_velocity_z_mps(), &Sample::velocity_z_mps);
  add(*out.mutable_slope_x(), &Sample::slope_x);
  add(*out.mutable_slope_z(), &Sample::slope_z);
  add(*out.mutable_depth_m(), &Sample::depth_m);
  add(*out.mutable_wet_ratio(), &Sample::wet_ratio);
  add(*out.mutable_foam_ratio(), &Sample::foam_ratio);
  const auto begin = std::ranges::lower_bound(from.outside, first);
  for (auto k = begin; k != from.outside.end() && *k < first + count; ++k)
    out.add_outside(static_cast<std::uint32_t>(*k - first));
}

/// The answers of a room at one time: one per sender.
class Answers {
 public:
  /// Returns the result of a query to fill in.
  v1::QueryResult& add(const SurfaceQuery& query) {
    auto known = std::ranges::find_if(answers_, [&](const auto& one) {
      return one.first.session_id == query.sender.session_id && one.first.request_id == query.sender.request_id;
    });
    if (known == answers_.end()) known = answers_.insert(known, {query.sender, v1::QueryAnswer()});
    v1::QueryResult& out = *known->second.add_results();
    out.set_query_id(query.asked.query_id());
    return out;
  }
  void send(RoomData& room, std::uint64_t tick, double time_s, std::uint64_t state_id) {
    for (auto& [sender, answer] : answers_) {
      answer.set_tick(tick);
      answer.set_time_s(time_s);
      answer.set_state_id(state_id);
      room.outlets.queryAnswered(room.self, sender, answer);
    }
  }

 private:
  std::vector<std::pair<core::Sender, v1::QueryAnswer>> answers_;
};

}  // namespace

void RoomQueries::sample(QueryBook::Which which) {
  if (room_.queries.isEmpty()) return;
  sim::WaterSim& sim = room_.water->sim();
  const std::uint64_t tick = room_.water->tick();
  const std::vector<sim::SurfacePoint> points = room_.queries.points(which, tick, sim.derived().tick_s);
  if (points.empty()) return;
  const auto begun = sim.sampleAt(points, last_number_ + 1);
  if (!begun) return endAll(begun.error().message);
  if (!*begun) return;
  batches_.push_back({.number = ++last_number_,
                      .tick = tick,
                      .time_s = sim.time_s(),
                      .state_id = room_.water->stateId(),
                      .taken = room_.queries.take(which, tick)});
}

void RoomQueries::handOver() {
  if (batches_.empty()) return;
  for (const sim::SurfaceSamples& samples : room_.water->sim().takeSamples()) {
    // What the device has lost is asked again.
    for (; batches_.front().number != samples.number; batches_.pop_front())
      room_.queries.putBack(std::move(batches_.front().taken));
    answer(batches_.front(), samples);
    batches_.pop_front();
  }
}

void RoomQueries::answer(const Batch& batch, const sim::SurfaceSamples& samples) {
  Answers answers;
  std::size_t first = 0;
  for (const QueryBook::Taken& taken : batch.taken) {
    v1::QueryResult& result = answers.add(taken.query);
    addValues(samples, first, taken.point_count, result);
    result.set_last(!taken.query.isStream());
    first += taken.point_count;
  }
  answers.send(room_, batch.tick, batch.time_s, batch.state_id);
}

void RoomQueries::removeOfGone() {
  (void)room_.queries.removeIf([this](const SurfaceQuery& query) {
    const core::Sender& sender = query.sender;
    return query.isStream() && !room_.roster.isConnected(sender.person_id, sender.session_id);
  });
}

void RoomQueries::waterChanged(bool continues) {
  for (Batch& batch : std::exchange(batches_, {})) room_.queries.putBack(std::move(batch.taken));
  if (!continues) endAll("the scene has changed");
}

void RoomQueries::endAll(const std::string& why) {
  Answers answers;
  for (const SurfaceQuery& query : room_.queries.removeIf([](const SurfaceQuery&) { return true; })) {
    v1::QueryResult& result = answers.add(query);
    result.set_last(true);
    result.set_ended(why);
  }
  answers.send(room_, room_.water->tick(), room_.water->sim().time_s(), room_.water->stateId());
}

}  // namespace spindrift::rooms
