#include "connection_set.h"

#include <utility>

namespace spindrift::net {

bool ConnectionSet::add(std::uint64_t id, std::shared_ptr<Stoppable> connection) {
  const std::lock_guard lock(mutex_);
  if (closed_ || connections_.size() >= max_count_) return false;
  connections_.emplace(id, std::move(connection));
  return true;
}

void ConnectionSet::remove(std::uint64_t id) {
  // Destroyed after the mutex is released: the destructor must not run under this lock.
  std::shared_ptr<Stoppable> removed;
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

std::vector<std::shared_ptr<Stoppable>> ConnectionSet::all() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::shared_ptr<Stoppable>> out;
  out.reserve(connections_.size());
  for (const auto& [id, connection] : connections_) out.push_back(connection);
  return out;
}

bool ConnectionSet::waitEmpty(std::chrono::steady_clock::time_point deadline) {
  std::unique_lock lock(mutex_);
  return emptied_.wait_until(lock, deadline, [this] { return connections_.empty(); });
}

}  // namespace spindrift::net
