// What is on its way from the device while a parameter changes: frames and diagnostics show the water of their tick.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <google/protobuf/descriptor.h>

#include <spindrift/scene/fields.h>
#include <spindrift/scene/parameters.h>
#include <spindrift/scene/scene_loader.h>

#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

/// All parts; the particles are a pool of fixed size.
constexpr const char* kTwoWay =
    "gravity_mps2: 9 wave { resolution_count: 48 side_m: 12 depth_m: 1.2 bulk: BULK_NONLINEAR dispersion: "
    "DISPERSION_AIRY } "
    "particles { count: 2000 headroom_m: 3 max_speed_mps: 5 sound_speed_mps: 2 viscosity_pas: 10 } "
    "coupling { mode: COUPLING_MODE_TWO_WAY droplet_spacing_m: 0.15 } foam { surface: true } boats { boats {} } "
    "storm { level_ratio: 0.3 }";
/// A band of particles on a linear wave; their number can change.
constexpr const char* kOneWay =
    "wave { resolution_count: 32 side_m: 8 depth_m: 1.2 } particles { count: 600 headroom_m: 3 } coupling {} foam {}";

class FramesInFlight : public OnDevice, public ::testing::WithParamInterface<const char*> {
 protected:
  void SetUp() override {
    OnDevice::SetUp();
    if (IsSkipped()) return;
    auto scene = scene::parseSceneText(GetParam(), "small");
    ASSERT_TRUE(scene) << scene.error().message;
    scene_ = *std::move(scene);
    WaterSim& water = make(scene::toCore(scene_));
    ASSERT_TRUE(water.start(core::Splash{0.3, -0.2, 1.5, 0.8, 0.2}));
    for (int tick = 0; tick < 30; ++tick) water.step();
  }

  /// Returns why the parameter was not set; empty if it was.
  std::string refusal(const std::string& path, double value) {
    v1::Scene changed = scene_;
    if (const auto error = scene::setParameter(changed, path, value)) return error->message;
    const auto done = sim_->setScene(scene::toCore(changed));
    return done ? "" : done.error().message;
  }

  std::vector<core::FrameView> takeFrames() {
    ctx_->finish();
    return sim_->takeFrames();
  }

  v1::Scene scene_;
};

/// Where the frame's first difference from the state lies; empty if each value is within its quantum.
std::string differenceOf(const core::FrameView& frame, const StateCopy& state, const Derived& derived,
                         const core::Scene& scene) {
  const core::SurfaceView& surface = *frame.at(core::Level::kFull).surface;
  for (std::size_t i = 0; i < surface.count.total(); ++i) {
    const auto sample = static_cast<std::int16_t>(surface.words[i / 2] >> (16 * (i % 2)));
    if (std::abs(sample * surface.quantum_m - state.elevation_m[i]) > 0.51 * scene.stream.surface_quantum_m)
      return "elevation of sample " + std::to_string(i);
  }
  if (surface.length_m != derived.wave->length_m || surface.width_m != derived.wave->width_m) return "size";
  const core::ParticleView& particles = *frame.at(core::Level::kFull).particles;
  if (particles.count != state.position.size() / 4) return "number of particles";
  for (std::size_t i = 0; i < particles.count; ++i) {
    const std::uint32_t* words = &particles.words[3 * i];
    const std::uint32_t place[3] = {words[0] & 0xffff, words[1] & 0xffff, words[0] >> 16};
    const std::int8_t speed[3] = {static_cast<std::int8_t>(words[1] >> 16), static_cast<std::int8_t>(words[1] >> 24),
                                  static_cast<std::int8_t>(words[2])};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double extent_m = particles.max_m[axis] - particles.min_m[axis];
      const double place_m = particles.min_m[axis] + place[axis] / 65535.0 * extent_m;
      if (std::abs(place_m - state.position[4 * i + axis]) > extent_m / 65535.0)
        return "position of particle " + std::to_string(i) + " along axis " + std::to_string(axis);
      const double speed_mps = speed[axis] / 127.0 * particles.max_speed_mps;
      if (std::abs(speed_mps - state.velocity[4 * i + axis]) > scene.particles->max_speed_mps / 127.0)
        return "velocity of particle " + std::to_string(i) + " along axis " + std::to_string(axis);
    }
  }
  if (std::abs(particles.radius_m - derived.particles->spacing_m / 2) > 1e-9) return "radius";
  return "";
}

TEST_P(FramesInFlight, ShowTheStateOfTheirTickWhateverParameterChangesMeanwhile) {
  int changed_count = 0;
  for (const v1::ParameterDescription& parameter : scene::describeParameters(scene_)) {
    const double middle = 0.5 * (parameter.value() + parameter.max());
    for (double value : {parameter.min(), parameter.max(), 1.5 * parameter.value(), middle}) {
      if (parameter.step() >= 1) value = std::round(value);
      if (parameter.path() == "particles.count") value = std::min(value, 900.0);
      if (value < parameter.min() || value > parameter.max() || value == parameter.value()) continue;
      SCOPED_TRACE(parameter.path() + " = " + std::to_string(value));
      const StateCopy state = sim_->copyState();
      const Derived derived = sim_->derived();
      const core::Scene scene = sim_->scene();
      const std::uint64_t tick = sim_->tick();
      ASSERT_TRUE(sim_->requestFrame(FrameRequest::allLayers()));
      const bool is_taken = refusal(parameter.path(), value).empty();
      const std::vector<core::FrameView> frames = takeFrames();
      if (is_taken) ++changed_count;
      // Another number of particles has other buffers, and the frames in flight are lost.
      if (frames.empty()) {
        EXPECT_EQ(parameter.path(), "particles.count");
      } else {
        ASSERT_EQ(frames.size(), 1u);
        EXPECT_EQ(frames[0].tick, tick);
        EXPECT_EQ(differenceOf(frames[0], state, derived, scene), "");
      }
      ASSERT_EQ(refusal(parameter.path(), parameter.value()), "");
    }
  }
  EXPECT_GT(changed_count, 15);
}

TEST_P(FramesInFlight, AFrameRequestedAfterTheChangeHasTheNewScale) {
  const double before_mps = sim_->scene().particles->max_speed_mps;
  ASSERT_EQ(refusal("particles.max_speed_mps", 2 * before_mps), "");
  ASSERT_TRUE(sim_->requestFrame(FrameRequest::allLayers()));
  const std::vector<core::FrameView> frames = takeFrames();
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].at(core::Level::kFull).particles->max_speed_mps, 2 * before_mps);
  EXPECT_EQ(differenceOf(frames[0], sim_->copyState(), sim_->derived(), sim_->scene()), "");
}

TEST_P(FramesInFlight, DiagnosticsInFlightBelongToTheirTick) {
  // Once without a change, and once with each: the health of the last tick before the change is the same.
  const auto healthAfter = [&](const std::string& path, double value) {
    sim_->reset();
    EXPECT_TRUE(sim_->start(core::Splash{0.3, -0.2, 1.5, 0.8, 0.2}));
    for (int tick = 0; tick < 20; ++tick) sim_->step();
    const std::uint64_t measured_tick = sim_->tick();
    const v1::Scene before = scene_;
    if (!path.empty()) {
      EXPECT_EQ(refusal(path, value), "") << path;
    }
    // Reads the water, which also ends zink's batch of the last results: glFinish() alone leaves their fences pending.
    static_cast<void>(sim_->copyState());
    ctx_->finish();
    sim_->step();  // takes the results that have arrived
    EXPECT_EQ(sim_->health().tick, measured_tick);
    const Health health = sim_->health();
    EXPECT_TRUE(sim_->setScene(scene::toCore(before)));
    return health;
  };
  const Health plain = healthAfter("", 0);
  ASSERT_GT(plain.wave_energy_j, 0.0);
  std::vector<std::pair<std::string, double>> changes = {{"gravity_mps2", 4.0}};
  if (scene_.wave().bulk() != v1::BULK_NONLINEAR) changes.emplace_back("wave.depth_m", 1.15);  // it holds its ground
  for (const auto& [path, value] : changes) {
    SCOPED_TRACE(path);
    const Health health = healthAfter(path, value);
    EXPECT_EQ(health.wave_energy_j, plain.wave_energy_j);
    EXPECT_EQ(health.potential_energy_j, plain.potential_energy_j);
    EXPECT_EQ(health.kinetic_energy_j, plain.kinetic_energy_j);
    EXPECT_EQ(health.volume_error_units, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, FramesInFlight, ::testing::Values(kTwoWay, kOneWay),
                         [](const auto& scene) { return scene.param == kTwoWay ? "TwoWay" : "OneWay"; });

/// Paths of all live parameters of a message and its single parts.
void addLive(const google::protobuf::Descriptor& type, const std::string& prefix, std::set<std::string>& out) {
  for (int i = 0; i < type.field_count(); ++i) {
    const google::protobuf::FieldDescriptor& field = *type.field(i);
    if (field.is_repeated()) continue;
    if (field.message_type() != nullptr) addLive(*field.message_type(), prefix + field.name() + ".", out);
    const v1::ParameterOptions* options = scene::parameterOptions(field);
    if (options && !options->restart()) out.insert(prefix + field.name());
  }
}

TEST(FramesInFlightScenes, HaveEveryLiveParameter) {
  std::set<std::string> wanted;
  addLive(*v1::Scene::descriptor(), "", wanted);
  ASSERT_GT(wanted.size(), 20u);
  for (const char* text : {kTwoWay, kOneWay}) {
    const auto scene = scene::parseSceneText(text, "small");
    ASSERT_TRUE(scene) << scene.error().message;
    for (const auto& parameter : scene::describeParameters(*scene)) wanted.erase(parameter.path());
  }
  EXPECT_EQ(wanted, std::set<std::string>{});
}

}  // namespace
}  // namespace spindrift::sim
