#include <spindrift/bench/scene_crowd.h>
#include <spindrift/codec/frame_decoder.h>
#include <spindrift/v1/wire.pb.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::bench {
namespace {

core::SharedBytes bytesOf(const v1::ClientMessage& message) {
  core::Bytes out(message.ByteSizeLong());
  message.SerializeWithCachedSizesToArray(out.data());
  return core::share(std::move(out));
}

}  // namespace

CrowdOptions sceneCrowd(const v1::Scene& scene, std::size_t client_count, double seconds) {
  constexpr double kRate_hz = 20.0;  // rate of the levels' budgets
  CrowdOptions out;
  out.client_count = client_count;
  out.duration = std::chrono::duration<double>(seconds);
  out.commands_per_s = 0.1;
  v1::ClientMessage hello;
  hello.mutable_hello()->mutable_version()->set_major(wire::kWireMajor);
  hello.mutable_hello()->mutable_version()->set_minor(wire::kWireMinor);
  hello.mutable_hello()->set_client("spindrift-bench");
  out.on_open.push_back(bytesOf(hello));
  for (const v1::Layer layer : {v1::LAYER_SURFACE, v1::LAYER_PARTICLES, v1::LAYER_FOAM, v1::LAYER_BODIES}) {
    v1::ClientMessage message;
    message.mutable_subscribe()->set_layer(layer);
    message.mutable_subscribe()->set_max_rate_hz(kRate_hz);
    message.mutable_subscribe()->set_packing(v1::PACKING_PACKED);
    out.on_open.push_back(bytesOf(message));
  }
  // Count the frames of a layer that the scene has.
  const v1::Layer counted = scene.has_wave() ? v1::LAYER_SURFACE : v1::LAYER_PARTICLES;
  out.look = [counted](core::ByteView bytes) {
    Sighting sighting;
    const auto message = codec::parseServerMessage(bytes);
    if (!message) return sighting;
    if (message->has_frame() && message->frame().layer() == counted) sighting.kind = Sighting::Kind::kFrame;
    if (message->has_ack() || message->has_reject()) {
      sighting.kind = Sighting::Kind::kAnswer;
      sighting.number = message->has_ack() ? message->ack().command_id() : message->reject().command_id();
    }
    return sighting;
  };
  out.command = [](std::uint64_t number) {
    v1::ClientMessage message;
    message.mutable_command()->set_command_id(number);
    message.mutable_command()->mutable_splash()->set_depth_m(0.05);
    message.mutable_command()->mutable_splash()->set_radius_m(0.5);
    return bytesOf(message);
  };
  return out;
}

}  // namespace spindrift::bench
