// The thread that builds water beside the running rooms, and takes down what they let go of.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <thread>

#include <spindrift/core/result.h>
#include <spindrift/gpu/device.h>
#include <spindrift/v1/scene.pb.h>

#include "water.h"

namespace spindrift::app {

/// One piece of work at a time, in order, at a lower priority than the simulation. What waits is bounded by its
/// callers: a room has one build under way.
class WaterBuilder {
 public:
  using Built = core::Result<std::unique_ptr<Water>>;

  /// `done` is called on the builder's thread after each piece of work.
  explicit WaterBuilder(gpu::DeviceChoice device, std::function<void()> done = {});
  /// Ends the thread after the work at hand; builds that wait end with kUnavailable.
  ~WaterBuilder();
  WaterBuilder(const WaterBuilder&) = delete;
  WaterBuilder& operator=(const WaterBuilder&) = delete;

  /// Any thread. The water comes released: the caller binds it. Errors: Water::create()'s; kUnavailable at the end.
  std::future<Built> build(v1::Scene scene);
  /// Destroys the water, which the calling thread has bound.
  void dispose(std::unique_ptr<Water> water);

 private:
  void loop();
  void push(std::function<void(bool runs)> work);

  const gpu::DeviceChoice device_;
  const std::function<void()> done_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::function<void(bool runs)>> work_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace spindrift::app
