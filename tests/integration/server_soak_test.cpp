// The load of the soak on one server: clients that come and go all the time are answered, and see only finite numbers.
#include <set>
#include <string>

#include <boost/json.hpp>
#include <gmock/gmock.h>

#include <spindrift/bench/soak.h>

#include "server_fixture.h"

namespace spindrift::test {
namespace {

struct Closer {
  void operator()(std::FILE* file) const { (void)std::fclose(file); }
};

class Soak : public ServerTest {
 protected:
  std::vector<RoomText> rooms() const override {
    return {{"main", R"(
      wave { resolution_count: 64 side_m: 16 depth_m: 1.5 }
      particles { count: 512 layers_count: 2 headroom_m: 2 }
      coupling {}
      foam {}
      boats { capacity_count: 16 }
    )"}};
  }

  static double numberOf(const boost::json::object& report, const std::string& name) {
    return report.at(name).to_number<double>();
  }
};

TEST_F(Soak, ComingAndGoingClientsAreAnswered) {
  bench::SoakOptions options;
  const std::string url = "ws://127.0.0.1:" + std::to_string(server().port()) + "/ws";
  options.urls = {url, url, url + "/not_there"};
  options.client_count = 16;
  options.seconds = 5.0;
  options.warm_up_s = 1.0;
  options.interval_s = 1.0;
  options.churn_per_s = 20.0;
  options.strokes_per_s = 0.5;
  options.boats_per_s = 0.5;
  options.level_changes_per_s = 2.0;
  const std::unique_ptr<std::FILE, Closer> nowhere(std::fopen("/dev/null", "w"));
  ASSERT_TRUE(nowhere);
  // In five seconds in which a busy machine hardly runs, not all of it need happen: then it continues.
  constexpr int kMostRuns = 10;
  std::set<std::string> awaited = {"sent",    "answers", "heavy_answers", "reconnects",
                                   "resumed", "refused", "frames",        "decoded"};
  for (int run = 0; run < kMostRuns && !awaited.empty(); ++run) {
    const auto report = bench::measureSoak(options, nowhere.get());
    ASSERT_TRUE(report) << report.error().message;
    SCOPED_TRACE(boost::json::serialize(*report));
    ++options.seed;
    std::erase_if(awaited, [&](const std::string& name) { return numberOf(*report, name) > 0.0; });
    for (const char* none : {"unanswered", "undecodable", "nonfinite", "watchdog_nonfinite"})
      EXPECT_EQ(numberOf(*report, none), 0.0) << none;
    EXPECT_TRUE(report->at("ended").as_object().empty()) << "the server ended connections of its clients";
    EXPECT_LE(numberOf(*report, "answer_p50_ms"), numberOf(*report, "answer_p99_ms"));
    EXPECT_LE(numberOf(*report, "answer_p99_ms"), numberOf(*report, "answer_max_ms"));
    EXPECT_LE(numberOf(*report, "answers") + numberOf(*report, "heavy_answers"), numberOf(*report, "sent"));
  }
  EXPECT_THAT(awaited, testing::IsEmpty());
}

TEST_F(Soak, RefusesAUrlThatIsNone) {
  bench::SoakOptions options;
  EXPECT_EQ(bench::measureSoak(options, stdout).error().code, core::ErrorCode::kInvalidInput);
  options.urls = {"http://127.0.0.1/"};
  EXPECT_EQ(bench::measureSoak(options, stdout).error().code, core::ErrorCode::kInvalidInput);
}

}  // namespace
}  // namespace spindrift::test
