#include <gmock/gmock.h>

#include <spindrift/rooms/roster.h>

namespace spindrift::rooms {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;

struct RosterTest : testing::Test {
  Roster roster{10s};
  Roster::Clock::time_point now{};

  Admission arrive(core::SessionId session, const std::string& name = "", const std::string& resume_key = "") {
    return roster.arrive({.session = session, .role = core::Role::kPlayer, .name = name, .resume_key = resume_key});
  }
};

TEST_F(RosterTest, PeopleHaveNumbersNamesAndColors) {
  EXPECT_EQ(arrive(7, "Ada").person_id, 1U);
  EXPECT_EQ(arrive(8).person_id, 2U);
  const v1::People people = roster.people();
  ASSERT_EQ(people.people_size(), 2);
  EXPECT_EQ(people.people(0).name(), "Ada");
  EXPECT_EQ(people.people(1).name(), "guest 2");
  EXPECT_EQ(people.people(0).role(), v1::ROLE_PLAYER);
  EXPECT_NE(people.people(0).color_rgb(), people.people(1).color_rgb());
  EXPECT_TRUE(roster.settle(now).is_news);
  EXPECT_FALSE(roster.settle(now).is_news) << "reported once";
}

TEST_F(RosterTest, TheCountOfUnlistedPeopleIsNewsButNotKept) {
  arrive(7, "Ada");
  EXPECT_EQ(roster.people().unlisted_count(), 0U);
  roster.settle(now);
  const std::uint64_t kept = roster.version();
  roster.setUnlistedCount(0);
  EXPECT_FALSE(roster.settle(now).is_news);
  roster.setUnlistedCount(930);
  EXPECT_EQ(roster.people().unlisted_count(), 930U);
  EXPECT_EQ(roster.people().people_size(), 1);
  EXPECT_TRUE(roster.settle(now).is_news);
  roster.setUnlistedCount(930);
  EXPECT_FALSE(roster.settle(now).is_news) << "reported once";
  EXPECT_EQ(roster.version(), kept);
}

TEST_F(RosterTest, CountsThePeopleWhoAreConnected) {
  const Admission ada = arrive(1);
  arrive(2);
  EXPECT_EQ(roster.presentCount(), 2U);
  roster.give(7, ada.person_id);
  roster.leave(1, now);
  EXPECT_EQ(roster.people().people_size(), 2) << "the boat keeps its owner";
  EXPECT_EQ(roster.presentCount(), 1U);
  roster.setUnlistedCount(30);
  EXPECT_EQ(roster.presentCount(), 31U);
}

TEST_F(RosterTest, APersonWithoutABoatIsForgottenAtOnce) {
  const Admission ada = arrive(7);
  roster.leave(7, now);
  EXPECT_EQ(roster.people().people_size(), 0);
  EXPECT_FALSE(arrive(8, "", ada.resume_key).resumed);
}

TEST_F(RosterTest, APersonWithAGaugeIsKeptForTheGraceTime) {
  const Admission ada = arrive(7);
  const Admission bob = arrive(8);
  roster.setGaugeOwners({ada.person_id});
  roster.leave(7, now);
  roster.leave(8, now);
  EXPECT_TRUE(roster.isHere(ada.person_id));
  EXPECT_FALSE(roster.isHere(bob.person_id));
  roster.settle(now + 9s);
  EXPECT_TRUE(arrive(9, "", ada.resume_key).resumed);
  roster.leave(9, now + 9s);
  EXPECT_TRUE(roster.settle(now + 19s).is_news);
  EXPECT_FALSE(roster.isHere(ada.person_id));
}

TEST_F(RosterTest, APersonInATeamComesBackIntoIt) {
  const Admission ada = arrive(7);
  arrive(8);
  v1::Lesson teams;
  teams.set_teams(true);
  roster.setLesson(teams);
  const v1::Team team = roster.people().people(0).team();
  ASSERT_NE(team, v1::TEAM_UNSPECIFIED);
  roster.leave(7, now);
  arrive(9);  // does not get the place that is kept
  EXPECT_TRUE(arrive(10, "", ada.resume_key).resumed);
  EXPECT_EQ(roster.people().people(0).person_id(), ada.person_id);
  EXPECT_EQ(roster.people().people(0).team(), team);
}

TEST_F(RosterTest, APersonWhoseGaugesAreGoneIsForgottenAtOnce) {
  const Admission ada = arrive(7);
  roster.setGaugeOwners({ada.person_id});
  roster.setGaugeOwners({});
  roster.leave(7, now);
  EXPECT_FALSE(roster.isHere(ada.person_id));
}

TEST_F(RosterTest, ALostConnectionKeepsItsBoatForTheGraceTime) {
  const Admission ada = arrive(7, "Ada");
  roster.give(3, ada.person_id);
  roster.leave(7, now);
  EXPECT_THAT(roster.settle(now).boats_to_stop, ElementsAre(3U));
  EXPECT_THAT(roster.settle(now).boats_to_stop, IsEmpty()) << "stopped once";
  EXPECT_EQ(roster.ownerOf(3), ada.person_id);
  EXPECT_TRUE(roster.people().people(0).away());

  roster.settle(now + 9s);
  const Admission back = arrive(8, "", ada.resume_key);
  EXPECT_TRUE(back.resumed);
  EXPECT_EQ(back.person_id, ada.person_id);
  EXPECT_FALSE(back.displaced);
  EXPECT_EQ(roster.people().people(0).name(), "Ada");
  EXPECT_FALSE(roster.people().people(0).away());
  EXPECT_EQ(roster.ownerOf(3), ada.person_id);
  roster.settle(now + 60s);
  EXPECT_EQ(roster.ownerOf(3), ada.person_id) << "the grace ended with the return";
}

TEST_F(RosterTest, AfterTheGraceTimeTheBoatHasNoOwner) {
  const Admission ada = arrive(7);
  roster.give(3, ada.person_id);
  roster.leave(7, now);
  const Roster::Turn turn = roster.settle(now + 10s);
  EXPECT_THAT(turn.boats_to_stop, ElementsAre(3U));
  EXPECT_TRUE(turn.is_news);
  EXPECT_EQ(roster.ownerOf(3), 0U);
  EXPECT_FALSE(arrive(8, "", ada.resume_key).resumed);
}

TEST_F(RosterTest, ResumingReplacesTheOldConnection) {
  const Admission ada = arrive(7);
  roster.give(3, ada.person_id);
  const Admission again = arrive(8, "", ada.resume_key);
  EXPECT_TRUE(again.resumed);
  EXPECT_EQ(again.displaced, 7U);
  roster.leave(7, now);  // the old connection ends
  EXPECT_FALSE(roster.people().people(0).away());
  EXPECT_EQ(roster.ownerOf(3), ada.person_id);
}

TEST_F(RosterTest, ABoatHasOneOwner) {
  const auto ada = arrive(7).person_id;
  const auto bob = arrive(8).person_id;
  roster.give(3, ada);
  roster.give(3, bob);
  EXPECT_EQ(roster.ownerOf(3), bob);
  EXPECT_FALSE(roster.hasBoat(ada));
  roster.give(3, 99);
  EXPECT_EQ(roster.ownerOf(3), bob) << "no person with that number is in the room";
}

TEST_F(RosterTest, RemovedBoatsHaveNoOwner) {
  const auto ada = arrive(7).person_id;
  roster.give(3, ada);
  roster.settle(now);
  roster.keepOnly({3});
  EXPECT_FALSE(roster.settle(now).is_news);
  roster.keepOnly({4});
  EXPECT_TRUE(roster.settle(now).is_news);
  EXPECT_FALSE(roster.hasBoat(ada));
}

TEST_F(RosterTest, KeysCannotBeGuessedFromOneAnother) {
  const std::string a = arrive(7).resume_key;
  const std::string b = arrive(8).resume_key;
  EXPECT_EQ(a.size(), 32U);
  EXPECT_NE(a, b);
  EXPECT_FALSE(arrive(9, "", a.substr(0, 31)).resumed);
}

}  // namespace
}  // namespace spindrift::rooms
