// Outlets of a room that nobody watches.
#pragma once

#include <spindrift/rooms/room.h>

namespace spindrift::test {

struct SilentOutlets : rooms::RoomOutlets {
  void sceneChanged(const rooms::Room&) override {}
  void timeChanged(const rooms::Room&, const v1::RoomState&) override {}
  void clockChanged(const rooms::Room&, const std::string&, std::uint32_t) override {}
  void parameterChanged(const rooms::Room&, const std::string&, double) override {}
  void boatsChanged(const rooms::Room&, const v1::BoatList&) override {}
  void peopleChanged(const rooms::Room&, const v1::People&) override {}
  void strokesChanged(const rooms::Room&, const v1::Strokes&) override {}
  void lessonChanged(const rooms::Room&, const v1::Lesson&) override {}
  void gameChanged(const rooms::Room&, const v1::Game&) override {}
  void wasReset(const rooms::Room&, std::uint32_t) override {}
  void fidelityChanged(const rooms::Room&, const std::string&) override {}
  void hasRecovered(const rooms::Room&, const std::string&) override {}
  void closed(const rooms::Room&) override {}
  void commandApplied(const rooms::Command&, const v1::Ack&) override {}
  void commandRejected(const rooms::Command&, const wire::CommandRejection&) override {}
  void queryAnswered(const rooms::Room&, const core::Sender&, const v1::QueryAnswer&) override {}
  void frameReady(const rooms::Room&, core::FrameView) override {}
};

}  // namespace spindrift::test
