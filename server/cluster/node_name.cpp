#include "node_name.h"

#include <array>
#include <random>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "messages.h"

namespace spindrift::cluster {
namespace {

/// A second process of the name is told by few messages; more are of no use.
constexpr std::size_t kWaitingMaxBytes = 64u << 10;

std::string thisProcess() {
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) host.fill('\0');
  return fmt::format("process {} on {}", ::getpid(), host[0] == '\0' ? "another machine" : host.data());
}

}  // namespace

std::uint64_t newRun() {
  std::random_device device;
  return (std::uint64_t{device()} << 32u) | device();
}

bool yields(const v1::NamePulse& mine, const v1::NamePulse& other) {
  if (mine.is_settled() != other.is_settled()) return other.is_settled();
  return mine.run() > other.run();
}

NodeName::NodeName(bus::Bus& bus, std::string subject, std::function<void(const std::string&)> lost)
    : bus_(bus), subject_(std::move(subject)), lost_(std::move(lost)) {
  mine_.set_run(newRun());
  mine_.set_process(thisProcess());
  pulses_ = bus_.subscribe(subject_, kWaitingMaxBytes, [this](core::ByteView message) { take(message); });
}

std::string NodeName::claim(std::chrono::milliseconds patience) {
  pulse();
  std::unique_lock lock(mutex_);
  told_.wait_for(lock, patience, [this] { return !taken_by_.empty(); });
  mine_.set_is_settled(taken_by_.empty());
  return taken_by_;
}

void NodeName::pulse() {
  core::Bytes bytes;
  {
    const std::lock_guard lock(mutex_);
    bytes = serialize(mine_);
  }
  bus_.publish(subject_, bytes);
}

void NodeName::take(core::ByteView message) {
  const auto other = parse<v1::NamePulse>(message);
  if (!other) return;
  std::string keeper;
  bool is_asked = false;
  {
    const std::lock_guard lock(mutex_);
    if (!taken_by_.empty()) return;
    if (yields(mine_, *other)) {
      taken_by_ = other->process().empty() ? "another process" : other->process();
      if (mine_.is_settled()) keeper = taken_by_;
    } else {
      is_asked = !other->is_settled();  // it starts, and waits for an answer
    }
  }
  told_.notify_all();
  if (!keeper.empty()) lost_(keeper);
  if (is_asked) pulse();
}

}  // namespace spindrift::cluster
