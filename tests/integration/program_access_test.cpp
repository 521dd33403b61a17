// Who may, through the program: JSON Web Tokens, tokens of rooms, limits per person, the audit log, and that no token
// reaches a log.
#include <csignal>
#include <fstream>
#include <thread>

#include <boost/json.hpp>
#include <gmock/gmock.h>

#include "jwt_maker.h"
#include "program_fixture.h"
#include "scripted_client.h"

namespace spindrift::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::UnorderedElementsAre;

constexpr const char* kOperator = "operator-operator-1";

class ProgramAccess : public ProgramTest {
 protected:
  void SetUp() override {
    folder().write("secret", std::string(kJwtSecret) + "\n");
    folder().write("tokens", std::string("operator ") + kOperator + " sub=chief\n");
    folder().write("audit.jsonl", "");
  }

  /// ProgramTest::serve() with two rooms, tokens, JWTs and the audit log.
  bool serve(const std::vector<std::string>& more = {}, const std::string& log_level = "info") {
    std::vector<std::string> all{
        "--log-level",   log_level,      "--room",      "lab=" + smallScene(), "--jwt-key", "hs256:" + path("secret"),
        "--tokens-file", path("tokens"), "--audit-log", path("audit.jsonl")};
    all.insert(all.end(), more.begin(), more.end());
    return ProgramTest::serve(all);
  }

  static std::string jwt(const std::string& role, const std::string& more = "", std::int64_t lifetime_s = 3600) {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    const auto now_s = std::chrono::duration_cast<std::chrono::seconds>(now).count();
    return hs256(R"({"role":")" + role + R"(","exp":)" + std::to_string(now_s + lifetime_s) + more + "}");
  }

  HttpAnswer ask(const std::string& method, const std::string& target, const std::string& token,
                 const std::string& body = "") const {
    std::string headers = body.empty() ? "" : "Content-Type: application/json\r\n";
    if (!token.empty()) headers += "Authorization: Bearer " + token + "\r\n";
    return httpRequest(port_, method, target, headers, body);
  }
  std::vector<std::string> roomsFor(const std::string& token) const {
    std::vector<std::string> out;
    const boost::json::value list = boost::json::parse(ask("GET", "/api/v1/rooms", token).body);
    for (const auto& room : list.at("rooms").as_array()) out.emplace_back(room.at("name").as_string());
    return out;
  }
  ScriptedClient client(const std::string& token, const std::string& room = "", const std::string& name = "") const {
    ScriptedClient out(port_, room);
    EXPECT_TRUE(out.isOpen());
    out.hello({.name = name, .token = token});
    (void)out.welcome();
    return out;
  }
  /// Each line of the audit log as an object.
  std::vector<boost::json::object> audit(const std::string& name = "audit.jsonl") const {
    std::ifstream in(path(name));
    std::vector<boost::json::object> out;
    for (std::string line; std::getline(in, line);) out.push_back(boost::json::parse(line).as_object());
    return out;
  }
  /// Waits until the log of the audit has so many lines.
  bool auditHas(std::size_t count, const std::string& name = "audit.jsonl") const {
    for (int k = 0; k < 400 && audit(name).size() < count; ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(25));
    return audit(name).size() >= count;
  }
};

std::string text(const boost::json::object& object, const char* member) {
  const auto* found = object.if_contains(member);
  return found && found->is_string() ? std::string(found->as_string()) : "";
}

TEST_F(ProgramAccess, JwtGivesRoleNameAndRoom) {
  if (!serve()) GTEST_SKIP() << "no device";
  const std::string token = jwt("player", R"(,"sub":"ada","name":"Ada","room":"lab")");
  ScriptedClient ada = client(token, "lab", "Somebody else");
  EXPECT_EQ(ada.welcome().role(), v1::ROLE_PLAYER);
  const auto people = ada.waitFor(v1::ServerMessage::kPeople);
  ASSERT_TRUE(people);
  EXPECT_EQ(people->people().people(0).name(), "Ada") << "the token's name is certified, the client's is not";
  EXPECT_TRUE(ada.apply(splash()));
  EXPECT_EQ(ada.rejected(reset()).reason(), v1::REJECT_REASON_FORBIDDEN);

  ScriptedClient elsewhere = client(token, "main");
  const auto refusal = elsewhere.waitFor(v1::ServerMessage::kRefusal);
  ASSERT_TRUE(refusal);
  EXPECT_THAT(refusal->refusal().message(), HasSubstr("not for room 'main'"));
  ASSERT_TRUE(elsewhere.ws().waitClosed());
  EXPECT_EQ(elsewhere.ws().closeCode(), 4401);

  const std::string splash_json = R"({"splash": {}})";
  EXPECT_EQ(ask("POST", "/api/v1/rooms/lab/commands", token, splash_json).status, 200U);
  for (const char* target : {"/api/v1/rooms/main/commands", "/api/v1/rooms/nowhere/commands"}) {
    const HttpAnswer answer = ask("POST", target, token, splash_json);
    EXPECT_EQ(answer.status, 403U);
    EXPECT_THAT(answer.body, HasSubstr("not for room"));
  }
  EXPECT_THAT(roomsFor(token), ElementsAre("lab"));
  EXPECT_THAT(roomsFor(""), UnorderedElementsAre("main", "lab"));
  EXPECT_EQ(ask("GET", "/api/v1/rooms", jwt("player", "", -60)).status, 401U);
  EXPECT_EQ(ask("GET", "/api/v1/rooms", token + "x").status, 401U);
  stop();
}

TEST_F(ProgramAccess, TokensUpTo8KiBPassBothWays) {
  if (!serve()) GTEST_SKIP() << "no device";
  const std::string token = jwt("player", R"(,"more":")" + std::string(5900, 'm') + "\"");
  ASSERT_GT(token.size(), 7900U);
  ASSERT_LE(token.size(), 8192U);
  EXPECT_EQ(client(token).welcome().role(), v1::ROLE_PLAYER);
  EXPECT_EQ(ask("POST", "/api/v1/rooms/main/commands", token, R"({"splash": {}})").status, 200U);
  const HttpAnswer answer = ask("GET", "/api/v1/rooms", token + std::string(400, 'm'));
  EXPECT_EQ(answer.status, 401U);
  EXPECT_THAT(answer.body, HasSubstr("8192 bytes"));
  stop();
}

TEST_F(ProgramAccess, OperatorOfOneRoomOpensAndClosesOnlyIt) {
  if (!serve()) GTEST_SKIP() << "no device";
  const std::string token = jwt("operator", R"(,"sub":"bob","room":["race"])");
  EXPECT_EQ(ask("POST", "/api/v1/rooms", token, R"({"name": "other", "scene": "wave_only"})").status, 403U);
  EXPECT_EQ(ask("DELETE", "/api/v1/rooms/lab", token).status, 403U);
  EXPECT_EQ(ask("POST", "/api/v1/rooms", token, R"({"name": "race", "scene": "wave_only"})").status, 201U);
  EXPECT_EQ(ask("DELETE", "/api/v1/rooms/race", token).status, 204U);
  stop();
}

TEST_F(ProgramAccess, RoomTokensAreShownOnceAndSurviveARestart) {
  const std::vector<std::string> state{"--state-dir", path("state")};
  if (!serve(state)) GTEST_SKIP() << "no device";
  const HttpAnswer opened =
      ask("POST", "/api/v1/rooms", kOperator,
          R"({"name": "race", "scene": "wave_only", "tokens": ["ROLE_PLAYER", "ROLE_OPERATOR"]})");
  ASSERT_EQ(opened.status, 201U) << opened.body;
  const boost::json::value answer = boost::json::parse(opened.body);
  const auto& tokens = answer.at("tokens").as_array();
  ASSERT_EQ(tokens.size(), 2U);
  const std::string player(tokens[0].at("token").as_string());
  const std::string chief(tokens[1].at("token").as_string());
  EXPECT_THAT(ask("GET", "/api/v1/rooms/race", kOperator).body, Not(HasSubstr(player)));
  for (const int round : {0, 1}) {
    if (round == 1) {
      child_->signal(SIGKILL);
      (void)child_->wait();
      ASSERT_TRUE(serve(state));
    }
    EXPECT_EQ(client(player, "race").welcome().role(), v1::ROLE_PLAYER) << round;
    EXPECT_EQ(client(chief, "race").welcome().role(), v1::ROLE_OPERATOR) << round;
    EXPECT_EQ(client(player, "main").welcome().person_id(), 0U) << "refused";
    EXPECT_EQ(ask("GET", "/api/v1/rooms/main", chief).status, 403U);
    EXPECT_THAT(roomsFor(chief), ElementsAre("race"));
  }
  EXPECT_EQ(ask("DELETE", "/api/v1/rooms/race", chief).status, 204U);
  EXPECT_EQ(ask("GET", "/api/v1/rooms", chief).status, 401U) << "the token went with the room";
  EXPECT_EQ(ask("POST", "/api/v1/rooms", kOperator, R"({"name": "a", "scene": "wave_only", "tokens": [0]})").status,
            422U);
  stop();
  for (const auto& entry : std::filesystem::recursive_directory_iterator(path("state"))) {
    if (!entry.is_regular_file()) continue;
    std::ifstream in(entry.path(), std::ios::binary);
    const std::string content(std::istreambuf_iterator<char>(in), {});
    EXPECT_EQ(content.find(player), std::string::npos) << entry.path();
  }
}

TEST_F(ProgramAccess, PersonHasOneBudgetOverAllSessions) {
  if (!serve({"--person-commands-per-s", "1"})) GTEST_SKIP() << "no device";
  const std::string token = jwt("player", R"(,"sub":"ada")");
  ScriptedClient one = client(token, "main");
  ScriptedClient other = client(token, "lab");
  ScriptedClient bob = client(jwt("player", R"(,"sub":"bob")"), "main");
  int taken = 0;
  int busy = 0;
  for (int k = 0; k < 4; ++k) {
    for (ScriptedClient* const session : {&one, &other}) {
      const v1::ServerMessage answer = session->ask(splash());
      taken += answer.has_ack() ? 1 : 0;
      if (!answer.has_reject()) continue;
      ++busy;
      EXPECT_EQ(answer.reject().reason(), v1::REJECT_REASON_BUSY);
      EXPECT_THAT(answer.reject().message(), HasSubstr("by one person, over all sessions and rooms"));
    }
  }
  EXPECT_GE(taken, 2) << "the burst";
  EXPECT_GE(busy, 1) << "eight commands of one person in a moment";
  EXPECT_TRUE(bob.apply(splash())) << "another person has another budget";
  const HttpAnswer metrics = ask("GET", "/metrics", "");
  EXPECT_THAT(metrics.body, HasSubstr("spindrift_person_busy_total " + std::to_string(busy)));
  stop();
}

TEST_F(ProgramAccess, AuditLogNamesOperatorsAndRefusals) {
  if (!serve()) GTEST_SKIP() << "no device";
  ScriptedClient chief = client(jwt("operator", R"(,"sub":"ada\"}\n{","name":"A\"da\n{")"));
  const v1::ServerMessage set = chief.ask(setParameter("wave.depth_m", 1.25));
  ASSERT_TRUE(set.has_ack()) << set.DebugString() << chief.welcome().DebugString();
  ASSERT_TRUE(chief.apply(splash())) << "players may do it, too: not in the log";
  EXPECT_EQ(chief.rejected(step(1)).reason(), v1::REJECT_REASON_OUT_OF_RANGE);
  ScriptedClient player = client(jwt("player", R"(,"sub":"bob")"));
  EXPECT_EQ(player.rejected(reset()).reason(), v1::REJECT_REASON_FORBIDDEN);
  (void)client("wrong-wrong-wrong-wrong");
  ASSERT_EQ(ask("POST", "/api/v1/rooms/lab/commands", kOperator, R"({"set_paused": {"paused": true}})").status, 200U);
  ASSERT_EQ(ask("POST", "/api/v1/rooms", kOperator, R"({"name": "race", "scene": "wave_only"})").status, 201U);
  ASSERT_EQ(ask("DELETE", "/api/v1/rooms/race", kOperator).status, 204U);
  stop();
  const auto lines = audit();
  ASSERT_EQ(lines.size(), 7U);
  EXPECT_EQ(text(lines[0], "event"), "command");
  EXPECT_EQ(text(lines[0], "room"), "main");
  EXPECT_EQ(text(lines[0], "kind"), "set_parameter");
  EXPECT_EQ(text(lines[0].at("content").as_object(), "path"), "wave.depth_m");
  EXPECT_EQ(lines[0].at("content").at("value").to_number<double>(), 1.25);
  EXPECT_EQ(text(lines[0], "outcome"), "applied");
  EXPECT_TRUE(lines[0].contains("tick"));
  EXPECT_EQ(text(lines[0], "subject"), "ada\"}{") << "without its control characters, in one line";
  EXPECT_EQ(text(lines[0], "name"), "A\"da{");
  EXPECT_EQ(lines[0].at("person_id").as_int64(), 1);
  EXPECT_THAT(text(lines[0], "peer"), HasSubstr("127.0.0.1"));
  EXPECT_EQ(text(lines[1], "kind"), "step");
  EXPECT_EQ(text(lines[1], "reason"), "out_of_range");
  EXPECT_EQ(text(lines[2], "subject"), "bob");
  EXPECT_EQ(text(lines[2], "reason"), "forbidden");
  EXPECT_EQ(text(lines[3], "event"), "refused");
  EXPECT_THAT(text(lines[3], "message"), HasSubstr("does not know that token"));
  EXPECT_EQ(text(lines[4], "kind"), "set_paused");
  EXPECT_EQ(text(lines[4], "subject"), "chief");
  EXPECT_THAT(text(lines[4], "peer"), HasSubstr("127.0.0.1"));
  EXPECT_EQ(text(lines[5], "event"), "room_opened");
  EXPECT_EQ(text(lines[6], "event"), "room_closed");
  EXPECT_EQ(text(lines[6], "room"), "race");
}

TEST_F(ProgramAccess, FloodOfRefusalsDoesNotFillTheAuditLog) {
  if (!serve()) GTEST_SKIP() << "no device";
  for (int k = 0; k < 200; ++k) EXPECT_EQ(ask("GET", "/api/v1/rooms", "wrong-wrong-wrong-wrong").status, 401U);
  const std::string metrics = ask("GET", "/metrics", "").body;
  stop();
  EXPECT_LT(audit().size(), 150U);
  EXPECT_THAT(metrics, Not(HasSubstr("spindrift_audit_left_out_total 0")));
}

TEST_F(ProgramAccess, SighupReloadsTokensKeysAndAuditLog) {
  if (!serve()) GTEST_SKIP() << "no device";
  const std::string pause = R"({"set_paused": {"paused": true}})";
  ASSERT_EQ(ask("POST", "/api/v1/rooms/lab/commands", kOperator, pause).status, 200U);
  ASSERT_TRUE(auditHas(1));
  std::filesystem::rename(path("audit.jsonl"), path("audit.old"));
  folder().write("tokens", "operator another-another-another\n");
  folder().write("secret", std::string(40, 'n'));
  child_->signal(SIGHUP);
  for (int k = 0; k < 400 && ask("GET", "/api/v1/rooms", kOperator).status != 401U; ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(25));
  EXPECT_EQ(ask("POST", "/api/v1/rooms/lab/commands", kOperator, pause).status, 401U);
  EXPECT_EQ(ask("POST", "/api/v1/rooms/lab/commands", jwt("operator"), pause).status, 401U);
  EXPECT_EQ(ask("POST", "/api/v1/rooms/lab/commands", "another-another-another", pause).status, 200U);
  folder().write("tokens", "king another-another-another\n");
  child_->signal(SIGHUP);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_EQ(ask("POST", "/api/v1/rooms/lab/commands", "another-another-another", pause).status, 200U)
      << "with a wrong file everything stays as it was";
  const std::string log = stop();
  EXPECT_THAT(log, HasSubstr("stay as they were"));
  EXPECT_EQ(text(audit("audit.old").at(0), "subject"), "chief");
  EXPECT_FALSE(audit().empty());
}

TEST_F(ProgramAccess, InvalidKeyIsReportedAtTheStart) {
  const auto outcomeOf = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"serve", "--port", "0", "--scene", smallScene()});
    return runProgram(options);
  };
  folder().write("short", "short");
  folder().write("private.pem", pemOf(makeEd25519Key(), true));
  expectOneErrorLine(outcomeOf({"--jwt-key", "hs256:" + path("short")}), 2, {"--jwt-key", "5 bytes", "32"});
  expectOneErrorLine(outcomeOf({"--jwt-key", path("private.pem")}), 2, {"private key"});
  expectOneErrorLine(outcomeOf({"--jwt-key", path("nothing")}), 2, {"--jwt-key", "nothing"});
  expectOneErrorLine(outcomeOf({"--jwt-keys", path("short")}), 2, {"--jwt-keys", "not JSON"});
  expectOneErrorLine(outcomeOf({"--jwt-issuer", "me"}), 2, {"--jwt-key"});
  expectOneErrorLine(outcomeOf({"--audit-log", path("no/such/folder")}), 2, {"--audit-log"});
}

TEST_F(ProgramAccess, NoLogContainsAToken) {
  folder().write("ed.pem", pemOf(makeEd25519Key()));
  if (!serve({"--jwt-key", path("ed.pem"), "--jwt-issuer", "me", "--state-dir", path("state")}, "trace"))
    GTEST_SKIP() << "no device";
  const std::string iss = R"(,"iss":"me")";
  const HttpAnswer opened =
      ask("POST", "/api/v1/rooms", kOperator, R"({"name": "race", "scene": "wave_only", "tokens": ["ROLE_PLAYER"]})");
  ASSERT_EQ(opened.status, 201U) << opened.body;
  const boost::json::value answer = boost::json::parse(opened.body);
  const std::string of_room(answer.at("tokens").at(0).at("token").as_string());
  const std::vector<std::string> tokens{kOperator,
                                        of_room,
                                        "wrong-wrong-wrong-wrong",
                                        jwt("player", iss + R"(,"sub":"ada")"),
                                        jwt("player", iss, -3600),
                                        jwt("player", iss + R"(,"room":"nowhere")"),
                                        jwt("king", iss),
                                        jwt("player"),
                                        signedToken(R"({"alg":"EdDSA"})", R"({"role":"operator"})", makeEd25519Key()),
                                        hs256(R"({"role":"operator"})", std::string(32, 'x')),
                                        unsignedToken(R"({"alg":"none"})", R"({"role":"operator"})") + ".",
                                        std::string(9000, 'q')};
  for (const std::string& token : tokens) {
    for (const char* room : {"main", "race"}) {
      ScriptedClient session = client(token, room);
      if (session.welcome().person_id() != 0) (void)session.ask(setPaused(false));
    }
    (void)ask("GET", "/api/v1/rooms", token);
    (void)ask("GET", "/api/v1/rooms/main", token);
    (void)ask("POST", "/api/v1/rooms/main/commands", token, R"({"reset": {}})");
    (void)ask("POST", "/api/v1/rooms/race/commands", token, R"({"splash": {"depth_m": 99}})");
    // Mistakes: a token in an address, in a header of another form, as a room.
    (void)ask("GET", "/api/v1/rooms?token=" + token, "");
    (void)ask("GET", "/?token=" + token, "");
    (void)ask("GET", "/ws/main?token=" + token, "");
    (void)ask("GET", "/api/v1/rooms/" + token, "");
    (void)httpRequest(port_, "GET", "/api/v1/rooms", "Authorization: Basic " + token + "\r\n", "");
    (void)httpRequest(port_, "GET", "/api/v1/rooms", "Authorization: " + token + "\r\n", "");
    ScriptedClient wrong_room(port_, token.substr(0, 200));
  }
  child_->signal(SIGHUP);
  const std::string log = stop();
  EXPECT_GT(log.size(), 1000U) << "the log of everything above";
  std::ifstream in(path("audit.jsonl"));
  const std::string audit_log(std::istreambuf_iterator<char>(in), {});
  EXPECT_THAT(audit_log, HasSubstr("refused"));
  // Parts, too: a log may cut a token. The header of a JWT is not a secret and says little.
  constexpr std::size_t kPartBytes = 12;
  for (const std::string& token : tokens) {
    const std::size_t begin = token.find('.') == std::string::npos ? 0 : token.find('.') + 1;
    for (std::size_t at = begin; at + kPartBytes <= token.size(); at += kPartBytes) {
      const std::string part = token.substr(at, kPartBytes);
      ASSERT_EQ(log.find(part), std::string::npos) << part << " of " << token;
      ASSERT_EQ(audit_log.find(part), std::string::npos) << part << " of " << token;
    }
  }
}

}  // namespace
}  // namespace spindrift::test
