// Which of two processes of one node name keeps it.
#include "node_name.h"

#include <map>

#include <gmock/gmock.h>

namespace spindrift::cluster {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// Processes on one NATS server: a message goes to the handlers of all others.
class Wire {
 public:
  class Process final : public bus::Bus {
   public:
    explicit Process(Wire& wire) : wire_(wire) { wire_.processes_.push_back(this); }
    ~Process() override { std::erase(wire_.processes_, this); }
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;
    using bus::Bus::publish;
    void publish(const std::string& subject, core::ByteView head, core::ByteView /*body*/) override {
      if (is_cut_off) return;
      ++wire_.sent_count;
      for (Process* other : std::vector<Process*>(wire_.processes_)) {
        if (other != this && !other->is_cut_off && other->handlers_.contains(subject)) other->handlers_[subject](head);
      }
    }
    std::unique_ptr<bus::Subscription> subscribe(const std::string& subject, std::size_t /*max*/,
                                                 Handler handler) override {
      handlers_[subject] = std::move(handler);
      return std::make_unique<bus::Subscription>();
    }
    [[nodiscard]] bool isConnected() const override { return !is_cut_off; }
    [[nodiscard]] bus::BusStats stats() const override { return {}; }
    [[nodiscard]] void* connection() const override { return nullptr; }

    bool is_cut_off = false;

   private:
    Wire& wire_;
    std::map<std::string, Handler> handlers_;
  };

  int sent_count = 0;

 private:
  std::vector<Process*> processes_;
};

/// A process that wants a name.
struct Node {
  explicit Node(Wire& wire, const std::string& node = "e1")
      : bus(wire), name(bus, "c.name." + node, [this](const std::string& process) { lost_to = process; }) {}
  std::string claim(std::chrono::milliseconds patience = 1ms) { return name.claim(patience); }

  std::string lost_to;
  Wire::Process bus;
  NodeName name;
};

TEST(NodeName, SecondClaimIsRefusedAtOnce) {
  Wire wire;
  Node first(wire);
  EXPECT_EQ(first.claim(), "");
  Node second(wire);
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THAT(second.claim(1h), HasSubstr("process "));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 10min);
  EXPECT_EQ(first.lost_to, "");
}

TEST(NodeName, IsFreeWhenItsProcessHasEnded) {
  Wire wire;
  {
    Node first(wire);
    EXPECT_EQ(first.claim(), "");
  }
  Node second(wire);
  EXPECT_EQ(second.claim(), "");
}

TEST(NodeName, OtherNamesAreFree) {
  Wire wire;
  Node first(wire, "e1");
  Node second(wire, "e2");
  EXPECT_EQ(first.claim(), "");
  EXPECT_EQ(second.claim(), "");
}

TEST(NodeName, OneOfTwoSimultaneousClaimsEnds) {
  for (int k = 0; k < 20; ++k) {
    Wire wire;
    Node first(wire);
    Node second(wire);
    first.name.pulse();  // both ask before either waits
    second.name.pulse();
    EXPECT_NE(first.claim().empty(), second.claim().empty());
    EXPECT_EQ(first.lost_to + second.lost_to, "") << "a process that starts is told by claim()";
  }
}

TEST(NodeName, OneOfTwoReunitedOwnersIsTold) {
  Wire wire;
  Node first(wire);
  EXPECT_EQ(first.claim(), "");
  first.bus.is_cut_off = true;
  Node second(wire);
  EXPECT_EQ(second.claim(), "");
  first.bus.is_cut_off = false;
  for (int k = 0; k < 3; ++k) {
    first.name.pulse();
    second.name.pulse();
  }
  EXPECT_NE(first.lost_to.empty(), second.lost_to.empty());
  EXPECT_LT(wire.sent_count, 20) << "pulses are not answered without an end";
}

TEST(NodeName, MessagesThatAreMalformedChangeNothing) {
  Wire wire;
  Node first(wire);
  EXPECT_EQ(first.claim(), "");
  Wire::Process stranger(wire);
  const core::Bytes garbage{0xff, 0x07, 0x00};
  stranger.publish("c.name.e1", garbage, {});
  EXPECT_EQ(first.lost_to, "");
}

}  // namespace
}  // namespace spindrift::cluster
