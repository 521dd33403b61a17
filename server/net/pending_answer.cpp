#include "pending_answer.h"

#include <utility>

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>

namespace spindrift::net {

namespace asio = boost::asio;

void PendingAnswer::State::settle(Outcome settled) {
  const std::lock_guard lock(mutex);
  if (outcome || !timer) return;
  outcome = std::move(settled);
  asio::post(timer->get_executor(), [kept = timer] { kept->cancel(); });
}

PendingAnswer::PendingAnswer(const asio::any_io_executor& strand) {
  state_->timer = std::make_shared<asio::steady_timer>(strand);
}

PendingAnswer::~PendingAnswer() {
  // Responders may outlive the server's threads; the objects that they hold must not.
  const std::lock_guard lock(state_->mutex);
  state_->timer = nullptr;
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
    promise->state->settle({.end = End::kAnswered, .reply = std::move(reply)});
  };
}

asio::awaitable<PendingAnswer::Outcome> PendingAnswer::wait(std::chrono::milliseconds timeout) {
  // An answer posts its wake-up to this strand, so it cannot run between this check and the wait.
  const std::shared_ptr<asio::steady_timer> timer = state_->timer;
  timer->expires_after(timeout);
  bool is_settled = false;
  {
    const std::lock_guard lock(state_->mutex);
    is_settled = state_->outcome.has_value();
  }
  if (!is_settled) (void)co_await timer->async_wait(asio::as_tuple(asio::use_awaitable));
  const std::lock_guard lock(state_->mutex);
  state_->timer = nullptr;
  co_return state_->outcome.value_or(Outcome{});
}

void PendingAnswer::cancel() {
  state_->settle({.end = End::kCancelled});
}

}  // namespace spindrift::net
