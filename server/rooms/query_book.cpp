#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include <spindrift/rooms/query_book.h>

namespace spindrift::rooms {
namespace {

bool isDue(const SurfaceQuery& query, QueryBook::Which which, std::uint64_t tick) {
  if (!query.answered_tick) return true;
  return which == QueryBook::Which::kDue && tick >= *query.answered_tick + query.asked.interval_ticks();
}

bool isOf(const SurfaceQuery& query, const core::Sender& sender) {
  return query.sender.session_id == sender.session_id && query.sender.request_id == sender.request_id;
}

/// Of point k: none, one for all, or one each.
double velocityAt(const google::protobuf::RepeatedField<float>& velocity_mps, int k) {
  if (velocity_mps.empty()) return 0.0;
  return velocity_mps[velocity_mps.size() == 1 ? 0 : k];
}

}  // namespace

void SurfaceQuery::placePoints(std::uint64_t tick, double tick_s, std::vector<sim::SurfacePoint>& out) const {
  const double elapsed_s = static_cast<double>(tick - begin_tick) * tick_s;
  for (int k = 0; k < asked.x_m_size(); ++k) {
    out.push_back({asked.x_m(k) + elapsed_s * velocityAt(asked.velocity_x_mps(), k),
                   asked.z_m(k) + elapsed_s * velocityAt(asked.velocity_z_mps(), k)});
  }
}

std::optional<wire::CommandRejection> QueryBook::enter(const core::Sender& sender, const v1::Query& asked,
                                                       std::uint64_t tick) {
  SurfaceQuery query{.sender = sender, .asked = asked, .begin_tick = tick};
  const bool ends = query.pointCount() == 0;
  const auto replaced = std::ranges::find_if(queries_, [&](const SurfaceQuery& other) {
    const bool replaces = ends || query.isStream();
    return replaces && other.isStream() && isOf(other, sender) && other.asked.query_id() == asked.query_id();
  });
  if (ends) {
    if (replaced != queries_.end()) queries_.erase(replaced);
    return {};
  }
  std::size_t own_queries = 1, own_points = query.pointCount(), room_points = query.pointCount();
  for (auto other = queries_.begin(); other != queries_.end(); ++other) {
    if (other == replaced) continue;
    room_points += other->pointCount();
    if (!isOf(*other, sender)) continue;
    own_points += other->pointCount();
    ++own_queries;
  }
  const auto busy = [](const char* field, std::string why) {
    return wire::rejection(v1::REJECT_REASON_BUSY, field, std::move(why));
  };
  if (own_queries > kSessionMaxQueries) {
    return busy("query", fmt::format("you would have {} queries that wait or stream, {} are the most: end one first",
                                     own_queries, kSessionMaxQueries));
  }
  if (own_points > wire::kQueryMaxPoints) {
    return busy("query.x_m", fmt::format("you would have {} points that wait or stream, {} are the most: end a stream, "
                                         "or ask for fewer points",
                                         own_points, wire::kQueryMaxPoints));
  }
  if (room_points > kRoomMaxQueryPoints) {
    return busy("query.x_m", fmt::format("the room would have {} points that wait or stream, {} are the most: ask for "
                                         "fewer points, or later",
                                         room_points, kRoomMaxQueryPoints));
  }
  if (replaced == queries_.end()) {
    queries_.push_back(std::move(query));
  } else {
    if (replaced->answered_tick == tick) query.answered_tick = tick;  // at most one answer per tick
    *replaced = std::move(query);
  }
  return {};
}

std::vector<sim::SurfacePoint> QueryBook::points(Which which, std::uint64_t tick, double tick_s) const {
  std::vector<sim::SurfacePoint> out;
  for (const SurfaceQuery& query : queries_) {
    if (isDue(query, which, tick)) query.placePoints(tick, tick_s, out);
  }
  return out;
}

std::vector<QueryBook::Taken> QueryBook::take(Which which, std::uint64_t tick) {
  std::vector<Taken> out;
  for (SurfaceQuery& query : queries_) {
    if (!isDue(query, which, tick)) continue;
    query.answered_tick = tick;
    Taken& taken = out.emplace_back();
    taken.point_count = query.pointCount();
    if (query.isStream()) {
      taken.query.sender = query.sender;
      taken.query.asked.set_query_id(query.asked.query_id());
      taken.query.asked.set_interval_ticks(query.asked.interval_ticks());
    } else {
      taken.query = std::move(query);
    }
  }
  // What was moved from has lost its points.
  std::erase_if(queries_, [](const SurfaceQuery& query) { return query.pointCount() == 0; });
  return out;
}

void QueryBook::putBack(std::vector<Taken> taken) {
  for (Taken& one : taken) {
    if (one.query.isStream()) continue;
    one.query.answered_tick.reset();
    queries_.push_back(std::move(one.query));
  }
}

std::vector<SurfaceQuery> QueryBook::removeIf(const std::function<bool(const SurfaceQuery&)>& holds) {
  const auto removed =
      std::stable_partition(queries_.begin(), queries_.end(), [&](const SurfaceQuery& query) { return !holds(query); });
  std::vector<SurfaceQuery> out(std::make_move_iterator(removed), std::make_move_iterator(queries_.end()));
  queries_.erase(removed, queries_.end());
  return out;
}

}  // namespace spindrift::rooms
