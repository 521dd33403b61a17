// The answer to a pending request: set by the application from any thread, awaited on the connection's strand.
#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/steady_timer.hpp>

#include <spindrift/net/server.h>

namespace spindrift::net {

/// One per request. Lives on the strand; its responders may outlive it and then do nothing.
class PendingAnswer {
 public:
  enum class End { kAnswered, kDropped, kTimeout, kCancelled };
  struct Outcome {
    End end = End::kTimeout;
    std::optional<HttpReply> reply{};  ///< of kAnswered; nullopt: the application knows no such path
  };

  explicit PendingAnswer(const boost::asio::any_io_executor& strand);
  ~PendingAnswer();
  PendingAnswer(const PendingAnswer&) = delete;
  PendingAnswer& operator=(const PendingAnswer&) = delete;

  HttpResponder responder();
  boost::asio::awaitable<Outcome> wait(std::chrono::milliseconds timeout);
  /// Ends wait() with kCancelled. Call it on the strand.
  void cancel();

 private:
  struct State {
    std::mutex mutex;
    std::optional<Outcome> outcome;
    std::shared_ptr<boost::asio::steady_timer> timer;  ///< for wait(); null once it has ended

    void settle(Outcome settled);
  };

  std::shared_ptr<State> state_ = std::make_shared<State>();
};

}  // namespace spindrift::net
