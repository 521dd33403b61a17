#include <bit>
#include <cmath>
#include <cstring>

#include <foxglove/schemas.pb.h>

#include <spindrift/codec/frame_decoder.h>
#include <spindrift/foxglove/converter.h>

namespace spindrift::foxglove {
namespace {

namespace schema = ::foxglove;
static_assert(std::endian::native == std::endian::little, "packed elements are little endian");

constexpr const char* kWaterFrame = "water";

bool has(TopicSet topics, Topic topic) {
  return topics[static_cast<std::size_t>(topic)];
}

template <typename Proto>
Message messageOf(Topic topic, double time_s, const Proto& proto) {
  return {topic, nanoseconds(time_s), proto.SerializeAsString()};
}

void set(google::protobuf::Timestamp& out, double time_s) {
  constexpr std::uint64_t kPerSecond = 1'000'000'000;
  const std::uint64_t time_ns = nanoseconds(time_s);
  out.set_seconds(static_cast<std::int64_t>(time_ns / kPerSecond));
  out.set_nanos(static_cast<std::int32_t>(time_ns % kPerSecond));
}

// The axes. Ours are x, y up, z; those of the messages are x, -z, y: turned by a quarter about x.

void set(schema::Vector3& out, double x, double y, double z) {
  out.set_x(x);
  out.set_y(y);
  out.set_z(z);
}

void setTurned(schema::Vector3& out, const double (&ours)[3]) {
  set(out, ours[0], -ours[2], ours[1]);
}

void set(schema::Quaternion& out, double x, double y, double z, double w) {
  out.set_x(x);
  out.set_y(y);
  out.set_z(z);
  out.set_w(w);
}

/// Sets the rotation of a boat: heading, then pitch, then roll, about the axes z, y and x of the messages. Headings
/// turn from +x toward -y there, a pitch that lifts the bow is negative about y, and a roll that lowers starboard,
/// which is -y, is positive about x.
void setAttitude(schema::Quaternion& out, const codec::BodySample& boat) {
  const double yaw = -boat.heading_rad / 2, pitch = -boat.pitch_rad / 2, roll = boat.roll_rad / 2;
  const double cy = std::cos(yaw), sy = std::sin(yaw), cp = std::cos(pitch), sp = std::sin(pitch);
  const double cr = std::cos(roll), sr = std::sin(roll);
  set(out, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy,
      cr * cp * cy + sr * sp * sy);
}

void setIdentity(schema::Pose& out) {
  set(*out.mutable_position(), 0, 0, 0);
  set(*out.mutable_orientation(), 0, 0, 0, 1);
}

template <typename Proto>
void addField(Proto& proto, const char* name, std::uint32_t offset_bytes,
              schema::PackedElementField::NumericType type) {
  schema::PackedElementField& field = *proto.add_fields();
  field.set_name(name);
  field.set_offset(offset_bytes);
  field.set_type(type);
}

// Planes

/// Returns the grid of a plane's samples. Its rows run along -z of the plane, so the last row of the plane comes first.
template <typename Sample>
schema::Grid gridOf(const codec::PlaneExtents& plane, const std::vector<Sample>& samples, const char* name,
                    schema::PackedElementField::NumericType type, double time_s) {
  schema::Grid out;
  set(*out.mutable_timestamp(), time_s);
  out.set_frame_id(kWaterFrame);
  set(*out.mutable_pose()->mutable_position(), -plane.length_m / 2, -plane.width_m / 2, 0);
  set(*out.mutable_pose()->mutable_orientation(), 0, 0, 0, 1);
  const std::size_t row_bytes = plane.count.x * sizeof(Sample);
  out.set_column_count(plane.count.x);
  out.mutable_cell_size()->set_x(plane.length_m / plane.count.x);
  out.mutable_cell_size()->set_y(plane.width_m / plane.count.z);
  out.set_row_stride(static_cast<std::uint32_t>(row_bytes));
  out.set_cell_stride(sizeof(Sample));
  addField(out, name, 0, type);
  std::string& data = *out.mutable_data();
  data.resize(samples.size() * sizeof(Sample));
  for (std::size_t row = 0; row < plane.count.z; ++row)
    std::memcpy(data.data() + row * row_bytes, samples.data() + (plane.count.z - 1 - row) * plane.count.x, row_bytes);
  return out;
}

// Particles

/// One point, as the fields of its cloud say.
struct Point {
  float x, y, z;
  float velocity_x, velocity_y, velocity_z;
  float density_ratio;
  float foam;
};
static_assert(sizeof(Point) == 32);

schema::PointCloud cloudOf(const codec::ParticleSamples& particles, double time_s) {
  constexpr float kLowestDensity = 0.5f, kDensityRange = 0.6f;  // of ParticlesFixed12's tint
  schema::PointCloud out;
  set(*out.mutable_timestamp(), time_s);
  out.set_frame_id(kWaterFrame);
  setIdentity(*out.mutable_pose());
  out.set_point_stride(sizeof(Point));
  std::uint32_t offset_bytes = 0;
  for (const char* name : {"x", "y", "z", "velocity_x", "velocity_y", "velocity_z", "density_ratio", "foam"}) {
    addField(out, name, offset_bytes, schema::PackedElementField::FLOAT32);
    offset_bytes += sizeof(float);
  }
  std::string& data = *out.mutable_data();
  data.resize(particles.count * sizeof(Point));
  for (std::size_t i = 0; i < particles.count; ++i) {
    const float* at = &particles.position_m[3 * i];
    const float* speed = &particles.velocity_mps[3 * i];
    const Point point{at[0],
                      -at[2],
                      at[1],
                      speed[0],
                      -speed[2],
                      speed[1],
                      kLowestDensity + kDensityRange * static_cast<float>(particles.tint[i]) / 255.0f,
                      static_cast<float>(particles.foam[i]) / 255.0f};
    std::memcpy(data.data() + i * sizeof(Point), &point, sizeof(Point));
  }
  return out;
}

// Bodies

/// Returns an update that replaces all entities of its topic.
schema::SceneUpdate updateAt(double time_s) {
  schema::SceneUpdate out;
  schema::SceneEntityDeletion& all = *out.add_deletions();
  set(*all.mutable_timestamp(), time_s);
  all.set_type(schema::SceneEntityDeletion::ALL);
  return out;
}

schema::SceneEntity& addEntity(schema::SceneUpdate& update, std::string id, double time_s) {
  schema::SceneEntity& out = *update.add_entities();
  set(*out.mutable_timestamp(), time_s);
  out.set_frame_id(kWaterFrame);
  out.set_id(std::move(id));
  return out;
}

void set(schema::Color& out, double r, double g, double b) {
  out.set_r(r);
  out.set_g(g);
  out.set_b(b);
  out.set_a(1.0);
}

schema::FrameTransforms transformsOf(const std::vector<codec::BodySample>& boats, double time_s) {
  schema::FrameTransforms out;
  for (const codec::BodySample& boat : boats) {
    schema::FrameTransform& transform = *out.add_transforms();
    set(*transform.mutable_timestamp(), time_s);
    transform.set_parent_frame_id(kWaterFrame);
    transform.set_child_frame_id("boat_" + std::to_string(boat.boat_id));
    setTurned(*transform.mutable_translation(), boat.position_m);
    setAttitude(*transform.mutable_rotation(), boat);
  }
  return out;
}

schema::SceneUpdate boatsOf(const std::vector<codec::BodySample>& boats,
                            const std::map<std::uint32_t, std::array<double, 3>>& sizes_m, double time_s) {
  schema::SceneUpdate out = updateAt(time_s);
  for (const codec::BodySample& boat : boats) {
    const auto size = sizes_m.find(boat.boat_id);
    if (size == sizes_m.end()) continue;
    const auto [length_m, beam_m, height_m] = size->second;
    schema::CubePrimitive& hull = *addEntity(out, "boat_" + std::to_string(boat.boat_id), time_s).add_cubes();
    setTurned(*hull.mutable_pose()->mutable_position(), boat.position_m);
    setAttitude(*hull.mutable_pose()->mutable_orientation(), boat);
    set(*hull.mutable_size(), length_m, beam_m, height_m);
    set(*hull.mutable_color(), 0.85, 0.25, 0.2);
  }
  return out;
}

/// Fills in what shapes have in common. `size_m`: along the object's own axes, x, y up, z.
template <typename Shape>
void place(Shape& shape, const codec::FloaterSample& floater, double length_m, double height_m, double width_m) {
  setTurned(*shape.mutable_pose()->mutable_position(), floater.position_m);
  const double* q = floater.rotation;
  set(*shape.mutable_pose()->mutable_orientation(), q[0], -q[2], q[1], q[3]);
  set(*shape.mutable_size(), length_m, width_m, height_m);
  set(*shape.mutable_color(), 0.8, 0.6, 0.3);
}

/// Adds an upright cylinder to the entity.
schema::CylinderPrimitive& addCylinder(schema::SceneEntity& entity) {
  schema::CylinderPrimitive& out = *entity.add_cylinders();
  out.set_bottom_scale(1.0);
  out.set_top_scale(1.0);
  return out;
}

/// Adds the shape that v1::FloaterKind describes.
void addShape(schema::SceneEntity& entity, const codec::FloaterSample& floater) {
  const double s = floater.size_m;
  switch (floater.kind) {
    case v1::FLOATER_KIND_BALL:
    case v1::FLOATER_KIND_STONE:
      return place(*entity.add_spheres(), floater, s, s, s);
    case v1::FLOATER_KIND_DUCK:
      return place(*entity.add_spheres(), floater, 0.8 * s, 0.8 * s, 0.8 * s);
    case v1::FLOATER_KIND_BUOY:
      return place(addCylinder(entity), floater, 0.6 * s, s, 0.6 * s);
    case v1::FLOATER_KIND_BARREL: {
      // It lies along x: its own z becomes its x, by a quarter about y.
      schema::CylinderPrimitive& barrel = addCylinder(entity);
      place(barrel, floater, 0.66 * s, s, 0.66 * s);
      schema::Quaternion& q = *barrel.mutable_pose()->mutable_orientation();
      const double half = std::sqrt(0.5);
      set(q, half * (q.x() - q.z()), half * (q.y() + q.w()), half * (q.z() + q.x()), half * (q.w() - q.y()));
      return;
    }
    case v1::FLOATER_KIND_PLANK:
      return place(*entity.add_cubes(), floater, s, 0.08 * s, 0.24 * s);
    case v1::FLOATER_KIND_RAFT:
      return place(*entity.add_cubes(), floater, s, 0.12 * s, 0.7 * s);
    default:
      return place(*entity.add_cubes(), floater, s, s, s);
  }
}

schema::SceneUpdate floatersOf(const std::vector<codec::FloaterSample>& floaters, double time_s) {
  schema::SceneUpdate out = updateAt(time_s);
  for (const codec::FloaterSample& floater : floaters)
    addShape(addEntity(out, "floater_" + std::to_string(floater.floater_id), time_s), floater);
  return out;
}

}  // namespace

std::uint64_t nanoseconds(double time_s) {
  constexpr double kLongest_s = 9e9;  // 285 years; in nanoseconds it fits into a signed number, which readers use
  if (!(time_s > 0.0)) return 0;
  return static_cast<std::uint64_t>(std::llround(std::min(time_s, kLongest_s) * 1e9));
}

void Converter::take(const v1::BoatList& boats) {
  boat_sizes_m_.clear();
  for (const v1::BoatInfo& boat : boats.boats())
    boat_sizes_m_[boat.boat_id()] = {boat.length_m(), boat.beam_m(), boat.height_m()};
}

core::Result<std::vector<Message>> Converter::convert(const v1::LayerFrame& frame, TopicSet wanted) const {
  wanted &= topicsOf(frame.layer());
  const double time_s = frame.time_s();
  std::vector<Message> out;
  if (has(wanted, Topic::kSurface)) {
    const auto surface = codec::decodeSurface(frame);
    if (!surface) return surface.error();
    out.push_back(
        messageOf(Topic::kSurface, time_s,
                  gridOf(*surface, surface->elevation_m, "elevation_m", schema::PackedElementField::FLOAT32, time_s)));
  }
  if (has(wanted, Topic::kFoam)) {
    const auto foam = codec::decodeFoam(frame);
    if (!foam) return foam.error();
    out.push_back(
        messageOf(Topic::kFoam, time_s, gridOf(*foam, foam->foam, "foam", schema::PackedElementField::UINT8, time_s)));
  }
  if (has(wanted, Topic::kParticles)) {
    const auto particles = codec::decodeParticles(frame);
    if (!particles) return particles.error();
    out.push_back(messageOf(Topic::kParticles, time_s, cloudOf(*particles, time_s)));
  }
  if (has(wanted, Topic::kBoats) || has(wanted, Topic::kTransforms)) {
    const auto boats = codec::decodeBodies(frame);
    if (!boats) return boats.error();
    if (has(wanted, Topic::kBoats))
      out.push_back(messageOf(Topic::kBoats, time_s, boatsOf(*boats, boat_sizes_m_, time_s)));
    if (has(wanted, Topic::kTransforms))
      out.push_back(messageOf(Topic::kTransforms, time_s, transformsOf(*boats, time_s)));
  }
  if (has(wanted, Topic::kFloaters)) {
    const auto floaters = codec::decodeFloaters(frame);
    if (!floaters) return floaters.error();
    out.push_back(messageOf(Topic::kFloaters, time_s, floatersOf(*floaters, time_s)));
  }
  for (const Topic layer :
       {Topic::kSurfaceLayer, Topic::kParticlesLayer, Topic::kBodiesLayer, Topic::kFoamLayer, Topic::kFloatersLayer}) {
    if (has(wanted, layer)) out.push_back(messageOf(layer, time_s, frame));
  }
  return out;
}

std::vector<Message> Converter::convert(const v1::Diagnostics& diagnostics, TopicSet wanted) const {
  std::vector<Message> out;
  if (has(wanted, Topic::kGauges)) {
    for (const v1::GaugeReading& gauge : diagnostics.gauges()) {
      if (!gauge.unread()) out.push_back(messageOf(Topic::kGauges, diagnostics.gauges_time_s(), gauge));
    }
  }
  if (has(wanted, Topic::kDiagnostics))
    out.push_back(messageOf(Topic::kDiagnostics, diagnostics.time_s(), diagnostics));
  return out;
}

}  // namespace spindrift::foxglove
