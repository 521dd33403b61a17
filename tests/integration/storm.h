// A storm: hostile clients of every role send whatever the wire allows, as fast as they can, while other clients watch
// and splash. Reports what those others noticed.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include <spindrift/v1/wire.pb.h>

namespace spindrift::test {

/// What one attacker repeats.
enum class Attack {
  kSpeedBursts,    ///< 300 SetSpeed in one go, once per second
  kResets,         ///< 190 Reset per second
  kScenes,         ///< ChangeScene, to any scene that there is
  kParameters,     ///< SetParameter, any live one over its whole range
  kParticleCount,  ///< particles.count to its ends and between
  kBoats,          ///< SpawnBoat, TakeBoat, ControlBoat and RemoveBoat
  kEverything,     ///< commands of every kind
  kConnections,    ///< connects, says hello or nothing, leaves without a word
  kBytes,          ///< bytes that are not a message
};

struct Attacker {
  Attack attack = Attack::kEverything;
  std::string token{};  ///< gives the role; empty: a guest
};

struct StormOptions {
  std::uint16_t port = 0;
  std::vector<std::string> rooms;   ///< bystanders are in each; attackers in the first
  std::size_t bystander_count = 4;  ///< per room
  std::string bystander_token{};
  std::vector<Attacker> attackers;
  std::chrono::duration<double> duration{5.0};
  std::uint32_t seed = 1;
};

struct StormReport {
  std::uint64_t attack_count = 0;    ///< messages that attackers sent
  std::size_t lost_count = 0;        ///< bystanders whose connection ended
  std::string first_loss;            ///< code and reason of the first of them
  std::size_t unanswered_count = 0;  ///< bystanders' commands without an answer at the end
  std::uint64_t fewest_frames = 0;   ///< of a bystander
  double longest_gap_s = 0.0;        ///< between two frames of any layer, of any bystander
  std::vector<double> answers_s;     ///< bystanders' commands, from sending to Ack or Reject; sorted
  std::uint64_t attackers_closed_count = 0;
};

StormReport runStorm(const StormOptions& options);

}  // namespace spindrift::test
