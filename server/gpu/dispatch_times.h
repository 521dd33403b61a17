// How long each program runs on the device, to find out where a step's time goes. Private to this module.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace spindrift::gpu {

/// Times every dispatch by two timestamps, which costs some microseconds each and keeps the device from overlapping
/// dispatches. Its context is current in all calls.
class DispatchTimes {
 public:
  DispatchTimes() = default;
  DispatchTimes(const DispatchTimes&) = delete;
  DispatchTimes& operator=(const DispatchTimes&) = delete;
  /// Logs the programs by their share of the time.
  ~DispatchTimes();

  void begin(std::string_view path);
  void end();

 private:
  struct Open {
    std::string path;
    std::uint32_t begin_id, end_id;
  };
  struct Sum {
    double time_us = 0.0;
    std::uint64_t count = 0;
  };
  /// Waits for the open timestamps, and adds them up.
  void collect();

  std::vector<Open> open_;
  std::map<std::string, Sum> sums_;
};

}  // namespace spindrift::gpu
