#include "dispatch_times.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <glad/gl.h>
#include <spdlog/spdlog.h>

namespace spindrift::gpu {
namespace {

/// Dispatches between two waits.
constexpr std::size_t kMaxOpen = 4096;

}  // namespace

DispatchTimes::~DispatchTimes() {
  collect();
  std::vector<std::pair<std::string, Sum>> programs(sums_.begin(), sums_.end());
  std::ranges::sort(programs, std::ranges::greater{}, [](const auto& each) { return each.second.time_us; });
  double all_us = 0.0;
  for (const auto& [path, sum] : programs) all_us += sum.time_us;
  for (const auto& [path, sum] : programs)
    spdlog::info("{:5.1f} % {}: {} dispatches of {:.1f} us", 100.0 * sum.time_us / all_us, path, sum.count,
                 sum.time_us / static_cast<double>(sum.count));
}

void DispatchTimes::begin(std::string_view path) {
  if (open_.size() == kMaxOpen) collect();
  Open& open = open_.emplace_back(Open{std::string(path), 0, 0});
  glCreateQueries(GL_TIMESTAMP, 1, &open.begin_id);
  glCreateQueries(GL_TIMESTAMP, 1, &open.end_id);
  glQueryCounter(open.begin_id, GL_TIMESTAMP);
}

void DispatchTimes::end() {
  glQueryCounter(open_.back().end_id, GL_TIMESTAMP);
}

void DispatchTimes::collect() {
  for (const Open& open : open_) {
    GLuint64 begin_ns = 0;
    GLuint64 end_ns = 0;
    glGetQueryObjectui64v(open.begin_id, GL_QUERY_RESULT, &begin_ns);
    glGetQueryObjectui64v(open.end_id, GL_QUERY_RESULT, &end_ns);
    glDeleteQueries(1, &open.begin_id);
    glDeleteQueries(1, &open.end_id);
    Sum& sum = sums_[open.path];
    sum.time_us += end_ns > begin_ns ? static_cast<double>(end_ns - begin_ns) * 1e-3 : 0.0;
    ++sum.count;
  }
  open_.clear();
}

}  // namespace spindrift::gpu
