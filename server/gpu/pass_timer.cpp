#include <algorithm>
#include <cassert>
#include <utility>

#include <glad/gl.h>

#include <spindrift/gpu/pass_timer.h>

namespace spindrift::gpu {

PassTimers::PassTimers(Context& ctx, std::size_t capacity_count) : ctx_(ctx), queries_(capacity_count) {
  assert(ctx.isOwnedHere() && capacity_count > 0);
  for (Query& query : queries_) {
    glCreateQueries(GL_TIMESTAMP, 1, &query.begin_id);
    glCreateQueries(GL_TIMESTAMP, 1, &query.end_id);
  }
}

PassTimers::~PassTimers() {
  assert(ctx_.isOwnedHere());
  for (const Query& query : queries_) {
    glDeleteQueries(1, &query.begin_id);
    glDeleteQueries(1, &query.end_id);
  }
}

PassTimers::Scope::~Scope() {
  if (query_index_ == kNoQuery) return;
  Query& query = timers_.queries_[query_index_];
  glQueryCounter(query.end_id, GL_TIMESTAMP);
  query.is_closed = true;
}

std::vector<PassCost> PassTimers::take() {
  assert(ctx_.isOwnedHere());
  collect();
  std::vector<PassCost> out;
  for (PassCost& cost : costs_) {
    if (cost.scope_count == 0) continue;
    out.push_back(cost);
    cost = PassCost{.name = std::move(cost.name)};
  }
  return out;
}

std::size_t PassTimers::openQuery(std::string_view name) {
  assert(ctx_.isOwnedHere());
  // There are few names: a linear search is cheaper than a map.
  const auto known = std::ranges::find(costs_, name, &PassCost::name);
  const auto name_index = static_cast<std::size_t>(known - costs_.begin());
  if (known == costs_.end()) costs_.push_back(PassCost{.name = std::string(name)});
  if (queries_[next_query_].in_use) collect();
  if (queries_[next_query_].in_use) {
    ++dropped_count_;
    return kNoQuery;
  }
  const std::size_t index = next_query_;
  next_query_ = (next_query_ + 1) % queries_.size();
  Query& query = queries_[index];
  query.name_index = name_index;
  query.in_use = true;
  query.is_closed = false;
  glQueryCounter(query.begin_id, GL_TIMESTAMP);
  return index;
}

void PassTimers::collect() {
  for (Query& query : queries_) {
    if (!query.in_use || !query.is_closed) continue;
    GLuint is_ready = GL_FALSE;
    glGetQueryObjectuiv(query.end_id, GL_QUERY_RESULT_AVAILABLE, &is_ready);
    if (!is_ready) continue;
    GLuint64 begin_ns = 0;
    GLuint64 end_ns = 0;
    glGetQueryObjectui64v(query.begin_id, GL_QUERY_RESULT, &begin_ns);
    glGetQueryObjectui64v(query.end_id, GL_QUERY_RESULT, &end_ns);
    query.in_use = false;
    PassCost& cost = costs_[query.name_index];
    cost.total_ms += end_ns > begin_ns ? static_cast<double>(end_ns - begin_ns) * 1e-6 : 0.0;
    ++cost.scope_count;
  }
}

}  // namespace spindrift::gpu
