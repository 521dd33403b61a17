#include "pending_answer.h"

#include <utility>

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>

namespace spindrift::net {

namespace asio = boost::asio;

void PendingAnswer::State::settle(Outcome settled) {
  const std::lock_guard lock(mutex);
  if (outcome || !wake) return;
  outcome = std::move(settled);
  wake();
}

PendingAnswer::PendingAnswer(const asio::any_io_executor& strand)
    : timer_(std::make_shared<asio::steady_timer>(strand)), state_(std::make_shared<State>()) {
  state_->wake = [strand, timer = timer_] { asio::post(strand, [timer] { timer->cancel(); }); };
}

PendingAnswer::~PendingAnswer() {
  // Responders may outlive the server's threads; the objects that they hold must not.
  const std::lock_guard lock(state_->mutex);
  state_->wake = nullptr;
}

HttpResponder PendingAnswer::responder() {
  // Shared by all copies of the responder: the destructor of the last one reports a missing answer.
  struct Promise {
    explicit Promise(std::shared_ptr<State> promised) : state(std::move(promised)) {}
    Promise(const Promise&) = delete;
    Promise& operator=(const Promise&) = delete;
    ~Promise() { state->settle({.end = End::kDropped}); }
    std::shared_ptr<State> state;
  };
  return [promise = std::make_shared<Promise>(state_)](std::optional<HttpReply> reply) {
    if (reply) {
      promise->state->settle({.end = End::kAnswered, .reply = *std::move(reply)});
    } else {
      promise->state->settle({.end = End::kUnknown});
    }
  };
}

asio::awaitable<PendingAnswer::Outcome> PendingAnswer::wait(std::chrono::milliseconds timeout) {
  // An answer posts its wake-up to this strand, so it cannot run between this check and the wait.
  timer_->expires_after(timeout);
  bool is_settled = false;
  {
    const std::lock_guard lock(state_->mutex);
    is_settled = state_->outcome.has_value();
  }
  if (!is_settled) (void)co_await timer_->async_wait(asio::as_tuple(asio::use_awaitable));
  const std::lock_guard lock(state_->mutex);
  state_->wake = nullptr;
  co_return state_->outcome.value_or(Outcome{});
}

void PendingAnswer::cancel() {
  state_->settle({.end = End::kCancelled});
}

}  // namespace spindrift::net
