// The only output interface of a room. The service's gateway implements it; rooms know nothing of sessions and
// messages.
#pragma once

#include <cstdint>
#include <string>

#include <spindrift/core/frame_view.h>
#include <spindrift/rooms/command.h>
#include <spindrift/v1/wire.pb.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::rooms {

class Room;

/// Called on the simulation thread; must not block. Changes are reported once per round, before the answers to the
/// commands that caused them.
class RoomOutlets {
 public:
  virtual ~RoomOutlets() = default;

  /// The room's scene was replaced; the snapshot shows the new scene.
  virtual void sceneChanged(const Room& room) = 0;
  /// Pause, speed, or who holds the clock.
  virtual void timeChanged(const Room& room, const v1::RoomState& state) = 0;
  /// Somebody took the clock, gave it back, or lost it; `how` is one line for people, and timeChanged() came before.
  /// `person_id`: whose command it was; 0: nobody's in the room. The same below.
  virtual void clockChanged(const Room& room, const std::string& how, std::uint32_t person_id) = 0;
  virtual void parameterChanged(const Room& room, const std::string& path, double value) = 0;
  virtual void boatsChanged(const Room& room, const v1::BoatList& boats) = 0;
  virtual void peopleChanged(const Room& room, const v1::People& people) = 0;
  /// The fingers in the water, while there are any; an empty list after the last one.
  virtual void strokesChanged(const Room& room, const v1::Strokes& strokes) = 0;
  virtual void lessonChanged(const Room& room, const v1::Lesson& lesson) = 0;
  /// The game as it stands, up to 5 times per second while it runs.
  virtual void gameChanged(const Room& room, const v1::Game& game) = 0;
  /// A client reset the scene to its start.
  virtual void wasReset(const Room& room, std::uint32_t person_id) = 0;
  /// The watchdog or a new device restored the water; `how` is one line for people.
  virtual void hasRecovered(const Room& room, const std::string& how) = 0;
  /// The same water continues at another fidelity, after sceneChanged(); `how` is one line for people.
  virtual void fidelityChanged(const Room& room, const std::string& how) = 0;
  /// The room is about to be destroyed.
  virtual void closed(const Room& room) = 0;

  /// The answer contains the command's number.
  virtual void commandApplied(const Command& command, const v1::Ack& ack) = 0;
  /// The rejection contains the command's number.
  virtual void commandRejected(const Command& command, const wire::CommandRejection& rejection) = 0;

  /// The surface at the points that this sender asks for, at one tick; it belongs to its queries only.
  virtual void queryAnswered(const Room& room, const core::Sender& sender, const v1::QueryAnswer& answer) = 0;

  /// A frame that the room's demand() asked for. It occupies a slot of device memory until it is dropped.
  virtual void frameReady(const Room& room, core::FrameView frame) = 0;
};

}  // namespace spindrift::rooms
