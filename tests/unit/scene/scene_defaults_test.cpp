// What a scene holds where a file leaves a field out, and what the simulation gets of it.
#include <set>
#include <string>
#include <vector>

#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>

#include <spindrift/core/scene.h>
#include <spindrift/scene/fields.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/v1/options.pb.h>

namespace spindrift::scene {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

v1::Scene sceneWithEveryPart() {
  v1::Scene scene;
  scene.mutable_wave();
  scene.mutable_particles();
  scene.mutable_coupling();
  scene.mutable_foam();
  scene.add_obstacles()->mutable_rock();
  scene.add_obstacles()->mutable_breakwater();
  scene.add_beaches();
  scene.mutable_boats()->add_boats();
  scene.mutable_floaters()->add_floaters();
  scene.mutable_storm();
  scene.mutable_bed()->mutable_grid();
  scene.mutable_bed()->add_shapes()->mutable_cone();
  scene.add_gauges();
  scene.add_wave_makers()->mutable_irregular();
  scene.add_events()->mutable_effect()->mutable_splash();
  scene.add_events()->mutable_effect()->mutable_breaking_wave();
  return scene;
}

// Left out or written down, a default is the same in core, and the same as in a struct that a test makes.
TEST(SceneDefaults, OfCoreAreThoseOfTheOptions) {
  v1::Scene scene = sceneWithEveryPart();
  const core::Scene left_out = toCore(scene);
  fillDefaults(scene);
  core::Scene filled = toCore(scene);
  EXPECT_EQ(filled.wave->absorption, core::Absorption::kPml);
  filled.wave->absorption.reset();
  EXPECT_TRUE(filled == left_out);
  EXPECT_TRUE(filled.wave == core::WaveScene{});
  EXPECT_TRUE(filled.storm == core::StormScene{});
  EXPECT_TRUE(filled.events.at(0).effect == core::Effect(core::Splash{}));
  EXPECT_EQ(filled.gravity_mps2, core::Scene{}.gravity_mps2);
  EXPECT_EQ(filled.seed, core::Scene{}.seed);
}

TEST(SceneDefaults, LetAsManyBoatsAndFloatersInAsCoreCanHold) {
  const auto most = [](const google::protobuf::Descriptor& part) {
    return part.FindFieldByName("capacity_count")->options().GetExtension(v1::parameter).max();
  };
  EXPECT_EQ(most(*v1::BoatsScene::descriptor()), core::kMaxBoats);
  EXPECT_EQ(most(*v1::FloatersScene::descriptor()), core::kMaxFloaters);
}

TEST(SceneDefaults, LeaveAbsentPartsAbsent) {
  v1::Scene scene;
  fillDefaults(scene);
  EXPECT_FALSE(scene.has_wave() || scene.has_particles() || scene.has_coupling() || scene.has_foam());
  EXPECT_TRUE(scene.has_stream());
  const core::Scene core_scene = toCore(scene);
  EXPECT_FALSE(core_scene.wave || core_scene.particles || core_scene.coupling || core_scene.foam);
}

TEST(SceneDefaults, ChooseMatchedLayersUnlessTheStencilHasNinePoints) {
  const auto chosen = [](const std::string& wave) {
    const auto scene = parseSceneText("wave { " + wave + " }", "scene");
    EXPECT_TRUE(scene) << wave;
    return toCore(*scene).wave->absorption;
  };
  EXPECT_EQ(chosen(""), core::Absorption::kPml);
  EXPECT_EQ(chosen("dispersion: DISPERSION_AIRY"), core::Absorption::kPml);
  EXPECT_EQ(chosen("stencil: STENCIL_NINE_POINT"), core::Absorption::kSponge);
  EXPECT_EQ(chosen("absorption: ABSORPTION_SPONGE"), core::Absorption::kSponge);
  EXPECT_EQ(chosen("dispersion: DISPERSION_AIRY absorption: ABSORPTION_SPONGE"), core::Absorption::kSponge);
}

TEST(SceneDefaults, FillOnlyWhatWasLeftOutAndTwiceIsTheSame) {
  v1::Scene scene = sceneWithEveryPart();
  scene.set_seed(7);
  scene.mutable_wave()->set_damping_per_s(0);
  scene.mutable_particles()->set_boundary_x(v1::BOUNDARY_WALL);
  fillDefaults(scene);
  EXPECT_EQ(scene.seed(), 7u);
  EXPECT_EQ(scene.wave().damping_per_s(), 0.0);
  EXPECT_EQ(scene.particles().boundary_x(), v1::BOUNDARY_WALL);
  EXPECT_EQ(scene.particles().boundary_z(), v1::BOUNDARY_PERIODIC);
  EXPECT_EQ(scene.particles().kernel_set(), v1::KERNEL_SET_WENDLAND_C2);
  EXPECT_EQ(scene.wave().stencil(), v1::STENCIL_FIVE_POINT);
  const std::string once = scene.SerializeAsString();
  fillDefaults(scene);
  EXPECT_EQ(scene.SerializeAsString(), once);
}

/// The fields that the simulation does not read: those of rooms and pages, and the forms of depths and series in files.
const std::set<std::string> kHostOnly = {"fidelity",
                                         "unwatched",
                                         "setting",
                                         "water_type",
                                         "first_view.x_m",
                                         "first_view.z_m",
                                         "first_view.across_m",
                                         "first_view.away_m",
                                         "first_view.heading_deg",
                                         "first_view.pitch_deg",
                                         "first_view.hour",
                                         "first_view.subject_right_m",
                                         "restart_after_s",
                                         "bed.grid.png",
                                         "bed.grid.rows.depth_m",
                                         "bed.grid.black_depth_m",
                                         "bed.grid.white_depth_m",
                                         "wave_makers.series.file"};

/// Changes one field after another of a scene and all its parts, and compares what core gets.
class EachField {
 public:
  [[nodiscard]] std::set<std::string> unseen() {
    changeFieldsOf(scene_, "");
    return unseen_;
  }

 private:
  void changeFieldsOf(Message& part, const std::string& prefix) {
    const Reflection& reflection = *part.GetReflection();
    for (int i = 0; i < part.GetDescriptor()->field_count(); ++i) {
      const FieldDescriptor& field = *part.GetDescriptor()->field(i);
      const std::string path = prefix + field.name();
      if (field.message_type() != nullptr) {
        changeFieldsOf(
            field.is_repeated() ? *reflection.AddMessage(&part, &field) : *reflection.MutableMessage(&part, &field),
            path + ".");
      } else if (field.enum_type() != nullptr) {
        changeEnum(part, field, path);
      } else {
        const core::Scene before = toCore(scene_);
        setOther(part, field);
        if (toCore(scene_) == before) unseen_.insert(path);
      }
      reflection.ClearField(&part, &field);
    }
  }

  /// Each value gives another scene. Left out, the field says the first, or nothing if it is `optional`.
  void changeEnum(Message& part, const FieldDescriptor& field, const std::string& path) {
    core::Scene before = toCore(scene_);
    for (int number = 1; number < field.enum_type()->value_count(); ++number) {
      part.GetReflection()->SetEnumValue(&part, &field, number);
      const core::Scene after = toCore(scene_);
      const bool is_default = number == 1 && !field.has_presence();
      if (is_default) {
        EXPECT_TRUE(after == before) << path;
      } else if (after == before) {
        unseen_.insert(path);
      }
      before = after;
    }
  }

  /// Sets a value that is not the default.
  static void setOther(Message& part, const FieldDescriptor& field) {
    const Reflection& reflection = *part.GetReflection();
    if (const v1::ParameterOptions* options = parameterOptions(field))
      return setNumber(part, field, options->default_() + 1);
    if (field.is_repeated() && field.type() == FieldDescriptor::TYPE_BYTES)
      return reflection.AddString(&part, &field, std::string(sizeof(float), '\0'));
    switch (field.cpp_type()) {
      case FieldDescriptor::CPPTYPE_STRING:
        return reflection.SetString(&part, &field, "other");
      case FieldDescriptor::CPPTYPE_BOOL:
        return reflection.SetBool(&part, &field, true);
      case FieldDescriptor::CPPTYPE_UINT64:
        return reflection.SetUInt64(&part, &field, 7);
      case FieldDescriptor::CPPTYPE_DOUBLE:
        return reflection.AddDouble(&part, &field, 7.0);
      case FieldDescriptor::CPPTYPE_FLOAT:
        return reflection.AddFloat(&part, &field, 7.0f);
      default:
        FAIL() << field.full_name() << " is of a type that this test does not know";
    }
  }

  v1::Scene scene_;
  std::set<std::string> unseen_;
};

TEST(SceneFields, ReachCoreButForThoseOfTheHost) {
  EXPECT_EQ(EachField().unseen(), kHostOnly);
}

TEST(SceneFields, KeepTheirNamesAndValues) {
  const auto scene = parseSceneText(
      "name: 'n' title: 't' description: 'd' seed: 3 gravity_mps2: 1 allow_unstable: true\n"
      "wave { side_m: 8 boundary_plus_x: WAVE_BOUNDARY_ABSORB boundary_minus_x: WAVE_BOUNDARY_REFLECT\n"
      "       sponge_width_m: 1.5 }\n"
      "obstacles { breakwater { x_m: -1 z_m: -2 length_m: 3 width_m: 0.5 heading_deg: 45 height_m: 0.75 } }\n"
      "events { at_s: 2 every_s: 5 effect { breaking_wave { side: SIDE_MINUS_Z shape: WAVE_SHAPE_SWELL } } }\n",
      "some.textproto");
  ASSERT_TRUE(scene) << scene.error().message;
  const core::Scene out = toCore(*scene);
  EXPECT_EQ(out.name + out.title + out.description, "ntd");
  EXPECT_EQ(out.seed, 3u);
  EXPECT_EQ(out.gravity_mps2, 1.0);
  EXPECT_TRUE(out.allow_unstable);
  EXPECT_EQ(out.wave->side_m, 8.0);
  EXPECT_EQ(out.wave->boundary_plus_x, core::WaveBoundary::kAbsorb);
  EXPECT_EQ(out.wave->boundary_minus_x, core::WaveBoundary::kReflect);
  EXPECT_EQ(out.wave->boundary_plus_z, core::WaveBoundary::kPeriodic);
  EXPECT_EQ(out.wave->sponge_width_m, 1.5);
  const core::Breakwater wall{
      .x_m = -1.0, .z_m = -2.0, .length_m = 3.0, .width_m = 0.5, .heading_deg = 45.0, .height_m = 0.75};
  EXPECT_TRUE(out.obstacles == std::vector<core::Obstacle>{wall});
  ASSERT_EQ(out.events.size(), 1u);
  EXPECT_EQ(out.events[0].at_s, 2.0);
  EXPECT_EQ(out.events[0].every_s, 5.0);
  const auto crest = std::get<core::BreakingWave>(out.events[0].effect);
  EXPECT_EQ(crest.side, core::Side::kMinusZ);
  EXPECT_EQ(crest.shape, core::WaveShape::kSwell);
}

// An enum may hold a number that a newer client knows. Fields are checked before, so that this is the second wall.
TEST(SceneFields, TakeUnknownNumbersOfEnumsForTheDefault) {
  v1::Scene scene;
  scene.mutable_wave()->set_stencil(static_cast<v1::Stencil>(77));
  scene.add_beaches()->set_side(static_cast<v1::Side>(77));
  const core::Scene out = toCore(scene);
  EXPECT_EQ(out.wave->stencil, core::WaveScene{}.stencil);
  EXPECT_EQ(out.beaches.at(0).side, core::Beach{}.side);
}

}  // namespace
}  // namespace spindrift::scene
