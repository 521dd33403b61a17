// Decoder of server messages in C++, for the scripted client and tests. Checks every bound.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <spindrift/core/bytes.h>
#include <spindrift/core/cell_counts.h>
#include <spindrift/core/result.h>
#include <spindrift/v1/wire.pb.h>

namespace spindrift::codec {

/// Limits of what a server may send.
inline constexpr std::uint32_t kSurfaceMaxResolutionCount = 4096;
inline constexpr std::uint32_t kParticleMaxCount = 4 * 1024 * 1024;
inline constexpr std::uint32_t kBodyMaxCount = 1024;  ///< boats, and floaters
inline constexpr std::size_t kServerMessageMaxBytes = 64 * 1024 * 1024;

/// Samples of a plane and its extent. The samples are row by row (x fastest); sample (i, k) lies at x = (i + 1/2)
/// length_m / count.x - length_m / 2, z likewise with k and width_m.
struct PlaneExtents {
  core::CellCounts count;
  double length_m = 0.0;
  double width_m = 0.0;

  bool operator==(const PlaneExtents&) const = default;
};

struct SurfaceSamples : PlaneExtents {
  double quantum_m = 0.0;
  std::vector<float> elevation_m;  ///< count.total() values
};

/// White water on the surface.
struct FoamSamples : PlaneExtents {
  std::vector<std::uint8_t> foam;  ///< none (0) to white (255): count.total() values
};

/// Particles in the order of the wire.
struct ParticleSamples {
  std::uint32_t count = 0;
  double radius_m = 0.0;
  std::vector<float> position_m;    ///< x, y, z per particle: 3 * count values
  std::vector<float> velocity_mps;  ///< x, y, z per particle: 3 * count values
  std::vector<std::uint8_t> tint;   ///< density over rest density from 0.5 (0) to 1.1 (255): count values
  std::vector<std::uint8_t> foam;   ///< none (0) to white (255): count values
};

/// Position and motion of a boat. Heading turns from +x toward +z, pitch lifts the bow, roll lowers starboard.
struct BodySample {
  std::uint32_t boat_id = 0;
  double position_m[3] = {0, 0, 0};  ///< of the hull's centre
  double heading_rad = 0.0;          ///< angles within about +-pi
  double pitch_rad = 0.0;
  double roll_rad = 0.0;
  double speed_mps = 0.0;  ///< along the heading
  double throttle_ratio = 0.0;
  double rudder_ratio = 0.0;
};

/// Position of a floater. The rotation takes its own axes to those of the water.
struct FloaterSample {
  std::uint32_t floater_id = 0;
  double position_m[3] = {0, 0, 0};   ///< of its middle
  double rotation[4] = {0, 0, 0, 1};  ///< unit quaternion x, y, z, w
  double size_m = 0.0;
  v1::FloaterKind kind = v1::FLOATER_KIND_CRATE;
  bool is_held = false;
};

/// Parses one server message. Error kInvalidInput: over kServerMessageMaxBytes, unparseable, or of an unknown kind.
core::Result<v1::ServerMessage> parseServerMessage(core::ByteView bytes);

/// Decodes a frame of the surface layer. Error kInvalidInput names what is wrong: another layer or codec, a number of
/// samples along an axis of 0 or over kSurfaceMaxResolutionCount, payload length, checksum, numbers not finite or out
/// of bounds.
core::Result<SurfaceSamples> decodeSurface(const v1::LayerFrame& frame);

/// Keeps the last two frames of a plane, on which a packed delta builds. One instance per subscription.
class PackedPlaneDecoder {
 public:
  PackedPlaneDecoder(const PackedPlaneDecoder&) = delete;
  PackedPlaneDecoder& operator=(const PackedPlaneDecoder&) = delete;

 protected:
  PackedPlaneDecoder();
  ~PackedPlaneDecoder();

  struct History;
  std::unique_ptr<History> history_;
};

/// Decodes the packed surface. Errors as decodeSurface(); kUnavailable: the frame builds on a missing one. After an
/// error only a keyframe can be decoded: subscribe again.
class PackedSurfaceDecoder : public PackedPlaneDecoder {
 public:
  core::Result<SurfaceSamples> decode(const v1::LayerFrame& frame);
};

/// Decodes the packed foam; errors likewise.
class PackedFoamDecoder : public PackedPlaneDecoder {
 public:
  core::Result<FoamSamples> decode(const v1::LayerFrame& frame);
};

/// Decodes the packed floaters, and keeps the last frame, on which a delta builds. One instance per subscription.
class PackedFloaterDecoder {
 public:
  PackedFloaterDecoder();
  ~PackedFloaterDecoder();
  PackedFloaterDecoder(const PackedFloaterDecoder&) = delete;
  PackedFloaterDecoder& operator=(const PackedFloaterDecoder&) = delete;

  /// Errors as decodeFloaters(); kUnavailable: the frame builds on a missing one. After an error only a keyframe can be
  /// decoded: subscribe again.
  core::Result<std::vector<FloaterSample>> decode(const v1::LayerFrame& frame);
  /// Returns the payload of a keyframe of the frame that was decoded last.
  [[nodiscard]] core::Bytes keyframePayload() const;

 private:
  struct History;
  std::unique_ptr<History> history_;
};

/// Follows a stream with deltas and makes a keyframe of its newest frame, for clients that come between two frames:
/// with the same samples or objects, tick and times, and with what the next delta of the stream builds on. It keeps two
/// planes, or the objects.
class FrameKeeper : public PackedPlaneDecoder {
 public:
  /// Takes the next message of the stream. False: it is no packed surface, foam or floaters, is damaged, or builds on a
  /// frame that is not here; only a keyframe can be taken then.
  bool take(core::ByteView message);
  /// Returns the frame as a keyframe; null if the last take() failed, or there was none.
  [[nodiscard]] core::SharedBytes keyframe();

 private:
  std::optional<v1::LayerFrame> head_;              ///< of the newest frame, without its payload
  std::unique_ptr<PackedFloaterDecoder> floaters_;  ///< null until the first packed floaters
};

/// Decodes a frame of the particle layer; errors likewise, count at most kParticleMaxCount (0 is valid).
core::Result<ParticleSamples> decodeParticles(const v1::LayerFrame& frame);

/// Decodes a packed frame of the particle layer; errors likewise. Tint and foam are quantized more coarsely than in
/// plain frames.
core::Result<ParticleSamples> decodePackedParticles(const v1::LayerFrame& frame);

/// Decodes a frame of the foam layer; errors as for the surface.
core::Result<FoamSamples> decodeFoam(const v1::LayerFrame& frame);

/// Decodes a frame of the bodies layer; errors likewise, count at most kBodyMaxCount (0 is valid), ids above 0,
/// positions within 10^6 m.
core::Result<std::vector<BodySample>> decodeBodies(const v1::LayerFrame& frame);

/// Decodes a frame of the floaters layer; errors likewise, and for a kind of 0 and a quaternion whose norm is not
/// 1. A kind that is not known here is read as a crate.
core::Result<std::vector<FloaterSample>> decodeFloaters(const v1::LayerFrame& frame);

}  // namespace spindrift::codec
