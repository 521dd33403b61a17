#include "session.h"

#include <algorithm>
#include <random>
#include <utility>

#include <spindrift/wire/client_message.h>

namespace spindrift::client {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kWaitingMaxCount = 64;
constexpr std::chrono::seconds kPingEvery{2};
/// Without any message for so long, the connection counts as lost.
constexpr std::chrono::seconds kSilence{10};
/// Pause before the library asks again for followed points that the server ended or rejected.
constexpr std::chrono::seconds kAskAgain{1};
constexpr milliseconds kFirstPause{500};
constexpr milliseconds kLongestPause{8000};
/// A connection that lasted so long is followed by the shortest pause.
constexpr std::chrono::seconds kSettled{5};

milliseconds pauseAfter(int failed_count) {
  std::random_device entropy;
  std::uniform_real_distribution<double> spread(0.75, 1.25);
  const auto pause = std::min(kFirstPause * (1 << std::min(failed_count - 1, 10)), kLongestPause);
  return std::chrono::duration_cast<milliseconds>(pause * spread(entropy));
}

v1::Command queryOf(const Points& points, std::uint32_t query_id, std::uint32_t interval_ticks) {
  v1::Command command;
  v1::Query& query = *command.mutable_query();
  query.set_query_id(query_id);
  query.set_interval_ticks(interval_ticks);
  query.mutable_x_m()->Assign(points.x_m.begin(), points.x_m.end());
  query.mutable_z_m()->Assign(points.z_m.begin(), points.z_m.end());
  return command;
}

Outcome lost(const std::string& why) {
  return {SPINDRIFT_NOT_CONNECTED, "the connection was lost (" + why + "); it may or may not have been carried out"};
}

}  // namespace

Session::Session(Options options)
    : options_(std::move(options)),
      pool_(net::ClientPool::create(0, options_.ca_file)),
      url_(options_.url),
      identity_(options_.identity),
      connect_at_(Clock::now()),
      thread_([this] { run(); }) {}

Session::~Session() {
  {
    const Lock lock(mutex_);
    is_stopping_ = true;
  }
  thread_.join();
}

Outcome Session::waitJoined(Clock::duration patience) {
  Lock lock(mutex_);
  changed_.wait_for(lock, patience, [&] { return is_joined_ || refused_; });
  Outcome out = present();
  if (out.status == SPINDRIFT_NOT_CONNECTED)
    out.text = "no connection to " + url_.host + ":" + url_.port + url_.path +
               " in time: " + (last_why_.empty() ? "no answer" : last_why_);
  return out;
}

Outcome Session::state() {
  const Lock lock(mutex_);
  return present();
}

Outcome Session::present() const {
  if (refused_) return {SPINDRIFT_REFUSED, *refused_};
  if (!is_joined_) return {SPINDRIFT_NOT_CONNECTED, last_why_.empty() ? "not connected yet" : last_why_};
  return {};
}

std::uint64_t Session::connectionCount() {
  const Lock lock(mutex_);
  return joined_count_;
}

Outcome Session::command(v1::Command command, v1::Ack& ack, bool is_patient) {
  Lock lock(mutex_);
  Outcome now = present();
  if (now.status != SPINDRIFT_OK) {
    now.text += ": the command was not sent";
    return now;
  }
  if (commands_.size() >= kWaitingMaxCount)
    return {SPINDRIFT_REJECTED, "64 commands wait for their answers: the command was not sent"};
  const std::uint64_t id = next_command_id_++;
  command.set_command_id(id);
  Waiting waiting;
  commands_[id] = &waiting;
  v1::ClientMessage message;
  *message.mutable_command() = std::move(command);
  send(message);
  const auto is_done = [&] { return waiting.is_done; };
  if (is_patient) {
    changed_.wait(lock, is_done);
  } else if (!changed_.wait_for(lock, options_.answer_within, is_done)) {
    commands_.erase(id);
    return {SPINDRIFT_NO_ANSWER, "no answer in time; the command may still be carried out"};
  }
  ack = std::move(waiting.ack);
  return std::move(waiting.outcome);
}

Outcome Session::query(const Points& points, PointsAnswer& answer) {
  Waiting waiting;
  std::uint32_t id = 0;
  {
    const Lock lock(mutex_);
    id = next_query_id_++;
    queries_[id] = &waiting;
  }
  v1::Ack ack;
  Outcome out = command(queryOf(points, id, 0), ack);
  Lock lock(mutex_);
  if (out.status == SPINDRIFT_OK) {
    if (changed_.wait_for(lock, options_.answer_within, [&] { return waiting.is_done; })) {
      out = std::move(waiting.outcome);
      answer = std::move(waiting.answer);
    } else {
      out = {SPINDRIFT_NO_ANSWER, "the water at the points did not come in time"};
    }
  }
  queries_.erase(id);
  return out;
}

Outcome Session::follow(Points points, std::uint32_t interval_ticks) {
  std::uint32_t old_id = 0;
  std::uint32_t id = 0;
  {
    const Lock lock(mutex_);
    old_id = std::exchange(followed_, {}).query_id;
    newest_ = {};
    id = next_query_id_++;
  }
  v1::Ack ack;
  if (old_id != 0) {  // ended first: the points of both may be more than a client may ask for
    const Outcome end = command(queryOf({}, old_id, 0), ack);
    if (end.status != SPINDRIFT_OK || points.x_m.empty()) return end;
  }
  if (points.x_m.empty()) return {};
  v1::Command asked = queryOf(points, id, interval_ticks);
  {
    const Lock lock(mutex_);  // answers may come before the Ack
    followed_ = {.points = std::move(points),
                 .interval_ticks = interval_ticks,
                 .query_id = id,
                 .command_id = 0,
                 .ask_at = {},
                 .outcome = {}};
  }
  Outcome out = command(std::move(asked), ack);
  const Lock lock(mutex_);
  if (out.status != SPINDRIFT_OK && followed_.query_id == id) followed_ = {};
  return out;
}

Outcome Session::newest(std::uint64_t after, Clock::duration patience, std::size_t count, PointsAnswer& answer) {
  Lock lock(mutex_);
  const std::size_t followed_count = followed_.points.x_m.size();
  if (followed_count == 0) return {SPINDRIFT_BAD_ARGUMENT, "no points are followed: call spindrift_follow() first"};
  if (count != followed_count)
    return {SPINDRIFT_BAD_ARGUMENT,
            "count " + std::to_string(count) + ": " + std::to_string(followed_count) + " points are followed"};
  const std::uint32_t id = followed_.query_id;
  const auto is_newer = [&] { return newest_.moment.number > after; };
  changed_.wait_for(lock, patience, [&] { return is_newer() || refused_ || followed_.query_id != id; });
  if (followed_.query_id != id) return {SPINDRIFT_BAD_ARGUMENT, "other points are followed now"};
  answer = newest_;
  Outcome now = present();
  if (now.status != SPINDRIFT_OK) return now;
  if (is_newer()) return {};
  if (followed_.outcome.status != SPINDRIFT_OK) return followed_.outcome;
  return {SPINDRIFT_NO_ANSWER, "no newer answer in time"};
}

// ---- the thread

void Session::run() {
  const auto is_stopping = [&] {
    const Lock lock(mutex_);
    return is_stopping_;
  };
  while (!is_stopping()) {
    {
      const Lock lock(mutex_);
      keep();
    }
    pool_->runFor(milliseconds(50), is_stopping);
  }
  std::shared_ptr<net::Client> last;
  {
    const Lock lock(mutex_);
    last = connection_;
  }
  if (!last) return;
  last->close();
  pool_->runFor(milliseconds(500), [&] {
    const Lock lock(mutex_);
    return connection_ == nullptr;
  });
}

/// Does what is due.
void Session::keep() {
  const auto now = Clock::now();
  if (move_ && now >= move_->at) {
    url_ = std::exchange(move_, std::nullopt)->url;
    drop("moving to another server");
    connect_at_ = now;
  }
  if (connect_at_ && now >= *connect_at_) connect();
  if (!is_joined_ || !connection_) return;
  if (now - heard_at_ > kSilence) {
    drop("no message from the server for 10 s");
    connect_at_ = now;
    return;
  }
  if (now - pinged_at_ >= kPingEvery) {
    pinged_at_ = now;
    v1::ClientMessage ping;
    ping.mutable_ping()->set_client_time_s(std::chrono::duration<double>(now.time_since_epoch()).count());
    send(ping);
  }
  if (followed_.ask_at && now >= *followed_.ask_at) ask();
}

void Session::connect() {
  connect_at_.reset();
  const std::uint64_t number = ++connection_number_;
  const auto if_current = [this, number](auto action) {
    return [this, number, action](auto&&... values) {
      const Lock lock(mutex_);
      if (number == connection_number_) action(values...);
    };
  };
  heard_at_ = Clock::now();
  connection_ = pool_->connect(
      url_, {},
      {.opened = if_current([this] { send(hello(identity_)); }),
       .message = if_current([this](core::ByteView bytes) { take(bytes); }),
       .closed = if_current([this](std::uint16_t code, const std::string& reason) { ended(code, reason); })});
}

/// Forgets the connection: everybody who waits for an answer is told.
void Session::drop(const std::string& why) {
  ++connection_number_;
  if (connection_) connection_->close();
  connection_.reset();
  is_joined_ = false;
  last_why_ = why;
  for (const auto& [id, one] : commands_) {
    one->is_done = true;
    one->outcome = lost(why);
  }
  commands_.clear();
  for (const auto& [id, one] : queries_) {
    if (std::exchange(one->is_done, true)) continue;
    one->outcome = {SPINDRIFT_NOT_CONNECTED, "the connection was lost (" + why + ")"};
  }
  changed_.notify_all();
}

void Session::ended(std::uint16_t code, const std::string& reason) {
  const std::string why = reason.empty() ? "closed with code " + std::to_string(code) : reason;
  const bool was_settled = is_joined_ && Clock::now() - joined_at_ >= kSettled;
  drop(why);
  if (refused_) return;
  if (isFinal(code, reason)) return refuse(why);
  failed_count_ = was_settled ? 1 : failed_count_ + 1;
  if (!move_) connect_at_ = Clock::now() + pauseAfter(failed_count_);
}

void Session::refuse(const std::string& text) {
  refused_ = text;
  move_.reset();
  connect_at_.reset();
  drop(text);
}

void Session::take(core::ByteView bytes) {
  heard_at_ = Clock::now();
  v1::ServerMessage message;
  if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
    drop("the server sent a damaged message");
    connect_at_ = Clock::now() + kFirstPause;
    return;
  }
  switch (message.message_case()) {
    case v1::ServerMessage::kGreeting: {
      const v1::Version& version = message.greeting().version();
      if (version.major() != wire::kWireMajor)
        refuse("the server speaks " + std::to_string(version.major()) + "." + std::to_string(version.minor()) +
               " of the wire, this client " + std::to_string(wire::kWireMajor) + "." +
               std::to_string(wire::kWireMinor) + ": update the older one");
      return;
    }
    case v1::ServerMessage::kWelcome:
      identity_.resume_key = message.welcome().resume_key();
      is_joined_ = true;
      ++joined_count_;
      joined_at_ = Clock::now();
      pinged_at_ = joined_at_;
      if (followed_.query_id != 0) ask();
      return changed_.notify_all();
    case v1::ServerMessage::kRefusal:
      return refuse(message.refusal().message());
    case v1::ServerMessage::kDraining:
      move_ = planMove(message.draining(), url_);
      return;
    case v1::ServerMessage::kAck:
      return answered(message.ack().command_id(), {}, message.ack());
    case v1::ServerMessage::kReject:
      return answered(
          message.reject().command_id(),
          {SPINDRIFT_REJECTED, v1::RejectReason_Name(message.reject().reason()) + ": " + message.reject().field() +
                                   (message.reject().field().empty() ? "" : ": ") + message.reject().message()},
          {});
    case v1::ServerMessage::kQueryAnswer:
      return takeAnswers(*message.mutable_query_answer());
    default:
      return;
  }
}

void Session::answered(std::uint64_t command_id, Outcome outcome, const v1::Ack& ack) {
  if (command_id == followed_.command_id) {
    followed_.outcome = std::move(outcome);
    if (followed_.outcome.status != SPINDRIFT_OK) followed_.ask_at = Clock::now() + kAskAgain;
    return;
  }
  const auto found = commands_.extract(command_id);
  if (!found) return;  // nobody waits any more
  Waiting& waiting = *found.mapped();
  waiting.is_done = true;
  waiting.outcome = std::move(outcome);
  waiting.ack = ack;
  changed_.notify_all();
}

void Session::takeAnswers(v1::QueryAnswer& answers) {
  for (v1::QueryResult& result : *answers.mutable_results()) {
    spindrift_moment moment = {answers.tick(), answers.time_s(), answers.state_id(), 1};
    if (result.query_id() == followed_.query_id) {
      if (!result.ended().empty()) {
        followed_.outcome = {SPINDRIFT_NO_ANSWER, result.ended()};
        followed_.ask_at = Clock::now() + kAskAgain;
      } else {
        moment.number = newest_.moment.number + 1;
        newest_ = {moment, std::move(result)};
      }
      continue;
    }
    const auto found = queries_.find(result.query_id());
    if (found == queries_.end() || std::exchange(found->second->is_done, true)) continue;
    if (!result.ended().empty()) found->second->outcome = {SPINDRIFT_REJECTED, result.ended()};
    found->second->answer = {moment, std::move(result)};
  }
  changed_.notify_all();
}

/// Asks for the followed points, without waiting for the answer.
void Session::ask() {
  followed_.ask_at.reset();
  followed_.command_id = next_command_id_++;
  v1::ClientMessage message;
  *message.mutable_command() = queryOf(followed_.points, followed_.query_id, followed_.interval_ticks);
  message.mutable_command()->set_command_id(followed_.command_id);
  send(message);
}

void Session::send(const v1::ClientMessage& message) {
  if (!connection_) return;
  core::Bytes bytes(message.ByteSizeLong());
  message.SerializeWithCachedSizesToArray(bytes.data());
  (void)connection_->send(core::share(std::move(bytes)));  // at most 64 wait, far fewer than its queue holds
}

}  // namespace spindrift::client
