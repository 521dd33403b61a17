// The answer to a pending request: set by the application from any thread, awaited on the connection's strand.
#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>

#include <spindrift/net/server.h>

#include "transport.h"

namespace spindrift::net {

/// One per request. Lives on the strand; its responders may outlive it and then do nothing.
class PendingAnswer {
 public:
  enum class End { kAnswered, kDropped, kTimeout, kCancelled };
  struct Outcome {
    End end = End::kTimeout;
    std::optional<HttpReply> reply{};  ///< of kAnswered; nullopt: the application knows no such path
  };

  explicit PendingAnswer(const boost::asio::any_io_executor& strand) {
    state_->timer = std::make_shared<boost::asio::steady_timer>(strand);
  }
  ~PendingAnswer() {
    // Responders may outlive the server's threads; the objects that they hold must not.
    const std::lock_guard lock(state_->mutex);
    state_->timer = nullptr;
  }
  PendingAnswer(const PendingAnswer&) = delete;
  PendingAnswer& operator=(const PendingAnswer&) = delete;

  HttpResponder responder() {
    // Shared by all copies of the responder: the destructor of the last one reports a missing answer.
    struct Promise {
      explicit Promise(std::shared_ptr<State> promised) : state(std::move(promised)) {}
      Promise(const Promise&) = delete;
      Promise& operator=(const Promise&) = delete;
      ~Promise() { state->settle({.end = End::kDropped}); }
      std::shared_ptr<State> state;
    };
    return [promise = std::make_shared<Promise>(state_)](std::optional<HttpReply> reply) {
      promise->state->settle({.end = End::kAnswered, .reply = std::move(reply)});
    };
  }

  boost::asio::awaitable<Outcome> wait(std::chrono::milliseconds timeout) {
    // An answer posts its wake-up to this strand, so it cannot run between this check and the wait.
    const std::shared_ptr<boost::asio::steady_timer> timer = state_->timer;
    timer->expires_after(timeout);
    bool is_settled = false;
    {
      const std::lock_guard lock(state_->mutex);
      is_settled = state_->outcome.has_value();
    }
    if (!is_settled) (void)co_await timer->async_wait(kToken);
    const std::lock_guard lock(state_->mutex);
    state_->timer = nullptr;
    co_return state_->outcome.value_or(Outcome{});
  }

  /// Ends wait() with kCancelled. Call it on the strand.
  void cancel() { state_->settle({.end = End::kCancelled}); }

 private:
  struct State {
    std::mutex mutex;
    std::optional<Outcome> outcome;
    std::shared_ptr<boost::asio::steady_timer> timer;  ///< for wait(); null once it has ended

    void settle(Outcome settled) {
      const std::lock_guard lock(mutex);
      if (outcome || !timer) return;
      outcome = std::move(settled);
      boost::asio::post(timer->get_executor(), [kept = timer] { kept->cancel(); });
    }
  };

  std::shared_ptr<State> state_ = std::make_shared<State>();
};

}  // namespace spindrift::net
