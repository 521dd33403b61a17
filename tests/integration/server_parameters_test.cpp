// SetParameter over a real connection: which clients are told of a change, and which errors a refusal names.
#include <limits>
#include <sstream>

#include "server_fixture.h"

namespace spindrift::test {
namespace {

using testing::HasSubstr;

class Parameters : public ServerTest {};

class FixedStepParameters : public ServerTest {
 protected:
  std::vector<RoomText> rooms() const override {
    // By a stream: GCC 12 wrongly warns that the move of a sum of texts of known length exceeds its bounds.
    std::ostringstream scene;
    scene << "fixed_substeps_count: 1\n" << kStillPool;
    return {{"main", scene.str()}};
  }
};

TEST_F(Parameters, ChangeReachesEveryClientOfTheRoom) {
  ScriptedClient one = client();
  ScriptedClient two = client();
  const auto applied = one.apply(setParameter("particles.viscosity_pas", 12.5));
  ASSERT_TRUE(applied);
  for (ScriptedClient* each : {&one, &two}) {
    const auto change = each->waitFor(v1::ServerMessage::kParameterChanged);
    ASSERT_TRUE(change);
    EXPECT_EQ(change->parameter_changed().path(), "particles.viscosity_pas");
    EXPECT_EQ(change->parameter_changed().value(), 12.5);
    EXPECT_EQ(change->parameter_changed().applied_tick(), *applied);
  }
}

TEST_F(Parameters, ChangeIsInTheNextGreeting) {
  ASSERT_TRUE(client().apply(setParameter("particles.viscosity_pas", 12.5)));
  const ScriptedClient newcomer = client();
  EXPECT_EQ(newcomer.greeting().scene().particles().viscosity_pas(), 12.5);
  for (const v1::ParameterDescription& parameter : newcomer.greeting().parameters()) {
    if (parameter.path() != "particles.viscosity_pas") continue;
    EXPECT_EQ(parameter.value(), 12.5);
    EXPECT_EQ(parameter.default_(), core::ParticleScene{}.viscosity_pas);
    return;
  }
  FAIL() << "the greeting lacks the parameter";
}

TEST_F(Parameters, RejectionChangesNothingAndReachesOnlyItsSender) {
  ScriptedClient one = client();
  ScriptedClient two = client();
  EXPECT_EQ(one.rejected(setParameter("particles.viscosity_pas", -1)).reason(), v1::REJECT_REASON_OUT_OF_RANGE);
  EXPECT_FALSE(one.hasReceived(v1::ServerMessage::kParameterChanged));
  EXPECT_FALSE(two.hasReceived(v1::ServerMessage::kParameterChanged));
  EXPECT_FALSE(two.hasReceived(v1::ServerMessage::kReject));
  EXPECT_EQ(client().greeting().scene().particles().viscosity_pas(), 60.0);
}

TEST_F(Parameters, OutOfRangeNamesFieldValueAndBound) {
  ScriptedClient one = client();
  const v1::Reject reject = one.rejected(setParameter("particles.viscosity_pas", 501));
  EXPECT_EQ(reject.reason(), v1::REJECT_REASON_OUT_OF_RANGE);
  EXPECT_EQ(reject.field(), "particles.viscosity_pas");
  EXPECT_THAT(reject.message(), HasSubstr("501 Pa s"));
  EXPECT_THAT(reject.message(), HasSubstr("500 Pa s"));
}

TEST_F(Parameters, NonFiniteValuesAreRejected) {
  ScriptedClient one = client();
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                             -std::numeric_limits<double>::infinity()}) {
    const v1::Reject reject = one.rejected(setParameter("particles.viscosity_pas", value));
    EXPECT_EQ(reject.reason(), v1::REJECT_REASON_NOT_FINITE) << value;
    EXPECT_EQ(reject.field(), "particles.viscosity_pas");
    EXPECT_THAT(reject.message(), HasSubstr("finite"));
  }
  EXPECT_TRUE(one.apply(setParameter("particles.viscosity_pas", 1)));
}

TEST_F(Parameters, UnknownPathIsRejectedByName) {
  ScriptedClient one = client();
  const v1::Reject reject = one.rejected(setParameter("particles.stickiness", 1));
  EXPECT_EQ(reject.reason(), v1::REJECT_REASON_UNKNOWN_PARAMETER);
  EXPECT_EQ(reject.field(), "particles.stickiness");
}

TEST_F(Parameters, RestartParameterIsRejectedByName) {
  ScriptedClient one = client();
  const v1::Reject reject = one.rejected(setParameter("wave.resolution_count", 64));
  EXPECT_EQ(reject.reason(), v1::REJECT_REASON_NEEDS_RESTART);
  EXPECT_EQ(reject.field(), "wave.resolution_count");
}

TEST_F(FixedStepParameters, ValueThatBreaksAStepRuleIsRejected) {
  ScriptedClient one = client();
  const v1::Reject reject = one.rejected(setParameter("particles.sound_speed_mps", 500));
  EXPECT_EQ(reject.reason(), v1::REJECT_REASON_BREAKS_STEP_RULE);
  EXPECT_EQ(reject.field(), "particles.sound_speed_mps");
  EXPECT_THAT(reject.message(), HasSubstr("above the bound of"));
  EXPECT_THAT(reject.message(), HasSubstr("particle CFL"));
  EXPECT_FALSE(one.hasReceived(v1::ServerMessage::kParameterChanged));
  EXPECT_EQ(client().greeting().scene().particles().sound_speed_mps(), 14.0);
  EXPECT_TRUE(one.apply(setParameter("particles.sound_speed_mps", 10)));
}

TEST_F(Parameters, AValueWithoutAPossibleLatticeIsOutOfRange) {
  ScriptedClient one = client();
  const v1::Reject reject = one.rejected(setParameter("particles.count", 1));
  EXPECT_EQ(reject.reason(), v1::REJECT_REASON_OUT_OF_RANGE) << reject.message();
  EXPECT_EQ(reject.field(), "particles.count");
  EXPECT_THAT(reject.message(), HasSubstr("at least 3 are needed"));
  EXPECT_TRUE(one.runFor(5)) << "the room continues unchanged";
}

TEST_F(Parameters, AStiffenedRoomTakesMoreSubsteps) {
  ScriptedClient one = client();
  one.subscribe(v1::LAYER_DIAGNOSTICS);
  const auto before = one.waitFor(v1::ServerMessage::kDiagnostics);
  ASSERT_TRUE(before);
  const auto applied = one.apply(setParameter("particles.sound_speed_mps", 60));
  ASSERT_TRUE(applied);
  const auto after = one.waitFor([&](const v1::ServerMessage& message) {
    return message.has_diagnostics() && message.diagnostics().tick() > *applied;
  });
  ASSERT_TRUE(after);
  EXPECT_GT(after->diagnostics().substeps_count(), before->diagnostics().substeps_count());
  EXPECT_EQ(after->diagnostics().nonfinite_count(), 0u);
}

}  // namespace
}  // namespace spindrift::test
