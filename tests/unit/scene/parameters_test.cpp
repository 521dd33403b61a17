#include <functional>
#include <limits>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>

#include <spindrift/scene/parameters.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/v1/options.pb.h>

namespace spindrift::scene {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using testing::AllOf;
using testing::HasSubstr;

v1::Scene fullScene() {
  v1::Scene scene;
  scene.mutable_wave();
  scene.mutable_particles();
  scene.mutable_coupling();
  scene.mutable_foam();
  scene.mutable_storm();
  fillDefaults(scene);
  return scene;
}

std::set<std::string> pathsOf(const v1::Scene& scene) {
  std::set<std::string> paths;
  for (const v1::ParameterDescription& description : describeParameters(scene)) paths.insert(description.path());
  return paths;
}

/// Calls `visit` for every number field below `type`; the numbers of a list are data, checked where they are read.
void forEachNumber(const Descriptor& type, const std::function<void(const FieldDescriptor&)>& visit) {
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
      forEachNumber(*field.message_type(), visit);
    } else if (!field.is_repeated() && (field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE ||
                                        field.cpp_type() == FieldDescriptor::CPPTYPE_UINT32)) {
      visit(field);
    }
  }
}

TEST(Parameters, ChangedAreThoseWithAnotherValueThanInTheFile) {
  const v1::Scene file = fullScene();
  v1::Scene now = file;
  EXPECT_TRUE(changedParameters(file, now).empty());
  ASSERT_FALSE(setParameter(now, "wave.depth_m", file.wave().depth_m() + 0.25));
  const auto changed = changedParameters(file, now);
  ASSERT_EQ(changed.size(), 1U);
  EXPECT_EQ(changed[0].path(), "wave.depth_m");
  EXPECT_EQ(changed[0].value(), file.wave().depth_m() + 0.25);
}

TEST(Parameters, EveryNumberOfASceneHasLabelRangeStepAndADefaultWithin) {
  int count = 0;
  forEachNumber(*v1::Scene::descriptor(), [&](const FieldDescriptor& field) {
    ++count;
    ASSERT_TRUE(field.options().HasExtension(v1::parameter)) << field.full_name();
    const v1::ParameterOptions& options = field.options().GetExtension(v1::parameter);
    EXPECT_FALSE(options.label().empty()) << field.full_name();
    EXPECT_LT(options.min(), options.max()) << field.full_name();
    EXPECT_GT(options.step(), 0.0) << field.full_name();
    EXPECT_GE(options.default_(), options.min()) << field.full_name();
    EXPECT_LE(options.default_(), options.max()) << field.full_name();
    EXPECT_TRUE(field.has_presence()) << field.full_name() << ": left out must differ from 0";
  });
  EXPECT_GE(count, 30);
}

TEST(Parameters, EveryOneThatCanBeSetHasAHelpText) {
  for (const v1::ParameterDescription& description : describeParameters(fullScene())) {
    EXPECT_FALSE(description.help().empty()) << description.path();
    EXPECT_FALSE(description.label().empty()) << description.path();
    EXPECT_GE(description.value(), description.min()) << description.path();
    EXPECT_LE(description.value(), description.max()) << description.path();
  }
}

TEST(Parameters, DescribeOnlyTheLiveOnesOfThePartsPresent) {
  const std::set<std::string> all = pathsOf(fullScene());
  EXPECT_THAT(all, testing::IsSupersetOf({"gravity_mps2",
                                          "wave.depth_m",
                                          "wave.damping_per_s",
                                          "particles.viscosity_pas",
                                          "coupling.downforce_per_m_s2",
                                          "foam.lifetime_s",
                                          "stream.frame_rate_hz",
                                          "particles.count",
                                          "particles.iterations_count",
                                          "wave.steepening_ratio",
                                          "coupling.emission_ratio",
                                          "foam.neighbours_count",
                                          "foam.breaking_lifetime_s",
                                          "foam.wake_lifetime_s",
                                          "foam.landing_lifetime_s",
                                          "storm.level_ratio",
                                          "storm.drops_per_m2_s",
                                          "storm.drop_depth_m",
                                          "storm.wave_height_m",
                                          "storm.wind_direction_deg",
                                          "storm.wind_speed_mps",
                                          "storm.fetch_m"}));
  EXPECT_FALSE(all.contains("wave.resolution_count")) << "needs a restart";
  EXPECT_FALSE(all.contains("seed"));

  v1::Scene waves;
  waves.mutable_wave();
  waves.add_events()->mutable_effect()->mutable_splash();
  fillDefaults(waves);
  EXPECT_THAT(pathsOf(waves), testing::UnorderedElementsAre("gravity_mps2", "wave.depth_m", "wave.damping_per_s",
                                                            "wave.steepening_ratio", "stream.frame_rate_hz"));
}

TEST(Parameters, EveryDescribedOneCanBeSetToItsBounds) {
  v1::Scene scene = fullScene();
  for (const v1::ParameterDescription& description : describeParameters(scene)) {
    EXPECT_FALSE(setParameter(scene, description.path(), description.min())) << description.path();
    EXPECT_FALSE(setParameter(scene, description.path(), description.max())) << description.path();
  }
  for (const v1::ParameterDescription& description : describeParameters(scene)) {
    EXPECT_EQ(description.value(), description.max()) << description.path();
  }
}

TEST(Parameters, SettingChangesItsFieldOnly) {
  v1::Scene scene = fullScene();
  v1::Scene expected = scene;
  expected.mutable_particles()->set_viscosity_pas(12.5);
  ASSERT_FALSE(setParameter(scene, "particles.viscosity_pas", 12.5));
  EXPECT_EQ(scene.SerializeAsString(), expected.SerializeAsString());
}

TEST(Parameters, StepsOfTheSliderAreNotEnforced) {
  v1::Scene scene = fullScene();
  EXPECT_FALSE(setParameter(scene, "wave.depth_m", 1.2345));
  EXPECT_EQ(scene.wave().depth_m(), 1.2345);
}

TEST(Parameters, CannotMakeTheWaterTooShallowForItsBoats) {
  auto scene = parseSceneText(
      "wave { depth_m: 2 boundary_minus_x: WAVE_BOUNDARY_REFLECT boundary_plus_x: WAVE_BOUNDARY_REFLECT }\n"
      "beaches { shore_depth_m: 0.2 }\n"
      "boats { boats { height_m: 1 density_ratio: 0.5 } }\n",
      "pool.textproto");
  ASSERT_TRUE(scene) << scene.error().message;
  const std::string before = scene->SerializeAsString();
  const auto error = setParameter(*scene, "wave.depth_m", 0.45);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->reason, v1::REJECT_REASON_OUT_OF_RANGE);
  EXPECT_EQ(error->path, "wave.depth_m");
  EXPECT_THAT(error->message, AllOf(HasSubstr("boats.boats[0].height_m"), HasSubstr("0.45 m")));
  EXPECT_THAT(setParameter(*scene, "wave.depth_m", 0.1)->message, HasSubstr("beaches[0].shore_depth_m"));
  EXPECT_EQ(scene->SerializeAsString(), before);
  EXPECT_FALSE(setParameter(*scene, "wave.depth_m", 0.6));
}

struct BadSet {
  const char* name;
  const char* path;
  double value;
  v1::RejectReason reason;
  const char* must_hold;
};

class RejectedParameter : public testing::TestWithParam<BadSet> {};

TEST_P(RejectedParameter, HasAReasonAndDoesNotChangeTheScene) {
  const BadSet& bad = GetParam();
  v1::Scene scene = fullScene();
  scene.clear_foam();
  scene.add_events()->mutable_effect()->mutable_splash();
  const std::string before = scene.SerializeAsString();
  const auto checked = checkParameter(scene, bad.path, bad.value);
  const auto error = setParameter(scene, bad.path, bad.value);
  ASSERT_TRUE(error);
  ASSERT_TRUE(checked);
  EXPECT_EQ(checked->message, error->message);
  EXPECT_EQ(error->reason, bad.reason) << error->message;
  EXPECT_EQ(error->path, bad.path);
  EXPECT_THAT(error->message, HasSubstr(bad.must_hold));
  EXPECT_EQ(scene.SerializeAsString(), before);
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

const BadSet kBadSets[] = {
    {"Empty", "", 1, v1::REJECT_REASON_UNKNOWN_PARAMETER, "greeting"},
    {"Unknown", "wave.colour", 1, v1::REJECT_REASON_UNKNOWN_PARAMETER, "greeting"},
    {"UnknownPart", "sharks.count", 1, v1::REJECT_REASON_UNKNOWN_PARAMETER, "greeting"},
    {"Part", "wave", 1, v1::REJECT_REASON_UNKNOWN_PARAMETER, "greeting"},
    {"TrailingDot", "wave.depth_m.", 1, v1::REJECT_REASON_UNKNOWN_PARAMETER, "greeting"},
    {"Dots", "...", 1, v1::REJECT_REASON_UNKNOWN_PARAMETER, "greeting"},
    {"Enum", "wave.stencil", 1, v1::REJECT_REASON_UNKNOWN_PARAMETER, "greeting"},
    {"Text", "title", 1, v1::REJECT_REASON_UNKNOWN_PARAMETER, "greeting"},
    {"Seed", "seed", 1, v1::REJECT_REASON_UNKNOWN_PARAMETER, "greeting"},
    {"Boat", "boats.boats.x_m", 1, v1::REJECT_REASON_UNKNOWN_PARAMETER, "greeting"},
    {"Obstacle", "obstacles.rock.x_m", 1, v1::REJECT_REASON_UNKNOWN_PARAMETER, "greeting"},
    {"Flag", "particles.cohesion", 1, v1::REJECT_REASON_UNKNOWN_PARAMETER, "greeting"},
    {"Event", "events.at_s", 1, v1::REJECT_REASON_UNKNOWN_PARAMETER, "greeting"},
    {"AbsentPart", "foam.lifetime_s", 1, v1::REJECT_REASON_ABSENT_PART, "no foam"},
    {"Restart", "wave.resolution_count", 512, v1::REJECT_REASON_NEEDS_RESTART, "256 cells"},
    {"NotANumber", "wave.depth_m", kNaN, v1::REJECT_REASON_NOT_FINITE, "0.05 to 100 m"},
    {"Infinite", "wave.depth_m", -kInfinity, v1::REJECT_REASON_NOT_FINITE, "0.05 to 100 m"},
    {"Above", "particles.viscosity_pas", 500.1, v1::REJECT_REASON_OUT_OF_RANGE,
     "500.1 Pa s is above the maximum of 500 Pa s"},
    {"Below", "wave.damping_per_s", -0.01, v1::REJECT_REASON_OUT_OF_RANGE, "-0.01 1/s is below the minimum of 0 1/s"},
};

INSTANTIATE_TEST_SUITE_P(Parameters, RejectedParameter, testing::ValuesIn(kBadSets),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

TEST(Parameters, ALongPathIsEchoedShortenedAndCleaned) {
  v1::Scene scene = fullScene();
  const auto error = setParameter(scene, "\n\x1b[2J" + std::string(10'000, 'x'), 1.0);
  ASSERT_TRUE(error);
  EXPECT_LE(error->path.size(), 64u);
  EXPECT_EQ(error->path.find_first_of("\n\x1b"), std::string::npos);
}

TEST(Parameters, TheReferenceListsEveryNumberWithItsUnitAndRange) {
  const std::string table = parameterReferenceMarkdown();
  EXPECT_THAT(table,
              AllOf(HasSubstr("| `wave.resolution_count` | Wave resolution | cells | 1 to 4096 | 256 | restart |"),
                    HasSubstr("| `particles.viscosity_pas` | Viscosity | Pa s | 0 to 500 | 60 | live |"),
                    HasSubstr("`events[].effect.splash.depth_m`")));
  int number_count = 0;
  forEachNumber(*v1::Scene::descriptor(), [&](const FieldDescriptor& field) {
    ++number_count;
    EXPECT_THAT(table, HasSubstr(field.name() + "` |"));
  });
  // The table has two lines of heading.
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), number_count + 2);
}

}  // namespace
}  // namespace spindrift::scene
