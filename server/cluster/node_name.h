// Keeps the name of a node unique in its cluster. Two processes of one name would take each other's messages: answers
// go astray, and people with them.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include <spindrift/bus/bus.h>
#include <spindrift/v1/cluster.pb.h>

namespace spindrift::cluster {

/// Returns a random number that no other run of a process or a room has.
std::uint64_t newRun();

/// Returns which of two processes of one name ends: every process comes to the same decision from the same two
/// messages. One that has the name keeps it against one that starts; otherwise the numbers of their runs decide.
bool yields(const v1::NamePulse& mine, const v1::NamePulse& other);

/// A process that has a name says so several times per second, and at once when another one asks for the name. A
/// process that has ended says nothing, so its name is free. Thread-safe.
class NodeName {
 public:
  /// `bus` outlives it. `lost` is called on the thread of the bus, after claim(), with the process that keeps the name.
  NodeName(bus::Bus& bus, std::string subject, std::function<void(const std::string& process)> lost);

  /// Asks for the name and waits for an answer for `patience`; returns early with the process that has it. An empty
  /// text: the name is this process's.
  std::string claim(std::chrono::milliseconds patience);
  /// Says that this process has the name.
  void pulse();

 private:
  void take(core::ByteView message);

  bus::Bus& bus_;
  const std::string subject_;
  const std::function<void(const std::string&)> lost_;
  std::mutex mutex_;
  std::condition_variable told_;
  v1::NamePulse mine_;                         ///< guarded by mutex_
  std::string taken_by_;                       ///< likewise; empty: nobody else has the name
  std::unique_ptr<bus::Subscription> pulses_;  ///< last: its handler uses all of the above
};

}  // namespace spindrift::cluster
