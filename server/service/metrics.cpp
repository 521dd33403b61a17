#include <cctype>
#include <chrono>

#include <fmt/format.h>

#include <spindrift/core/text.h>
#include <spindrift/scene/fidelity.h>
#include <spindrift/service/metrics.h>

namespace spindrift::service {
namespace {

/// Collects samples by name, because the format requires all samples of one name together.
class Page {
 public:
  void head(const char* name, const char* type, const char* help) {
    text_ += fmt::format("# HELP spindrift_{} {}\n# TYPE spindrift_{} {}\n", name, help, name, type);
    name_ = name;
  }
  /// `labels`: those of metricLabel(), with ',' between them.
  template <typename Number>
  void sample(const std::string& labels, Number value) {
    text_ += labels.empty() ? fmt::format("spindrift_{} {}\n", name_, value)
                            : fmt::format("spindrift_{}{{{}}} {}\n", name_, labels, value);
  }
  /// The only sample of a name, without labels.
  template <typename Number>
  void one(const char* name, const char* type, const char* help, Number value) {
    head(name, type, help);
    sample("", value);
  }
  /// A sample whose name is that of head() and an ending, as those of a histogram.
  template <typename Number>
  void part(const char* ending, const std::string& labels, Number value) {
    text_ += fmt::format("spindrift_{}_{}{{{}}} {}\n", name_, ending, labels, value);
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
  std::string name_;
};

/// "REJECT_REASON_OUT_OF_RANGE" -> "out_of_range".
std::string shortName(const std::string& name, std::size_t prefix_bytes) {
  std::string out = name.substr(prefix_bytes);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

struct RoomSample {
  std::string label;
  std::size_t session_count;
  int person_count;
  std::shared_ptr<const rooms::RoomSnapshot> snapshot;
  std::shared_ptr<const rooms::RoomVitals> vitals;
  rooms::EncoderThread::FrameCounts frames;
};

void writeTickTimes(Page& page, const std::vector<RoomSample>& rooms) {
  page.head("room_tick_seconds", "histogram", "Times of the ticks on the room's thread.");
  for (const RoomSample& room : rooms) {
    const rooms::TickTimes& times = room.vitals->tick_times;
    std::uint64_t count = 0;
    for (std::size_t k = 0; k < times.counts().size(); ++k) {
      count += times.counts()[k];
      const bool is_last = k == rooms::TickTimes::kBounds_s.size();
      const std::string bound = is_last ? "+Inf" : fmt::format("{}", rooms::TickTimes::kBounds_s[k]);
      page.part("bucket", room.label + "," + metricLabel("le", bound), count);
    }
    page.part("sum", room.label, times.sum_s());
    page.part("count", room.label, count);
  }
}

/// Of the rooms that are kept on disk.
void writeKept(Page& page, const std::vector<std::shared_ptr<rooms::Room>>& rooms) {
  using Status = history::StateKeeper::Status;
  std::vector<std::pair<std::string, Status>> kept;
  for (const auto& room : rooms) {
    if (auto status = room->keptStatus()) kept.emplace_back(metricLabel("room", room->name()), *status);
  }
  if (kept.empty()) return;
  const auto each = [&](const char* name, const char* type, const char* help, auto&& value) {
    page.head(name, type, help);
    for (const auto& [label, status] : kept) page.sample(label, value(status));
  };
  each("state_snapshots_total", "counter", "Snapshots of a room written to disk.",
       [](const Status& s) { return s.snapshot_count; });
  each("state_failures_total", "counter", "Snapshots and records that could not be written to disk.",
       [](const Status& s) { return s.failure_count; });
  each("state_snapshot_age_seconds", "gauge", "Time since the state in the newest snapshot.",
       [](const Status& s) { return s.since_snapshot_s; });
  each("state_snapshot_bytes", "gauge", "Size of the newest snapshot.",
       [](const Status& s) { return s.files.snapshot_bytes; });
  each("state_snapshot_copy_seconds", "gauge", "Time for which the room stood still for the last snapshot.",
       [](const Status& s) { return s.copy_s; });
  each("state_snapshot_write_seconds", "gauge", "Time that the last snapshot took to write, beside the room.",
       [](const Status& s) { return s.write_s; });
  each("state_log_bytes", "gauge", "Size of the log since that snapshot.",
       [](const Status& s) { return s.files.log_bytes; });
}

void writeRooms(Page& page, const std::vector<RoomSample>& rooms) {
  const auto each = [&](const char* name, const char* type, const char* help, auto&& value) {
    page.head(name, type, help);
    for (const RoomSample& room : rooms) page.sample(room.label, value(room));
  };
  using Sample = const RoomSample&;
  each("room_ticks_total", "counter", "Ticks since the room opened.", [](Sample r) { return r.vitals->tick; });
  each("room_real_time_factor", "gauge", "Simulated seconds per second over the last second; 0 while paused or asleep.",
       [](Sample r) { return r.vitals->diagnostics.real_time_factor; });
  each("room_speed", "gauge", "Simulated seconds per second that are asked for; 0 while paused.",
       [](Sample r) { return r.snapshot->paused ? 0.0 : r.snapshot->speed; });
  each("room_fidelity", "gauge", "Fidelity level: 0 draft, 1 balanced, 2 fine, 3 reference.",
       [](Sample r) { return scene::rankOf(r.snapshot->scene.fidelity()); });
  each("room_asleep", "gauge", "1 while nobody is connected and the scene sleeps then.",
       [](Sample r) { return r.vitals->asleep ? 1 : 0; });
  each("room_lost", "gauge", "1 while the device has failed and the water is built again.",
       [](Sample r) { return r.vitals->lost ? 1 : 0; });
  each("room_step_seconds", "gauge", "Time of a tick on the room's thread, mean of the last quarter second.",
       [](Sample r) { return r.vitals->diagnostics.step_ms / 1e3; });
  each("room_substeps", "gauge", "Substeps per tick.", [](Sample r) { return r.vitals->diagnostics.substeps_count; });
  each("room_particles", "gauge", "Particles now.", [](Sample r) { return r.vitals->diagnostics.particle_count; });
  each("room_device_bytes", "gauge", "Memory of the room's water on its device.",
       [](Sample r) { return r.vitals->device_bytes; });
  each("room_boats", "gauge", "Boats on the water.", [](Sample r) { return r.vitals->diagnostics.boat_count; });
  each("room_sessions", "gauge", "Sessions in the room.", [](Sample r) { return r.session_count; });
  each("room_people", "gauge", "People in the room, those away included.", [](Sample r) { return r.person_count; });
  each("room_command_queue", "gauge", "Commands that wait for the next tick.",
       [](Sample r) { return r.vitals->waiting_command_count; });
  each("room_frames_dropped_total", "counter", "Frames not read back because earlier ones were still on their way.",
       [](Sample r) { return r.vitals->dropped_frame_count; });
  each("room_frames_encoded_total", "counter", "Frames of the room that the encoder took.",
       [](Sample r) { return r.frames.encoded_count; });
  each("room_frames_replaced_total", "counter", "Frames that a newer one replaced before they were encoded.",
       [](Sample r) { return r.frames.replaced_count; });
  each("room_recovered_total", "counter", "Times the watchdog put the water back to its last good state.",
       [](Sample r) { return r.vitals->diagnostics.recovered_count; });
  each("room_nonfinite_total", "counter", "Numbers that were not finite, seen by the watchdog.",
       [](Sample r) { return r.vitals->diagnostics.nonfinite_count; });
  each("room_escaped_total", "counter", "Particles that left the domain, seen by the watchdog.",
       [](Sample r) { return r.vitals->diagnostics.escaped_count; });
  each("room_volume_error_units", "gauge", "Error of the ledger of the water's volume; 0 in a healthy room.",
       [](Sample r) { return r.vitals->diagnostics.volume_error_units; });
  using Reading = core::DiagnosticsView::GaugeNow;
  const auto eachGauge = [&](const char* name, const char* help, double Reading::*value) {
    page.head(name, "gauge", help);
    for (const RoomSample& room : rooms) {
      for (const Reading& gauge : room.vitals->diagnostics.gauges) {
        if (gauge.gauge_id != 0) continue;  // those of people come and go: each would be a new series of the scraper
        page.sample(room.label + "," + metricLabel("gauge", gauge.name), gauge.*value);
      }
    }
  };
  eachGauge("room_gauge_elevation_meters", "Elevation of the water at a gauge of the scene.", &Reading::elevation_m);
  eachGauge("room_gauge_highest_meters", "The highest since the start of the scene.", &Reading::highest_m);
  eachGauge("room_gauge_lowest_meters", "The lowest since the start of the scene.", &Reading::lowest_m);
  eachGauge("room_gauge_velocity_x_mps", "Velocity of the water along x at a gauge.", &Reading::velocity_x_mps);
  eachGauge("room_gauge_velocity_z_mps", "Velocity of the water along z at a gauge.", &Reading::velocity_z_mps);
  page.head("room_pass_seconds", "gauge", "Device time of a pass in a tick, where the device can tell.");
  for (const RoomSample& room : rooms) {
    for (const auto& pass : room.vitals->diagnostics.passes) {
      page.sample(room.label + "," + metricLabel("pass", pass.name), pass.ms / 1e3);
    }
  }
}

void writeNetwork(Page& page, const net::ServerStats& stats) {
  page.one("sessions", "gauge", "WebSocket sessions open now.", stats.open_session_count);
  page.one("sessions_accepted_total", "counter", "WebSocket sessions since the start.", stats.accepted_session_count);
  page.one("connections", "gauge", "TCP connections open now, those of sessions included.",
           stats.open_connection_count);
  page.one("connections_max", "gauge", "TCP connections that may be open at a time.", stats.connection_max_count);
  page.one("failed_accepts_total", "counter", "Times that the system had no descriptor or memory for a new connection.",
           stats.failed_accept_count);
  page.one("silent_sessions_total", "counter", "Sessions cut off because nothing came from them, not even pongs.",
           stats.silent_session_count);
  page.one("sent_bytes_total", "counter", "Bytes of messages sent, without WebSocket headers.", stats.sent_bytes_count);
  page.one("sent_frames_total", "counter", "Layer frames sent.", stats.sent_frame_count);
  page.one("session_writes_total", "counter", "Writes to sessions, of one or more messages each.", stats.write_count);
  page.one("session_writes_waiting_total", "counter", "Writes that the kernel did not take at once; with TLS all.",
           stats.waiting_write_count);
  page.one("dropped_frames_total", "counter", "Layer frames that a newer one replaced before they were sent.",
           stats.dropped_frame_count);
  page.one("evicted_sessions_total", "counter", "Sessions that did not read: a stalled write or a full control queue.",
           stats.evicted_session_count);
  page.one("lowered_levels_total", "counter", "Times a session was given a lower level of detail.",
           stats.lowered_level_count);
  page.one("raised_levels_total", "counter", "Times a session was given a higher level of detail again.",
           stats.raised_level_count);
  page.one("delayed_messages_total", "counter", "Messages that waited for the rate of their address.",
           stats.delayed_message_count);
  page.one("control_queue", "gauge", "Control messages that wait to be sent, over all sessions.",
           stats.waiting_control_count);
  page.one("frame_queue", "gauge", "Layer frames that wait to be sent, over all sessions.", stats.waiting_frame_count);
  page.one("tls_handshakes_total", "counter", "TLS handshakes that were completed.", stats.tls_handshake_count);
  page.one("tls_handshakes_failed_total", "counter", "Connections to the TLS port that came to no session of TLS.",
           stats.failed_tls_handshake_count);
  page.one("tls_reloads_total", "counter", "Times that a changed certificate was taken over.", stats.tls_reload_count);
  page.one("tls_reloads_failed_total", "counter", "Times that a changed certificate could not be used.",
           stats.failed_tls_reload_count);
  page.head("tls_certificate_expires_seconds", "gauge", "Time until the certificate expires; only with TLS.");
  if (stats.certificate_expires) {
    const auto left = *stats.certificate_expires - std::chrono::system_clock::now();
    page.sample("", std::chrono::duration<double>(left).count());
  }
  page.head("refused_total", "counter", "Requests and upgrades refused before they reached a room.");
  for (std::size_t k = 0; k < net::kRefusedCount; ++k) {
    page.sample(metricLabel("reason", net::kRefusedNames[k]), stats.refused_count[k]);
  }
  page.head("sessions_closed_total", "counter", "Sessions ended, by close code; 0: the connection broke.");
  for (const auto& [code, count] : stats.closed_by_code) page.sample(metricLabel("code", std::to_string(code)), count);
}

void writeFaults(Page& page, const rooms::RoomHost& rooms) {
  using core::ErrorCode;
  page.head("water_failures_total", "counter", "Waters of rooms that could not be built, by cause.");
  for (const auto& [cause, code] :
       {std::pair("memory", ErrorCode::kUnavailable), std::pair("driver", ErrorCode::kInternal),
        std::pair("device", ErrorCode::kNoDevice), std::pair("scene", ErrorCode::kInvalidInput)}) {
    page.sample(metricLabel("cause", cause), rooms.waterFailureCount(code));
  }
  page.one("clock_steps_total", "counter", "Times that the system's clock was set.", rooms.clockStepCount());
}

void writeEncoder(Page& page, const rooms::EncoderThread& encoder) {
  const auto costs = encoder.costs();
  const auto each = [&](const char* name, const char* help, auto&& value) {
    page.head(name, "counter", help);
    for (const codec::Stream stream : codec::allStreams()) {
      for (const core::Level level : core::kLevels) {
        const rooms::EncoderThread::StreamCost& cost = costs[codec::indexOf(stream)][core::indexOf(level)];
        if (level != core::Level::kFull && cost.frame_count == 0) continue;  // no client has used this level so far
        page.sample(metricLabel("layer", shortName(v1::Layer_Name(stream.layer), sizeof("LAYER"))) + "," +
                        metricLabel("packing", shortName(v1::Packing_Name(stream.packing), sizeof("PACKING"))) + "," +
                        metricLabel("level", codec::nameOf(level)),
                    value(cost));
      }
    }
  };
  using Cost = const rooms::EncoderThread::StreamCost&;
  each("encoded_frames_total", "Frames encoded, once each whatever the number of clients.",
       [](Cost c) { return c.frame_count; });
  each("encoded_bytes_total", "Bytes of encoded frames.", [](Cost c) { return c.bytes_count; });
  each("encode_seconds_total", "Time spent encoding.", [](Cost c) { return c.encode_s; });
}

void writeCommands(Page& page, const CommandCounters& commands) {
  page.one("commands_applied_total", "counter", "Commands carried out.", commands.appliedCount());
  page.head("commands_rejected_total", "counter", "Commands not carried out, by reason.");
  for (int k = v1::RejectReason_MIN + 1; k < v1::RejectReason_ARRAYSIZE; ++k) {
    const auto reason = static_cast<v1::RejectReason>(k);
    page.sample(metricLabel("reason", nameOf(reason)), commands.rejectedCount(reason));
  }
}

void writeAccess(Page& page, const AccessControl& access) {
  page.one("person_busy_total", "counter", "Commands rejected because one person sent too many, over all sessions.",
           access.people().refusedCount());
  const access::AuditFile* const file = access.audit().file();
  if (!file) return;
  page.one("audit_lines_total", "counter", "Lines written to the audit log.", file->writtenCount());
  page.one("audit_lost_total", "counter", "Lines of the audit log that could not be written.", file->lostCount());
  page.one("audit_left_out_total", "counter", "Refusals that the rate of the audit log left out.",
           access.audit().leftOutCount());
}

}  // namespace

std::string metricLabel(std::string_view name, std::string_view value) {
  std::string out = std::string(name) + "=\"";
  for (const char c : core::toValidUtf8(value)) {
    if (c == '"' || c == '\\' || c == '\n') out += '\\';
    out += c == '\n' ? 'n' : c;
  }
  return out += '"';
}

std::string nameOf(v1::RejectReason reason) {
  return shortName(v1::RejectReason_Name(reason), sizeof("REJECT_REASON"));
}

std::string metricsText(const net::ServerStats& network, const CommandCounters& commands) {
  Page page;
  writeNetwork(page, network);
  writeCommands(page, commands);
  return page.take();
}

std::string metric(const char* name, const char* type, const char* help, double value) {
  Page page;
  page.one(name, type, help, value);
  return page.take();
}

std::string metricsText(const rooms::RoomHost& rooms, const CommandCounters& commands, const AccessControl& access,
                        const MetricsSources& sources) {
  const rooms::EncoderThread* const encoder = sources.encoder;
  std::vector<RoomSample> samples;
  for (const auto& room : rooms.rooms()) {
    samples.push_back({metricLabel("room", room->name()), room->demand()->sessionCount(),
                       room->roster().people().people_size(), room->snapshot(), room->vitals(),
                       encoder ? encoder->frameCounts(room->name()) : rooms::EncoderThread::FrameCounts{}});
  }
  Page page;
  writeRooms(page, samples);
  writeTickTimes(page, samples);
  writeKept(page, rooms.rooms());
  writeFaults(page, rooms);
  if (const net::Server* network = sources.network) writeNetwork(page, network->stats());
  if (encoder) writeEncoder(page, *encoder);
  writeCommands(page, commands);
  writeAccess(page, access);
  return page.take();
}

}  // namespace spindrift::service
