// The NATS subjects of a cluster. All begin with its name, so that several clusters can share a NATS server.
#pragma once

#include <string>

#include <fmt/format.h>

#include <spindrift/codec/stream.h>
#include <spindrift/core/level.h>

namespace spindrift::cluster {

class Subjects {
 public:
  explicit Subjects(std::string cluster) : cluster_(std::move(cluster)) {}

  /// ToRoom messages.
  [[nodiscard]] std::string room(const std::string& room) const { return cluster_ + ".room." + room; }
  /// ToNode messages.
  [[nodiscard]] std::string node(const std::string& node) const { return cluster_ + ".node." + node; }
  /// NamePulse messages.
  [[nodiscard]] std::string name(const std::string& node) const { return cluster_ + ".name." + node; }
  /// HttpForward messages.
  [[nodiscard]] std::string server(const std::string& server) const { return cluster_ + ".server." + server; }
  /// ServerPulse messages.
  [[nodiscard]] std::string servers() const { return cluster_ + ".servers"; }
  /// Frames of a stream at a level: the delta if there is one, otherwise the keyframe.
  [[nodiscard]] std::string frames(const std::string& room, std::size_t stream, core::Level level) const {
    return fmt::format("{}.frames.{}.{}.{}", cluster_, room, stream, codec::nameOf(level));
  }
  /// The same frames, those of which there are both forms, with both.
  [[nodiscard]] std::string keyframes(const std::string& room, std::size_t stream, core::Level level) const {
    return frames(room, stream, level) + ".key";
  }
  /// The key-value bucket of the directory of rooms.
  [[nodiscard]] std::string directory() const { return cluster_ + "_rooms"; }

 private:
  const std::string cluster_;
};

}  // namespace spindrift::cluster
