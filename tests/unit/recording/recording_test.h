// Messages of a room, and files in memory, for the tests of recordings.
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <string>

#include <spindrift/codec/frame_encoder.h>
#include <spindrift/recording/water_recorder.h>

namespace spindrift::recording {

inline constexpr std::uint64_t kMiB = 1u << 20;

/// A disk in memory. Beyond `max_bytes` of all files together it is full.
struct MemoryDisk {
  std::map<std::string, core::Bytes> files;
  std::size_t max_bytes = 1u << 30;

  OpenSink opener() {
    struct MemorySink final : mcap::Sink {
      MemorySink(MemoryDisk& its_disk, std::string its_name) : disk(its_disk), name(std::move(its_name)) {}
      core::Result<void> append(core::ByteView bytes) override {
        std::size_t used_bytes = bytes.size();
        for (const auto& [other, content] : disk.files) used_bytes += content.size();
        if (used_bytes > disk.max_bytes) return core::unavailable("the disk is full");
        core::Bytes& content = disk.files[name];
        content.insert(content.end(), bytes.begin(), bytes.end());
        return {};
      }
      MemoryDisk& disk;
      std::string name;
    };
    return [this](const std::filesystem::path& path) -> core::Result<std::unique_ptr<mcap::Sink>> {
      const std::string name = path.filename().string();
      if (files.contains(name)) return core::invalid(name + " exists already");
      files[name];
      return std::unique_ptr<mcap::Sink>(std::make_unique<MemorySink>(*this, name));
    };
  }
  [[nodiscard]] bool contains(const std::string& file, const std::string& text) const {
    const core::Bytes& content = files.at(file);
    return std::search(content.begin(), content.end(), text.begin(), text.end()) != content.end();
  }
};

/// Bytes that do not compress.
inline std::string noise(std::size_t count, std::uint32_t seed) {
  std::string out(count, '\0');
  for (char& c : out) {
    seed = seed * 1664525 + 1013904223;
    c = static_cast<char>(seed >> 24);
  }
  return out;
}

inline core::SharedBytes greeting(const std::string& scene = "harbor") {
  v1::ServerMessage out;
  out.mutable_greeting()->set_room("main");
  out.mutable_greeting()->mutable_scene()->set_name(scene);
  return codec::serialized(out);
}

inline core::SharedBytes frame(v1::Layer layer, std::uint64_t tick, bool is_keyframe, std::size_t payload_bytes = 100) {
  v1::ServerMessage out;
  v1::LayerFrame& frame = *out.mutable_frame();
  frame.set_layer(layer);
  frame.set_tick(tick);
  frame.set_time_s(static_cast<double>(tick) / 60);
  frame.set_keyframe(is_keyframe);
  frame.set_payload(noise(payload_bytes, static_cast<std::uint32_t>(tick)));
  return codec::serialized(out);
}

}  // namespace spindrift::recording
