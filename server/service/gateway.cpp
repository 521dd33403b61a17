#include <spindrift/service/gateway.h>
#include <spindrift/service/state_topics.h>
#include <spindrift/service/stream_index.h>
#include <spindrift/wire/server_message.h>

#include "greeting.h"

namespace spindrift::service {
namespace {

/// A room of this process, for its sessions.
class LocalRoom final : public Venue {
 public:
  /// `rooms` and `sessions` outlive it.
  LocalRoom(std::shared_ptr<rooms::Room> room, const rooms::RoomHost& rooms, Sessions& sessions)
      : room_(std::move(room)), rooms_(rooms), sessions_(sessions) {}

  [[nodiscard]] const std::string& name() const override { return room_->name(); }
  [[nodiscard]] std::shared_ptr<const VenueView> view() const override {
    return std::make_shared<const VenueView>(VenueView{.room = room_->snapshot(),
                                                       .levels = room_->vitals()->fidelity_levels,
                                                       .device = rooms_.deviceLine(),
                                                       .scenes = rooms_.rules().scenes.names(),
                                                       .room_access = room_->access(),
                                                       .grace = room_->roster().grace()});
  }
  [[nodiscard]] v1::People people() const override { return room_->roster().people(); }
  [[nodiscard]] std::shared_ptr<const rooms::LessonState> lesson() const override { return room_->lesson(); }
  [[nodiscard]] std::shared_ptr<core::DemandTable> demand() const override { return room_->demand(); }
  [[nodiscard]] bool isOpen() const override { return rooms_.find(room_->name()) == room_; }
  void arrive(const rooms::Arrival& arrival, Arrived arrived) override { arrived(room_->roster().arrive(arrival)); }
  void leave(core::SessionId session) override { room_->roster().leave(session, rooms::Roster::Clock::now()); }
  void watchesChanged() override { room_->wake(); }
  void command(const rooms::Command& command) override {
    if (const auto rejection = room_->admit(command)) sessions_.commandRejected(command, *rejection);
  }

 private:
  const std::shared_ptr<rooms::Room> room_;
  const rooms::RoomHost& rooms_;
  Sessions& sessions_;
};

}  // namespace

Gateway::Gateway(AccessOptions access, const SessionRules& rules, const MetricsSources& sources,
                 std::function<void()> on_drain, RecordingRules recordings)
    : access_(std::move(access)),
      sessions_(rules, access_, counters_),
      recordings_(std::move(recordings),
                  [this, rules](const std::shared_ptr<rooms::Room>& room) {
                    const LocalRoom venue(room, simulation(), sessions_);
                    return greetingOf(venue, *venue.view(), 0, rules);
                  }),
      rest_(
          access_, counters_, sources, recordings_, [this](const rooms::Room& room) { sessions_.dismiss(room.name()); },
          std::move(on_drain)) {}

void Gateway::serve(rooms::RoomHost& rooms, rooms::EncoderThread& encoder) {
  rooms_ = &rooms;
  encoder_ = &encoder;
  rest_.serve(rooms);
}

void Gateway::join(const ClusterHooks& cluster) {
  cluster_ = cluster;
  rest_.join(cluster);
}

std::shared_ptr<Venue> Gateway::find(const std::string& room) {
  if (auto here = simulation().find(room)) return std::make_shared<LocalRoom>(std::move(here), simulation(), sessions_);
  return cluster_.cluster ? cluster_.cluster->find(room) : nullptr;
}

core::Result<void> Gateway::acceptSession(const std::string& room) {
  if (simulation().find(room)) return {};
  if (cluster_.cluster) return cluster_.cluster->accept(room);
  std::string names;
  for (const auto& known : simulation().rooms()) names += (names.empty() ? "" : ", ") + known->name();
  return core::Error{core::ErrorCode::kInvalidInput, "room '" + room + "' does not exist; rooms are: " + names};
}

void Gateway::sessionOpened(net::SessionId session, const net::SessionOpening& opening) {
  if (auto venue = find(opening.room)) return sessions_.opened(session, std::move(venue), opening);
  sessions_.refuse(session, net::CloseCode::kRoomClosed, "the room was closed");
}

void Gateway::drain(net::Server& network, std::chrono::milliseconds closes_in, const std::string& go_to) {
  rest_.drain();
  sessions_.drain(network, closes_in, go_to);
}

// Reports of rooms

void Gateway::tell(const rooms::Room& room, const net::StateTopic& topic, const core::SharedBytes& message) {
  hub().broadcastState(room.name(), topic, message);
  recordings_.tell(room.name(), message);
  if (cluster_.audience) cluster_.audience->stateChanged(room, topic, message);
}

void Gateway::sceneChanged(const rooms::Room& room) {
  if (const auto here = simulation().find(room.name())) {
    sessions_.roomChanged(LocalRoom(here, simulation(), sessions_));
    recordings_.sceneChanged(here);
  }
  if (cluster_.audience) cluster_.audience->sceneChanged(room);
}

void Gateway::timeChanged(const rooms::Room& room, const v1::RoomState& state) {
  tell(room, topic::kRoomState, wire::roomState(state));
}

void Gateway::clockChanged(const rooms::Room& room, const std::string& how, std::uint32_t person_id) {
  tell(room, topic::kClock, wire::roomEvent(v1::ROOM_EVENT_KIND_CLOCK, room.tick(), how, person_id));
}

void Gateway::parameterChanged(const rooms::Room& room, const std::string& path, double value) {
  tell(room, topic::ofParameter(path), wire::parameterChanged(path, value, room.tick()));
}

void Gateway::boatsChanged(const rooms::Room& room, const v1::BoatList& boats) {
  tell(room, topic::kBoats, wire::boatList(boats));
}

void Gateway::peopleChanged(const rooms::Room& room, const v1::People& people) {
  tell(room, topic::kPeople, wire::people(people));
}

void Gateway::strokesChanged(const rooms::Room& room, const v1::Strokes& strokes) {
  tell(room, topic::kStrokes, wire::strokes(strokes));
}

void Gateway::lessonChanged(const rooms::Room& room, const v1::Lesson& lesson) {
  tell(room, topic::kLesson, wire::lesson(lesson));
}

void Gateway::gameChanged(const rooms::Room& room, const v1::Game& game) {
  tell(room, topic::kGame, wire::game(game));
}

void Gateway::wasReset(const rooms::Room& room, std::uint32_t person_id) {
  tell(room, topic::kReset,
       wire::roomEvent(v1::ROOM_EVENT_KIND_RESET, room.tick(), "the scene has started again", person_id));
}

void Gateway::hasRecovered(const rooms::Room& room, const std::string& how) {
  tell(room, topic::kRecovered, wire::roomEvent(v1::ROOM_EVENT_KIND_RECOVERED, room.tick(), how));
}

void Gateway::fidelityChanged(const rooms::Room& room, const std::string& how) {
  tell(room, topic::kFidelity, wire::roomEvent(v1::ROOM_EVENT_KIND_FIDELITY, room.tick(), how));
}

void Gateway::closed(const rooms::Room& room) {
  encoder_->forget(room.name());
  recordings_.roomClosed(room.name());
  if (cluster_.audience) cluster_.audience->closed(room);
}

void Gateway::queryAnswered(const rooms::Room&, const core::Sender& sender, const v1::QueryAnswer& answer) {
  if (sender.request_id != 0) return rest_.queryAnswered(sender, answer);
  if (cluster_.audience && cluster_.audience->queryAnswered(sender, answer)) return;
  sessions_.queryAnswered(sender.session_id, answer);
}

void Gateway::hullsFelt(const rooms::Room&, const core::Sender& sender, const v1::HullForces& forces) {
  if (sender.request_id != 0) return;  // a request has had its answer
  if (cluster_.audience && cluster_.audience->hullsFelt(sender, forces)) return;
  sessions_.hullsFelt(sender.session_id, forces);
}

void Gateway::frameReady(const rooms::Room& room, core::FrameView frame) {
  encoder_->submit(room.name(), room.demand(), std::move(frame));
}

void Gateway::publish(const std::string& room, codec::Stream stream, const codec::EncodedFrame& frame,
                      const core::FrameLevels& levels) {
  publishTo(hub(), room, stream, frame, levels);
  recordings_.publish(room, stream, frame, levels);
  if (cluster_.audience) cluster_.audience->publish(room, stream, frame, levels);
}

void Gateway::commandApplied(const rooms::Command& command, const v1::Ack& ack) {
  counters_.applied();
  access_.audit().applied(command, ack.applied_tick());
  if (command.sender.request_id != 0) return rest_.commandApplied(command, ack);
  if (cluster_.audience && cluster_.audience->commandApplied(command, ack)) return;
  sessions_.commandApplied(command, ack);
}

void Gateway::commandRejected(const rooms::Command& command, const wire::CommandRejection& rejection) {
  if (command.sender.request_id != 0) return rest_.commandRejected(command, rejection);
  if (cluster_.audience && cluster_.audience->commandRejected(command, rejection)) {
    counters_.rejected(rejection.reason());
    return access_.audit().rejected(command, rejection);
  }
  sessions_.commandRejected(command, rejection);
}

void Gateway::httpRequest(const net::HttpRequest& request, net::HttpResponder respond) {
  if (cluster_.cluster && cluster_.cluster->takeRequest(request, respond)) return;
  rest_.answer(request, std::move(respond));
}

}  // namespace spindrift::service
