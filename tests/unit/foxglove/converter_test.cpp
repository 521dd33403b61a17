#include <cmath>
#include <cstring>
#include <numbers>

#include <foxglove/schemas.pb.h>
#include <gmock/gmock.h>
#include <google/protobuf/descriptor.pb.h>
#include <google/protobuf/dynamic_message.h>
#include <gtest/gtest.h>

#include <spindrift/codec/frame_encoder.h>
#include <spindrift/core/crc32c.h>
#include <spindrift/foxglove/converter.h>

namespace spindrift::foxglove {
namespace {

namespace schema = ::foxglove;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kPi = std::numbers::pi;

template <typename Value>
Value valueAt(const std::string& data, std::size_t offset_bytes) {
  Value out{};
  EXPECT_LE(offset_bytes + sizeof(Value), data.size());
  if (offset_bytes + sizeof(Value) <= data.size()) std::memcpy(&out, data.data() + offset_bytes, sizeof(Value));
  return out;
}

v1::LayerFrame sealed(v1::LayerFrame frame, v1::Layer layer, std::string payload) {
  frame.set_layer(layer);
  frame.set_keyframe(true);
  frame.set_time_s(1.5);
  frame.set_crc32c(core::crc32c(core::viewOf(payload)));
  frame.set_payload(std::move(payload));
  return frame;
}

template <typename Number>
void append(std::string& out, std::initializer_list<Number> numbers) {
  for (const Number number : numbers) out.append(reinterpret_cast<const char*>(&number), sizeof(number));
}

/// 3 x 2 samples of 10 m x 4 m: 1, 2, 3 at the far side (low z), 4, 5, 6 near.
v1::LayerFrame surfaceFrame() {
  v1::LayerFrame frame;
  frame.mutable_surface_fixed16()->set_resolution_count(3);
  frame.mutable_surface_fixed16()->set_count_z(2);
  frame.mutable_surface_fixed16()->set_side_m(10.0);
  frame.mutable_surface_fixed16()->set_width_m(4.0);
  frame.mutable_surface_fixed16()->set_quantum_m(0.5);
  std::string payload;
  append<std::int16_t>(payload, {1, 2, 3, 4, 5, -6});
  return sealed(frame, v1::LAYER_SURFACE, payload);
}

v1::LayerFrame bodiesFrame(std::int16_t heading, std::int16_t pitch, std::int16_t roll) {
  v1::LayerFrame frame;
  frame.mutable_bodies_fixed28()->set_count(1);
  std::string payload;
  append<std::uint32_t>(payload, {3});
  append<std::int32_t>(payload, {1'000, 250, -2'000});
  append<std::int16_t>(payload, {heading, pitch, roll, 0, 0, 0});
  return sealed(frame, v1::LAYER_BODIES, payload);
}

template <typename Proto>
Proto only(const Converter& converter, const v1::LayerFrame& frame, Topic topic) {
  Proto out;
  const auto messages = converter.convert(frame, TopicSet().set(static_cast<std::size_t>(topic)));
  EXPECT_TRUE(messages) << messages.error().message;
  if (!messages) return out;
  EXPECT_EQ(messages->size(), 1u);
  EXPECT_EQ(messages->front().topic, topic);
  EXPECT_EQ(messages->front().time_ns, 1'500'000'000u);
  EXPECT_TRUE(out.ParseFromString(messages->front().bytes));
  return out;
}

struct Vector {
  double x, y, z;
};

Vector turned(const schema::Quaternion& q, Vector v) {
  const Vector u{q.x(), q.y(), q.z()};
  const auto cross = [](Vector a, Vector b) {
    return Vector{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  };
  const Vector uv = cross(u, v), uuv = cross(u, uv);
  return {v.x + 2 * (q.w() * uv.x + uuv.x), v.y + 2 * (q.w() * uv.y + uuv.y), v.z + 2 * (q.w() * uv.z + uuv.z)};
}

void expectNear(Vector is, Vector wanted) {
  EXPECT_NEAR(is.x, wanted.x, 1e-3);
  EXPECT_NEAR(is.y, wanted.y, 1e-3);
  EXPECT_NEAR(is.z, wanted.z, 1e-3);
}

TEST(Converter, TheGridOfTheSurfaceHasItsHeightsAtTheirPositions) {
  const auto grid = only<schema::Grid>(Converter(), surfaceFrame(), Topic::kSurface);
  EXPECT_EQ(grid.timestamp().seconds(), 1);
  EXPECT_EQ(grid.timestamp().nanos(), 500'000'000);
  EXPECT_EQ(grid.frame_id(), "water");
  EXPECT_EQ(grid.column_count(), 3u);
  EXPECT_EQ(grid.row_stride(), 12u);
  EXPECT_EQ(grid.cell_stride(), 4u);
  EXPECT_DOUBLE_EQ(grid.cell_size().x(), 10.0 / 3);
  EXPECT_DOUBLE_EQ(grid.cell_size().y(), 2.0);
  EXPECT_DOUBLE_EQ(grid.pose().position().x(), -5.0);
  EXPECT_DOUBLE_EQ(grid.pose().position().y(), -2.0);
  ASSERT_EQ(grid.fields_size(), 1);
  EXPECT_EQ(grid.fields(0).name(), "elevation_m");
  EXPECT_EQ(grid.fields(0).type(), schema::PackedElementField::FLOAT32);
  ASSERT_EQ(grid.data().size(), 24u);
  // y of the grid is -z: its first row is the side with the highest z.
  std::vector<float> heights_m;
  for (std::size_t i = 0; i < 6; ++i) heights_m.push_back(valueAt<float>(grid.data(), 4 * i));
  EXPECT_THAT(heights_m, ElementsAre(2.0f, 2.5f, -3.0f, 0.5f, 1.0f, 1.5f));
}

TEST(Converter, TheGridOfTheFoamHasOneBytePerCell) {
  v1::LayerFrame frame;
  frame.mutable_foam_fixed8()->set_resolution_count(2);
  frame.mutable_foam_fixed8()->set_side_m(8.0);
  const auto grid = only<schema::Grid>(
      Converter(), sealed(frame, v1::LAYER_FOAM, std::string({char(10), char(20), char(30), char(200)})), Topic::kFoam);
  EXPECT_EQ(grid.cell_stride(), 1u);
  EXPECT_EQ(grid.row_stride(), 2u);
  EXPECT_DOUBLE_EQ(grid.cell_size().y(), 4.0);
  EXPECT_EQ(grid.fields(0).type(), schema::PackedElementField::UINT8);
  EXPECT_EQ(grid.data(), std::string({char(30), char(200), char(10), char(20)}));
}

TEST(Converter, ThePointCloudHasParticlesInTheAxesOfTheMessages) {
  v1::LayerFrame frame;
  auto& header = *frame.mutable_particles_fixed12();
  header.set_count(2);
  header.set_min_x_m(-1.0);
  header.set_min_y_m(-2.0);
  header.set_min_z_m(-3.0);
  header.set_max_x_m(1.0);
  header.set_max_y_m(2.0);
  header.set_max_z_m(3.0);
  header.set_max_speed_mps(12.7);
  header.set_radius_m(0.1);
  std::string payload;
  append<std::uint16_t>(payload, {65'535, 0, 0});  // x, z, y
  append<std::uint8_t>(payload, {10, 20, 30, 255, 51, 0});
  append<std::uint16_t>(payload, {0, 65'535, 65'535});
  append<std::uint8_t>(payload, {0, 0, 0xff, 0, 0, 0});
  const auto cloud =
      only<schema::PointCloud>(Converter(), sealed(frame, v1::LAYER_PARTICLES, payload), Topic::kParticles);
  std::vector<std::string> names;
  for (const auto& field : cloud.fields()) names.push_back(field.name());
  EXPECT_THAT(names, ElementsAre("x", "y", "z", "velocity_x", "velocity_y", "velocity_z", "density_ratio", "foam"));
  ASSERT_EQ(cloud.data().size(), 2 * cloud.point_stride());
  std::map<std::string, float> first, second;
  for (const auto& field : cloud.fields()) {
    first[field.name()] = valueAt<float>(cloud.data(), field.offset());
    second[field.name()] = valueAt<float>(cloud.data(), cloud.point_stride() + field.offset());
  }
  // (1, -2, -3) of the scene.
  EXPECT_FLOAT_EQ(first["x"], 1.0f);
  EXPECT_FLOAT_EQ(first["y"], 3.0f);
  EXPECT_FLOAT_EQ(first["z"], -2.0f);
  EXPECT_NEAR(first["velocity_x"], 1.0f, 1e-5);
  EXPECT_NEAR(first["velocity_y"], -3.0f, 1e-5);
  EXPECT_NEAR(first["velocity_z"], 2.0f, 1e-5);
  EXPECT_NEAR(first["density_ratio"], 1.1f, 1e-6);
  EXPECT_NEAR(first["foam"], 0.2f, 1e-6);
  EXPECT_FLOAT_EQ(second["y"], -3.0f);
  EXPECT_NEAR(second["velocity_y"], 0.1f, 1e-5);
  EXPECT_NEAR(second["density_ratio"], 0.5f, 1e-6);
}

TEST(Converter, TransformsOfBoatsTurnAsTheBoatsDo) {
  constexpr std::int16_t kQuarter = 16'384;  // pi / 2
  const auto transformOf = [](const v1::LayerFrame& frame) {
    const auto all = only<schema::FrameTransforms>(Converter(), frame, Topic::kTransforms);
    EXPECT_EQ(all.transforms_size(), 1);
    return all.transforms_size() == 1 ? all.transforms(0) : schema::FrameTransform();
  };
  const auto straight = transformOf(bodiesFrame(0, 0, 0));
  EXPECT_EQ(straight.parent_frame_id(), "water");
  EXPECT_EQ(straight.child_frame_id(), "boat_3");
  expectNear({straight.translation().x(), straight.translation().y(), straight.translation().z()}, {1.0, 2.0, 0.25});
  expectNear(turned(straight.rotation(), {1, 0, 0}), {1, 0, 0});
  // A quarter from +x toward +z of the scene, which is -y here.
  expectNear(turned(transformOf(bodiesFrame(kQuarter, 0, 0)).rotation(), {1, 0, 0}), {0, -1, 0});
  // The bow rises.
  expectNear(turned(transformOf(bodiesFrame(0, kQuarter / 3, 0)).rotation(), {1, 0, 0}),
             {std::cos(kPi / 6), 0, std::sin(kPi / 6)});
  // Starboard, -y of the boat, goes down.
  expectNear(turned(transformOf(bodiesFrame(0, 0, kQuarter / 3)).rotation(), {0, -1, 0}),
             {0, -std::cos(kPi / 6), -std::sin(kPi / 6)});
  // Both at once, heading first: the bow points along the heading and up.
  expectNear(turned(transformOf(bodiesFrame(kQuarter, kQuarter / 3, 1'000)).rotation(), {1, 0, 0}),
             {0, -std::cos(kPi / 6), std::sin(kPi / 6)});
}

TEST(Converter, BoatsAreDrawnOnceTheirSizesAreKnown) {
  Converter converter;
  const auto before = only<schema::SceneUpdate>(converter, bodiesFrame(0, 0, 0), Topic::kBoats);
  EXPECT_EQ(before.entities_size(), 0);
  v1::BoatList boats;
  v1::BoatInfo& boat = *boats.add_boats();
  boat.set_boat_id(3);
  boat.set_length_m(4.0);
  boat.set_beam_m(1.5);
  boat.set_height_m(1.0);
  converter.take(boats);
  const auto update = only<schema::SceneUpdate>(converter, bodiesFrame(0, 0, 0), Topic::kBoats);
  ASSERT_EQ(update.deletions_size(), 1);
  EXPECT_EQ(update.deletions(0).type(), schema::SceneEntityDeletion::ALL);
  ASSERT_EQ(update.entities_size(), 1);
  EXPECT_EQ(update.entities(0).id(), "boat_3");
  ASSERT_EQ(update.entities(0).cubes_size(), 1);
  const schema::CubePrimitive& hull = update.entities(0).cubes(0);
  expectNear({hull.size().x(), hull.size().y(), hull.size().z()}, {4.0, 1.5, 1.0});
  expectNear({hull.pose().position().x(), hull.pose().position().y(), hull.pose().position().z()}, {1.0, 2.0, 0.25});
}

TEST(Converter, FloatersHaveTheShapesOfTheirKinds) {
  constexpr std::int16_t kOne = 32'767;
  const auto half = static_cast<std::int16_t>(std::lround(kOne * std::sqrt(0.5)));
  v1::LayerFrame frame;
  frame.mutable_floaters_fixed28()->set_count(3);
  std::string payload;
  const auto add = [&](std::uint32_t id, std::initializer_list<std::int16_t> rotation, v1::FloaterKind kind) {
    append<std::uint32_t>(payload, {id});
    append<std::int32_t>(payload, {0, 500, 1'000});
    append<std::int16_t>(payload, rotation);
    append<std::uint16_t>(payload, {200});
    append<std::uint8_t>(payload, {static_cast<std::uint8_t>(kind), 0});
  };
  add(1, {0, 0, 0, kOne}, v1::FLOATER_KIND_PLANK);
  add(2, {0, half, 0, half}, v1::FLOATER_KIND_BARREL);  // a quarter about y, which takes its x to -z of the scene
  add(3, {0, 0, 0, kOne}, v1::FLOATER_KIND_DUCK);
  const auto update =
      only<schema::SceneUpdate>(Converter(), sealed(frame, v1::LAYER_FLOATERS, payload), Topic::kFloaters);
  ASSERT_EQ(update.entities_size(), 3);
  ASSERT_EQ(update.entities(0).cubes_size(), 1);
  const schema::CubePrimitive& plank = update.entities(0).cubes(0);
  expectNear({plank.size().x(), plank.size().y(), plank.size().z()}, {2.0, 0.48, 0.16});
  expectNear({plank.pose().position().x(), plank.pose().position().y(), plank.pose().position().z()}, {0, -1.0, 0.5});
  ASSERT_EQ(update.entities(1).cylinders_size(), 1);
  const schema::CylinderPrimitive& barrel = update.entities(1).cylinders(0);
  EXPECT_NEAR(barrel.size().z(), 2.0, 1e-9);
  EXPECT_EQ(barrel.top_scale(), 1.0);
  expectNear(turned(barrel.pose().orientation(), {0, 0, 1}), {0, 1, 0});
  ASSERT_EQ(update.entities(2).spheres_size(), 1);
  EXPECT_NEAR(update.entities(2).spheres(0).size().y(), 1.6, 1e-9);
}

TEST(Converter, GaugesAreOneMessageEachOnceTheyHaveMeasured) {
  v1::Diagnostics diagnostics;
  diagnostics.set_time_s(2.0);
  diagnostics.set_gauges_time_s(1.5);
  diagnostics.add_gauges()->set_name("shore");
  diagnostics.mutable_gauges(0)->set_elevation_m(0.25);
  diagnostics.add_gauges()->set_unread(true);
  const auto messages = Converter().convert(diagnostics, topicsOf(v1::LAYER_DIAGNOSTICS));
  ASSERT_EQ(messages.size(), 2u);
  EXPECT_EQ(messages[0].topic, Topic::kGauges);
  EXPECT_EQ(messages[0].time_ns, 1'500'000'000u);
  v1::GaugeReading reading;
  ASSERT_TRUE(reading.ParseFromString(messages[0].bytes));
  EXPECT_EQ(reading.elevation_m(), 0.25);
  EXPECT_EQ(messages[1].topic, Topic::kDiagnostics);
  EXPECT_EQ(messages[1].time_ns, 2'000'000'000u);
}

TEST(Converter, OnlyWantedTopicsOfTheLayerAreMade) {
  const auto messages = Converter().convert(surfaceFrame(), TopicSet().set());
  ASSERT_TRUE(messages);
  ASSERT_EQ(messages->size(), 2u);
  EXPECT_EQ((*messages)[0].topic, Topic::kSurface);
  EXPECT_EQ((*messages)[1].topic, Topic::kSurfaceLayer);
  EXPECT_TRUE(Converter().convert(surfaceFrame(), {})->empty());
  EXPECT_TRUE(Converter().convert(surfaceFrame(), topicsOf(v1::LAYER_BODIES))->empty());
}

TEST(Converter, RefusesDamagedFramesAndPackedOnesThatItWouldHaveToRead) {
  v1::LayerFrame damaged = surfaceFrame();
  damaged.mutable_payload()->front() ^= 1;
  const auto refused = Converter().convert(damaged, TopicSet().set());
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("crc32c"));
  v1::LayerFrame packed = surfaceFrame();
  packed.mutable_surface_predicted();
  EXPECT_FALSE(Converter().convert(packed, TopicSet().set()));
  const auto passed = Converter().convert(packed, TopicSet().set(static_cast<std::size_t>(Topic::kSurfaceLayer)));
  ASSERT_TRUE(passed);
  EXPECT_EQ(passed->size(), 1u);
}

TEST(Converter, TimesOutsideOfTheRangeAreCutToIt) {
  EXPECT_EQ(nanoseconds(-1.0), 0u);
  EXPECT_EQ(nanoseconds(std::nan("")), 0u);
  EXPECT_EQ(nanoseconds(1e300), 9'000'000'000'000'000'000u);
  EXPECT_EQ(nanoseconds(0.1), 100'000'000u);
}

TEST(Channels, TheirSchemasDescribeTheirMessagesWithoutAnyOtherFile) {
  for (const Channel& channel : allChannels()) {
    SCOPED_TRACE(std::string(channel.name));
    google::protobuf::FileDescriptorSet files;
    ASSERT_TRUE(files.ParseFromString(channel.schema));
    google::protobuf::DescriptorPool pool;  // knows nothing but what it is given, in this order
    for (const auto& file : files.file()) ASSERT_NE(pool.BuildFile(file), nullptr);
    EXPECT_NE(pool.FindMessageTypeByName(channel.schema_name), nullptr);
    EXPECT_LT(channel.schema.size(), 8'000u);
  }
}

TEST(Channels, AReaderWithNothingButTheSchemaReadsAMessage) {
  const Channel& channel = allChannels()[static_cast<std::size_t>(Topic::kSurface)];
  google::protobuf::FileDescriptorSet files;
  ASSERT_TRUE(files.ParseFromString(channel.schema));
  google::protobuf::DescriptorPool pool;
  for (const auto& file : files.file()) pool.BuildFile(file);
  google::protobuf::DynamicMessageFactory factory;
  const auto* type = pool.FindMessageTypeByName("foxglove.Grid");
  const std::unique_ptr<google::protobuf::Message> grid(factory.GetPrototype(type)->New());
  const auto messages = Converter().convert(surfaceFrame(), topicsOf(v1::LAYER_SURFACE));
  ASSERT_TRUE(messages);
  ASSERT_TRUE(grid->ParseFromString(messages->front().bytes));
  EXPECT_EQ(grid->GetReflection()->GetUInt32(*grid, type->FindFieldByName("column_count")), 3u);
}

TEST(Channels, TheTopicsOfARoomAreThoseOfItsLayers) {
  v1::Greeting greeting;
  greeting.add_layers(v1::LAYER_SURFACE);
  greeting.add_layers(v1::LAYER_DIAGNOSTICS);
  std::vector<std::string_view> names;
  for (const Channel& channel : allChannels())
    if (topicsOf(greeting)[static_cast<std::size_t>(channel.topic)]) names.push_back(channel.name);
  EXPECT_THAT(names, ElementsAre("/water/surface", "/gauges", "/diagnostics", "/layers/surface"));
}

}  // namespace
}  // namespace spindrift::foxglove
