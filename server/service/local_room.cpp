#include "local_room.h"

#include <spindrift/service/sessions.h>

namespace spindrift::service {

std::shared_ptr<const VenueView> LocalRoom::view() const {
  return std::make_shared<const VenueView>(VenueView{.room = room_->snapshot(),
                                                     .levels = room_->vitals()->fidelity_levels,
                                                     .device = rooms_.deviceLine(),
                                                     .scenes = rooms_.rules().scenes.names(),
                                                     .room_access = room_->access(),
                                                     .grace = room_->roster().grace()});
}

void LocalRoom::command(const rooms::Command& command) {
  if (const auto rejection = room_->admit(command)) sessions_.commandRejected(command, *rejection);
}

}  // namespace spindrift::service
