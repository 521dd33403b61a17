// The channels in which Foxglove gets a room: the same ones in a live connection and in a recording.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <spindrift/v1/wire.pb.h>

namespace spindrift::foxglove {

/// Content of a channel.
enum class Topic : std::uint8_t {
  // Foxglove's schemas, in the frame "water": x as in the scene, y = -z of the scene, z up. Right-handed, in metres.
  kSurface,     ///< Grid: elevation_m
  kFoam,        ///< Grid: foam
  kParticles,   ///< PointCloud: x, y, z, their velocities, density_ratio, foam
  kBoats,       ///< SceneUpdate: one cube per boat
  kFloaters,    ///< SceneUpdate: one shape per object in the water
  kTransforms,  ///< FrameTransforms: "boat_ID" in "water"; x forward, y to port, z up
  // Messages of the wire, in the axes of the scene.
  kGauges,        ///< GaugeReading, one message per gauge
  kDiagnostics,   ///< Diagnostics
  kSurfaceLayer,  ///< LayerFrame, as the next: the layer as it comes
  kParticlesLayer,
  kBodiesLayer,
  kFoamLayer,
  kFloatersLayer,
};
inline constexpr std::size_t kTopicCount = 13;

/// A set of topics, indexed by Topic.
using TopicSet = std::bitset<kTopicCount>;

struct Channel {
  Topic topic{};
  std::string_view name;    ///< of the topic: "/water/surface"
  v1::Layer layer{};        ///< that its messages are made of
  std::string schema_name;  ///< full name of the message: "foxglove.Grid"
  std::string schema;       ///< a serialized google.protobuf.FileDescriptorSet with the message and all that it needs
  /// 1 and up; the same in every version of the program that has the topic.
  [[nodiscard]] std::uint32_t id() const { return static_cast<std::uint32_t>(topic) + 1; }
};

/// Encoding of messages and schemas.
inline constexpr std::string_view kEncoding = "protobuf";

/// Returns every channel, in the order of Topic. A room has those of its layers.
std::span<const Channel> allChannels();

/// Returns the topics that are made of the layer.
TopicSet topicsOf(v1::Layer layer);

/// Returns the topics of a room, from the layers of its greeting.
TopicSet topicsOf(const v1::Greeting& greeting);

}  // namespace spindrift::foxglove
