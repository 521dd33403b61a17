#include "connection_set.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <system_error>
#include <utility>

#include <spdlog/spdlog.h>
#include <sys/resource.h>

namespace spindrift::net {
namespace {

/// Descriptors of this process that are open now; 0 where /proc cannot be read.
std::size_t openDescriptorCount() {
  std::error_code error;
  const std::filesystem::directory_iterator folder("/proc/self/fd", error);
  if (error) return 0;
  return static_cast<std::size_t>(std::distance(begin(folder), end(folder)));
}

}  // namespace

bool ConnectionSet::add(std::uint64_t id, std::shared_ptr<Connection> connection) {
  const std::lock_guard lock(mutex_);
  if (closed_ || connections_.size() >= max_count_) return false;
  connections_.emplace(id, std::move(connection));
  return true;
}

void ConnectionSet::remove(std::uint64_t id) {
  // Destroyed after the mutex is released: the destructor must not run under this lock.
  std::shared_ptr<Connection> removed;
  const std::lock_guard lock(mutex_);
  const auto found = connections_.find(id);
  if (found == connections_.end()) return;
  removed = std::move(found->second);
  connections_.erase(found);
  if (connections_.empty()) emptied_.notify_all();
}

std::size_t ConnectionSet::count() const {
  const std::lock_guard lock(mutex_);
  return connections_.size();
}

void ConnectionSet::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
}

std::vector<std::shared_ptr<Connection>> ConnectionSet::all() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::shared_ptr<Connection>> out;
  out.reserve(connections_.size());
  for (const auto& [id, connection] : connections_) out.push_back(connection);
  return out;
}

bool ConnectionSet::waitEmpty(std::chrono::steady_clock::time_point deadline) {
  std::unique_lock lock(mutex_);
  return emptied_.wait_until(lock, deadline, [this] { return connections_.empty(); });
}

std::size_t limitConnections(std::size_t wanted_count, std::size_t reserved_count) {
  const std::size_t others_count = openDescriptorCount() + reserved_count;
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return wanted_count;
  const rlim_t needed = others_count + wanted_count;
  if (limit.rlim_cur != RLIM_INFINITY && limit.rlim_cur < needed) {
    rlimit raised = limit;
    raised.rlim_cur = limit.rlim_max == RLIM_INFINITY ? needed : std::min(needed, limit.rlim_max);
    if (setrlimit(RLIMIT_NOFILE, &raised) == 0) limit = raised;
  }
  if (limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur >= needed) return wanted_count;
  const std::size_t left_count = limit.rlim_cur > others_count ? limit.rlim_cur - others_count : 1;
  spdlog::warn(
      "at most {} connections at a time instead of {}: the limit of open files is {}, and {} are kept for files and "
      "devices; raise it (ulimit -n, LimitNOFILE= of systemd) to {}",
      left_count, wanted_count, limit.rlim_cur, others_count, needed);
  return left_count;
}

}  // namespace spindrift::net
