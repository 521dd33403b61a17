// A room of this process, for its sessions.
#pragma once

#include <memory>
#include <string>

#include <spindrift/rooms/simulation_thread.h>
#include <spindrift/service/venue.h>

namespace spindrift::service {

class Sessions;

class LocalRoom final : public Venue {
 public:
  /// `rooms` and `sessions` outlive it.
  LocalRoom(std::shared_ptr<rooms::Room> room, const rooms::SimulationThread& rooms, Sessions& sessions)
      : room_(std::move(room)), rooms_(rooms), sessions_(sessions) {}

  [[nodiscard]] const std::string& name() const override { return room_->name(); }
  [[nodiscard]] std::shared_ptr<const VenueView> view() const override;
  [[nodiscard]] v1::People people() const override { return room_->roster().people(); }
  [[nodiscard]] std::shared_ptr<core::DemandTable> demand() const override { return room_->demand(); }
  [[nodiscard]] bool isOpen() const override { return rooms_.find(room_->name()) == room_; }
  void arrive(const rooms::Arrival& arrival, Arrived arrived) override { arrived(room_->roster().arrive(arrival)); }
  void leave(core::SessionId session) override { room_->roster().leave(session, rooms::Roster::Clock::now()); }
  void watchesChanged() override { room_->wake(); }
  void command(const rooms::Command& command) override;

 private:
  const std::shared_ptr<rooms::Room> room_;
  const rooms::SimulationThread& rooms_;
  Sessions& sessions_;
};

}  // namespace spindrift::service
