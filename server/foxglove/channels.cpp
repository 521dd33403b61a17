#include <array>

#include <foxglove/schemas.pb.h>

#include <spindrift/foxglove/channels.h>
#include <spindrift/foxglove/schema_set.h>

namespace spindrift::foxglove {
namespace {

template <typename Message>
Channel channel(Topic topic, std::string_view name, v1::Layer layer) {
  const google::protobuf::Descriptor& schema = *Message::descriptor();
  return {topic, name, layer, std::string(schema.full_name()), schemaSetOf(schema)};
}

std::array<Channel, kTopicCount> makeChannels() {
  namespace schema = ::foxglove;
  return {channel<schema::Grid>(Topic::kSurface, "/water/surface", v1::LAYER_SURFACE),
          channel<schema::Grid>(Topic::kFoam, "/water/foam", v1::LAYER_FOAM),
          channel<schema::PointCloud>(Topic::kParticles, "/water/particles", v1::LAYER_PARTICLES),
          channel<schema::SceneUpdate>(Topic::kBoats, "/boats", v1::LAYER_BODIES),
          channel<schema::SceneUpdate>(Topic::kFloaters, "/floaters", v1::LAYER_FLOATERS),
          channel<schema::FrameTransforms>(Topic::kTransforms, "/tf", v1::LAYER_BODIES),
          channel<v1::GaugeReading>(Topic::kGauges, "/gauges", v1::LAYER_DIAGNOSTICS),
          channel<v1::Diagnostics>(Topic::kDiagnostics, "/diagnostics", v1::LAYER_DIAGNOSTICS),
          channel<v1::LayerFrame>(Topic::kSurfaceLayer, "/layers/surface", v1::LAYER_SURFACE),
          channel<v1::LayerFrame>(Topic::kParticlesLayer, "/layers/particles", v1::LAYER_PARTICLES),
          channel<v1::LayerFrame>(Topic::kBodiesLayer, "/layers/bodies", v1::LAYER_BODIES),
          channel<v1::LayerFrame>(Topic::kFoamLayer, "/layers/foam", v1::LAYER_FOAM),
          channel<v1::LayerFrame>(Topic::kFloatersLayer, "/layers/floaters", v1::LAYER_FLOATERS)};
}

}  // namespace

std::span<const Channel> allChannels() {
  static const std::array<Channel, kTopicCount> channels = makeChannels();
  return channels;
}

TopicSet topicsOf(v1::Layer layer) {
  TopicSet out;
  for (const Channel& channel : allChannels()) out[static_cast<std::size_t>(channel.topic)] = channel.layer == layer;
  return out;
}

TopicSet topicsOf(const v1::Greeting& greeting) {
  TopicSet out;
  for (const int layer : greeting.layers()) out |= topicsOf(static_cast<v1::Layer>(layer));
  return out;
}

}  // namespace spindrift::foxglove
