#include "kill_load.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <thread>
#include <utility>
#include <variant>

#include <gtest/gtest.h>

#include <spindrift/scene/fields.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::test {
namespace {

using namespace std::chrono_literals;

double between(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution(low, high)(random);
}

std::size_t below(std::mt19937& random, std::size_t count) {
  return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
}

/// A live parameter and its values; not every scene has it.
struct Knob {
  const char* path;
  double low;
  double high;
};
constexpr Knob kKnobs[] = {
    {"wave.depth_m", 0.8, 1.4},          {"wave.damping_per_s", 0.0, 1.0},     {"coupling.emission_ratio", 0.0, 3.0},
    {"particles.viscosity_pas", 20, 90}, {"particles.sound_speed_mps", 8, 16}, {"particles.count", 128, 512},
    {"particles.count", 128, 512},       {"storm.level_ratio", 0.0, 1.0},      {"storm.wind_speed_mps", 4.0, 20.0},
    {"gravity_mps2", 8.0, 11.0},         {"foam.wake_lifetime_s", 1.0, 9.0},   {"stream.frame_rate_hz", 10.0, 60.0},
};

bool mayTakeBoatsAway(const SentCommand& sent, std::uint32_t boat_id, std::uint32_t person_id) {
  const v1::Command& command = sent.command;
  if (command.has_reset() || command.has_change_scene()) return true;
  if (command.has_remove_boat()) return command.remove_boat().boat_id() == boat_id;
  return command.has_take_boat() && command.take_boat().boat_id() == boat_id && sent.person_id != person_id;
}

}  // namespace

// Ledger

void Ledger::beginRound() {
  const std::lock_guard lock(mutex_);
  commands_.clear();
  claims_.clear();
}

std::size_t Ledger::send(SentCommand command) {
  const std::lock_guard lock(mutex_);
  commands_.push_back(std::move(command));
  return commands_.size() - 1;
}

void Ledger::answer(std::size_t number, const v1::ServerMessage& answer) {
  const std::lock_guard lock(mutex_);
  SentCommand& sent = commands_.at(number);
  // From an edge whose link to the room broke.
  if (answer.reject().message().find("whether the command was carried out is not known") != std::string::npos) return;
  sent.state = answer.has_ack() ? SentCommand::State::kAcknowledged : SentCommand::State::kRejected;
  sent.tick = answer.ack().applied_tick();
  sent.boat_id = answer.ack().boat_id();
  if (!answer.has_ack()) return;
  const std::uint32_t boat_id = sent.command.has_take_boat() ? sent.command.take_boat().boat_id() : sent.boat_id;
  if (boat_id != 0) claims_.push_back({sent.room, sent.opening, sent.person_id, boat_id, sent.tick});
}

void Ledger::claim(BoatClaim claim) {
  const std::lock_guard lock(mutex_);
  claims_.push_back(std::move(claim));
}

void Ledger::setRoom(const std::string& room, RoomFact::State state, const std::string& scene) {
  const std::lock_guard lock(mutex_);
  RoomFact& fact = rooms_[room];
  fact.state = state;
  if (!scene.empty()) {
    fact.scene = scene;
    fact.opening = ++opening_count_;
  }
}

std::map<std::string, RoomFact> Ledger::rooms() const {
  const std::lock_guard lock(mutex_);
  return rooms_;
}

std::vector<SentCommand> Ledger::commands() const {
  const std::lock_guard lock(mutex_);
  return commands_;
}

std::set<std::uint32_t> Ledger::sureBoats(const std::string& room, std::uint64_t opening,
                                          std::uint32_t person_id) const {
  const std::lock_guard lock(mutex_);
  std::set<std::uint32_t> out;
  for (const BoatClaim& claim : claims_) {
    if (claim.room != room || claim.opening != opening || claim.person_id != person_id) continue;
    const bool is_sure = std::ranges::none_of(commands_, [&](const SentCommand& sent) {
      const bool is_later = sent.state == SentCommand::State::kUnanswered ||
                            (sent.state == SentCommand::State::kAcknowledged && sent.tick >= claim.tick);
      return sent.room == room && sent.opening == opening && is_later &&
             mayTakeBoatsAway(sent, claim.boat_id, person_id);
    });
    if (is_sure) out.insert(claim.boat_id);
  }
  return out;
}

// Player

Player::Player(std::uint32_t number, std::string room)
    : number_(number), wanders_(room.empty()), room_(std::move(room)) {}

void Player::forgetPerson() {
  resume_key_.clear();
  person_id_ = promised_person_id_ = 0;
  boats_.clear();
}

bool Player::connect(std::uint16_t port, const Ledger& ledger) {
  const auto before = ledger.rooms();
  const auto fact = before.find(room_);
  if (fact == before.end() || fact->second.state != RoomFact::State::kOpen) return false;
  if (fact->second.opening != opening_) forgetPerson();
  opening_ = fact->second.opening;
  client_ = std::make_unique<ScriptedClient>(port, room_);
  if (!client_->isOpen()) return false;
  client_->hello({.name = "player " + std::to_string(number_), .resume_key = resume_key_});
  const v1::Welcome& welcome = client_->welcome();
  // The room may have been closed and another one of its name opened meanwhile.
  if (welcome.person_id() == 0 || ledger.rooms()[room_].opening != opening_) {
    forgetPerson();
    return false;
  }
  if (!welcome.resumed()) boats_.clear();
  scene_ = client_->greeting().scene().name();
  resume_key_ = welcome.resume_key();
  person_id_ = welcome.person_id();
  return true;
}

Belongings Player::promised(const Ledger& ledger) const {
  return {promised_person_id_, ledger.sureBoats(room_, opening_, promised_person_id_)};
}

Belongings Player::comeBack(std::uint16_t port, Ledger& ledger) {
  if (!connect(port, ledger)) return {};
  Belongings out{person_id_, {}};
  const auto isMe = [&](const v1::Person& person) { return person.person_id() == person_id_; };
  const auto people = client_->waitFor(
      [&](const v1::ServerMessage& message) { return std::ranges::any_of(message.people().people(), isMe); });
  if (!people) return {};
  const v1::Person& me = *std::ranges::find_if(people->people().people(), isMe);
  out.boats.insert(me.boat_ids().begin(), me.boat_ids().end());
  for (const std::uint32_t boat_id : out.boats) ledger.claim({room_, opening_, person_id_, boat_id, 0});
  return out;
}

void expectKept(const Player& player, const Belongings& promised, const Belongings& found) {
  EXPECT_TRUE(player.client().welcome().resumed());
  EXPECT_EQ(found.person_id, promised.person_id);
  for (const std::uint32_t boat_id : promised.boats) EXPECT_TRUE(found.boats.contains(boat_id)) << "boat " << boat_id;
}

void Player::play(std::uint16_t port, Ledger& ledger, std::mt19937 random, const std::atomic<bool>& is_over) {
  while (!is_over) {
    if (!client_ || client_->ws().closed()) {
      if (!wanders_) return;
      if (!goElsewhere(port, ledger, random)) std::this_thread::sleep_for(20ms);
      continue;
    }
    if (!sendOne(ledger, random)) client_.reset();
    if (wanders_ && below(random, 60) == 0) client_.reset();
  }
}

bool Player::goElsewhere(std::uint16_t port, const Ledger& ledger, std::mt19937& random) {
  std::vector<std::string> open;
  for (const auto& [name, fact] : ledger.rooms())
    if (fact.state == RoomFact::State::kOpen) open.push_back(name);
  const std::string next = open[below(random, open.size())];
  if (next != room_) forgetPerson();
  room_ = next;
  return connect(port, ledger) || (client_.reset(), false);
}

bool Player::sendOne(Ledger& ledger, std::mt19937& random) {
  v1::Command command = choose(random);
  command.set_command_id((std::uint64_t{number_} << 32) + ++command_count_);
  auto checked = wire::checkCommand(command);
  auto* kept = std::get_if<v1::Command>(&checked);
  if (!kept) return true;             // the server would reject it, too
  scene::fillMessageDefaults(*kept);  // the scenes of these tests have room for all defaults
  const std::size_t number =
      ledger.send({.room = room_, .opening = opening_, .person_id = person_id_, .command = *kept});
  v1::ClientMessage message;
  *message.mutable_command() = command;
  client_->send(message);
  const std::uint64_t id = command.command_id();
  const auto answer = client_->waitFor([id](const v1::ServerMessage& one) {
    return (one.has_ack() && one.ack().command_id() == id) || (one.has_reject() && one.reject().command_id() == id);
  });
  if (!answer) return false;
  ledger.answer(number, *answer);
  if (answer->has_ack()) {
    promised_person_id_ = person_id_;
    if (command.has_take_boat()) boats_.push_back(command.take_boat().boat_id());
    if (answer->ack().boat_id() != 0) boats_.push_back(answer->ack().boat_id());
  } else if (answer->reject().reason() == v1::REJECT_REASON_BUSY) {
    std::this_thread::sleep_for(10ms);  // the rate of a session is bounded
  }
  return true;
}

v1::Command Player::choose(std::mt19937& random) {
  v1::Command out;
  const auto any_boat = [&] { return static_cast<std::uint32_t>(1 + below(random, 24)); };
  const auto own_boat = [&] { return boats_.empty() ? any_boat() : boats_[below(random, boats_.size())]; };
  const std::size_t dice = below(random, 200);
  if (dice < 50) {
    return at(between(random, -3.5, 3.5), between(random, -3.5, 3.5),
              splash(between(random, 0.1, 0.6), between(random, 0.5, 1.5)));
  }
  if (dice < 65) {
    out = breakingWave(v1::SIDE_MINUS_X, between(random, 0.1, 0.5), between(random, 1.0, 3.0));
    out.mutable_breaking_wave()->set_direction_deg(between(random, -180, 180));
    if (dice % 2 == 0) out.mutable_breaking_wave()->set_side(v1::SIDE_DIRECTION);
    return out;
  }
  if (dice < 82) {
    out = spawnBoat(between(random, -3.0, 3.0), between(random, -3.0, 3.0));
    out.mutable_spawn_boat()->mutable_boat()->set_length_m(between(random, 0.8, 1.6));
    out.mutable_spawn_boat()->mutable_boat()->set_beam_m(between(random, 0.4, 0.7));
    return out;
  }
  if (dice < 112) return controlBoat(own_boat(), between(random, -1, 1), between(random, -1, 1));
  if (dice < 122) return removeBoat(own_boat());
  if (dice < 124) return removeBoat(any_boat());
  if (dice < 132) return takeBoat(any_boat());
  if (dice < 164) {
    const Knob& knob = kKnobs[below(random, std::size(kKnobs))];
    const double value = between(random, knob.low, knob.high);
    return setParameter(knob.path, knob.high > 100 ? std::round(value) : value);
  }
  if (dice < 168) return setPaused(true);
  if (dice < 178) return setPaused(false);
  if (dice < 183) return setSpeed(between(random, 0.5, 2.0));
  if (dice < 196) return step(static_cast<std::uint32_t>(1 + below(random, 12)));
  if (dice < 197) return reset();
  if (dice < 198) return changeScene(kKillScenes[below(random, std::size(kKillScenes))]);
  out = changeScene(scene_);
  out.mutable_change_scene()->set_fidelity(dice < 199 ? v1::FIDELITY_DRAFT : v1::FIDELITY_BALANCED);
  return out;
}

// Rooms

void openAndCloseRooms(std::uint16_t port, const std::vector<std::string>& names, Ledger& ledger, std::mt19937 random,
                       const std::atomic<bool>& is_over) {
  while (!is_over) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50 + below(random, 300)));
    const std::string name = names[below(random, names.size())];
    const auto known = ledger.rooms();
    const auto fact = known.find(name);
    const bool is_open = fact != known.end() && fact->second.state == RoomFact::State::kOpen;
    const std::string scene = kKillScenes[below(random, std::size(kKillScenes))];
    const auto before = is_open ? RoomFact::State::kOpen : RoomFact::State::kClosed;
    ledger.setRoom(name, RoomFact::State::kUnknown);
    const HttpAnswer answer = is_open ? httpRequest(port, "DELETE", "/api/v1/rooms/" + name)
                                      : httpRequest(port, "POST", "/api/v1/rooms", "Content-Type: application/json\r\n",
                                                    R"({"name": ")" + name + R"(", "scene": ")" + scene + R"("})");
    if (answer.status == 0) return;
    if (answer.status == 201)
      ledger.setRoom(name, RoomFact::State::kOpen, scene);
    else
      ledger.setRoom(name, answer.status == 204 ? RoomFact::State::kClosed : before);
  }
}

}  // namespace spindrift::test
