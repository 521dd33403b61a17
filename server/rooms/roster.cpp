#include <algorithm>
#include <array>
#include <random>

#include <fmt/format.h>

#include <spindrift/classroom/lesson.h>
#include <spindrift/rooms/roster.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::rooms {
namespace {

/// Distinguishable from each other and from water.
constexpr std::array<std::uint32_t, 10> kColors{0xE4572E, 0xF3A712, 0x9BC53D, 0xC3423F, 0xFDE74C,
                                                0x8E4585, 0xFF6F91, 0x5BC0BE, 0xD4A373, 0xF7F7FF};

/// Returns 128 random bits from the operating system.
std::string newSecret() {
  std::random_device device;
  std::string out;
  for (int k = 0; k < 4; ++k) out += fmt::format("{:08x}", static_cast<std::uint32_t>(device()));
  return out;
}

}  // namespace

Admission Roster::arrive(const Arrival& arrival) {
  const News news{*this};
  const std::lock_guard lock(mutex_);
  changed();
  Admission out;
  const auto known = std::ranges::find_if(people_, [&](const auto& entry) {
    return !arrival.resume_key.empty() && entry.second.resume_key == arrival.resume_key;
  });
  out.resumed = known != people_.end();
  out.person_id = out.resumed ? known->first : ++last_person_id_;
  Person& person = people_[out.person_id];
  if (out.resumed && person.session != 0) out.displaced = person.session;
  if (!out.resumed) {
    person.resume_key = newSecret();
    person.name = fmt::format("guest {}", out.person_id);
    person.color_rgb = kColors[out.person_id % kColors.size()];
  }
  if (!arrival.name.empty()) person.name = arrival.name;
  if (arrival.color_rgb != 0) person.color_rgb = arrival.color_rgb;
  person.role = arrival.role;
  if (lesson_.teams() && person.role == core::Role::kPlayer && person.team == v1::TEAM_UNSPECIFIED)
    person.team = smallerTeam();
  person.session = arrival.session;
  person.boats_stopped = false;
  person.waits = false;
  out.resume_key = person.resume_key;
  return out;
}

void Roster::leave(core::SessionId session, Clock::time_point now) {
  const News news{*this};
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find_if(people_, [&](const auto& entry) { return entry.second.session == session; });
  if (session == 0 || found == people_.end()) return;
  changed();
  if (!found->second.isKept()) {
    people_.erase(found);
    return;
  }
  found->second.session = 0;
  found->second.away_since = now;
}

std::uint32_t Roster::ownerOf(std::uint32_t boat_id) const {
  const std::lock_guard lock(mutex_);
  for (const auto& [id, person] : people_) {
    if (person.boats.contains(boat_id)) return id;
  }
  return 0;
}

bool Roster::hasBoat(std::uint32_t person_id) const {
  const std::lock_guard lock(mutex_);
  const auto found = people_.find(person_id);
  return found != people_.end() && !found->second.boats.empty();
}

void Roster::give(std::uint32_t boat_id, std::uint32_t person_id) {
  const std::lock_guard lock(mutex_);
  const auto found = people_.find(person_id);
  if (found == people_.end()) return;
  for (auto& [id, person] : people_) person.boats.erase(boat_id);
  found->second.boats.insert(boat_id);
  changed();
}

void Roster::keepOnly(const std::set<std::uint32_t>& boat_ids) {
  const std::lock_guard lock(mutex_);
  for (auto& [id, person] : people_) {
    if (std::erase_if(person.boats, [&](std::uint32_t boat) { return !boat_ids.contains(boat); }) > 0) changed();
  }
}

bool Roster::isHere(std::uint32_t person_id) const {
  const std::lock_guard lock(mutex_);
  return people_.contains(person_id);
}

bool Roster::hasActorsBeside(std::uint32_t person_id) const {
  const std::lock_guard lock(mutex_);
  return std::ranges::any_of(people_, [&](const auto& entry) {
    return entry.first != person_id && entry.second.session != 0 && entry.second.role >= core::Role::kPlayer;
  });
}

std::string Roster::nameOf(std::uint32_t person_id) const {
  const std::lock_guard lock(mutex_);
  const auto found = people_.find(person_id);
  return found != people_.end() ? fmt::format("{} (person {})", found->second.name, person_id)
                                : fmt::format("person {}", person_id);
}

bool Roster::isConnected(std::uint32_t person_id, core::SessionId session) const {
  const std::lock_guard lock(mutex_);
  const auto found = people_.find(person_id);
  return found != people_.end() && found->second.session == session;
}

void Roster::setGaugeOwners(const std::set<std::uint32_t>& person_ids) {
  const std::lock_guard lock(mutex_);
  for (auto& [id, person] : people_) person.has_gauges = person_ids.contains(id);
}

std::vector<Roster::BoatOwner> Roster::boatOwners() const {
  const std::lock_guard lock(mutex_);
  std::vector<BoatOwner> out;
  for (const auto& [id, person] : people_) {
    for (const std::uint32_t boat : person.boats) out.push_back({boat, id, person.role, person.team});
  }
  return out;
}

v1::Lesson Roster::lesson() const {
  const std::lock_guard lock(mutex_);
  return lesson_;
}

double Roster::forceRatio() const {
  const std::lock_guard lock(mutex_);
  return lesson_.has_force_ratio() ? lesson_.force_ratio() : 1.0;
}

v1::Team Roster::smallerTeam() const {
  const auto count = [&](v1::Team team) {
    return std::ranges::count_if(people_, [&](const auto& entry) { return entry.second.team == team; });
  };
  return count(v1::TEAM_BLUE) < count(v1::TEAM_RED) ? v1::TEAM_BLUE : v1::TEAM_RED;
}

void Roster::setLesson(const v1::Lesson& lesson) {
  const News news{*this};
  const std::lock_guard lock(mutex_);
  changed();
  const bool had_teams = lesson_.teams();
  lesson_ = lesson;
  if (had_teams == lesson_.teams()) return;
  for (auto& [id, person] : people_) person.team = v1::TEAM_UNSPECIFIED;
  if (!lesson_.teams()) return;
  for (auto& [id, person] : people_) {
    if (person.role == core::Role::kPlayer) person.team = smallerTeam();
  }
}

bool Roster::mute(std::uint32_t person_id, bool is_muted) {
  const News news{*this};
  const std::lock_guard lock(mutex_);
  const auto found = people_.find(person_id);
  if (found == people_.end()) return false;
  found->second.is_muted = is_muted;
  changed();
  return true;
}

bool Roster::setTeam(std::uint32_t person_id, v1::Team team) {
  const News news{*this};
  const std::lock_guard lock(mutex_);
  const auto found = people_.find(person_id);
  if (found == people_.end()) return false;
  found->second.team = team;
  changed();
  return true;
}

std::optional<wire::CommandRejection> Roster::refuse(const core::Sender& sender, const v1::Command& command) const {
  const std::lock_guard lock(mutex_);
  const auto person = people_.find(sender.person_id);
  return rooms::refuse(lesson_, person != people_.end() && person->second.is_muted, sender.role, command);
}

Roster::Turn Roster::settle(Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  Turn out;
  for (auto it = people_.begin(); it != people_.end();) {
    Person& person = it->second;
    if (person.session == 0 && !person.boats_stopped) {
      person.boats_stopped = true;
      out.boats_to_stop.insert(out.boats_to_stop.end(), person.boats.begin(), person.boats.end());
    }
    if (person.session == 0 && (!person.isKept() || now - person.away_since >= grace_)) {
      it = people_.erase(it);
      changed();
    } else {
      ++it;
    }
  }
  out.is_news = std::exchange(is_news_, false);
  return out;
}

v1::People Roster::people() const {
  const std::lock_guard lock(mutex_);
  v1::People out;
  for (const auto& [id, person] : people_) {
    v1::Person& wire = *out.add_people();
    wire.set_person_id(id);
    wire.set_name(person.name);
    wire.set_color_rgb(person.color_rgb);
    wire.set_role(wire::toWire(person.role));
    for (const std::uint32_t boat : person.boats) wire.add_boat_ids(boat);
    wire.set_away(person.session == 0);
    wire.set_team(person.team);
    wire.set_muted(person.is_muted);
  }
  out.set_unlisted_count(unlisted_count_);
  return out;
}

std::size_t Roster::presentCount() const {
  const std::lock_guard lock(mutex_);
  const auto listed = std::ranges::count_if(people_, [](const auto& entry) { return entry.second.session != 0; });
  return static_cast<std::size_t>(listed) + unlisted_count_;
}

void Roster::setUnlistedCount(std::uint32_t count) {
  const News news{*this};
  const std::lock_guard lock(mutex_);
  // News, but nothing that is kept on disk.
  is_news_ = is_news_ || count != unlisted_count_;
  unlisted_count_ = count;
}

std::uint64_t Roster::version() const {
  const std::lock_guard lock(mutex_);
  return version_;
}

v1::RoomPeople Roster::kept() const {
  const std::lock_guard lock(mutex_);
  v1::RoomPeople out;
  for (const auto& [id, person] : people_) {
    v1::KeptPerson& kept = *out.add_people();
    kept.set_person_id(id);
    kept.set_name(person.name);
    kept.set_color_rgb(person.color_rgb);
    kept.set_role(wire::toWire(person.role));
    kept.set_resume_key(person.resume_key);
    for (const std::uint32_t boat : person.boats) kept.add_boat_ids(boat);
    kept.set_team(person.team);
    kept.set_muted(person.is_muted);
  }
  out.set_last_person_id(last_person_id_);
  *out.mutable_lesson() = lesson_;
  return out;
}

void Roster::restore(const v1::RoomPeople& people, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  people_.clear();
  for (const v1::KeptPerson& kept : people.people()) {
    Person& person = people_[kept.person_id()];
    person.name = kept.name();
    person.color_rgb = kept.color_rgb();
    person.role = wire::fromWire(kept.role()).value_or(core::Role::kViewer);
    person.resume_key = kept.resume_key();
    person.boats.insert(kept.boat_ids().begin(), kept.boat_ids().end());
    person.team = kept.team();
    person.is_muted = kept.muted();
    person.away_since = now;
    person.waits = true;
  }
  last_person_id_ = people.last_person_id();
  lesson_ = people.lesson();
  changed();
}

}  // namespace spindrift::rooms
