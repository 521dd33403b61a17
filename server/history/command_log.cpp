#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

#include <boost/endian/arithmetic.hpp>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <google/protobuf/stubs/logging.h>
#include <spdlog/spdlog.h>

#include <spindrift/core/crc32c.h>
#include <spindrift/history/command_log.h>

namespace spindrift::history {
namespace {

constexpr std::string_view kMagic = "spinrec2";
constexpr std::string_view kMagicV1 = "spinrec1";
/// Larger than any scene: the points of a bed take up to 4 MiB.
constexpr std::uint32_t kRecordMaxBytes = 8u << 20;

/// Before each record, little endian.
struct Prefix {
  boost::endian::little_uint32_t payload_bytes;
  boost::endian::little_uint32_t crc32c;
};

using core::viewOf;

/// Returns a record of a "spinrec1" file in the present form.
v1::Record fromV1(v1::RecordV1& old) {
  v1::Record out;
  out.set_tick(old.tick());
  out.set_number(old.number());
  if (old.has_header()) out.mutable_header()->Swap(old.mutable_header());
  if (old.has_command()) out.mutable_command()->Swap(old.mutable_command());
  if (old.has_scene()) out.mutable_scene()->Swap(old.mutable_scene());
  if (old.has_continued_scene()) out.mutable_continued_scene()->Swap(old.mutable_continued_scene());
  if (old.has_state_hash()) out.set_state_hash(old.state_hash());
  if (old.has_recovered()) out.set_recovered(old.recovered());
  return out;
}

std::optional<v1::Record> parse(const std::string& payload, bool is_v1) {
  const google::protobuf::LogSilencer silencer;
  if (is_v1) {
    v1::RecordV1 old;
    return old.ParseFromString(payload) ? std::optional(fromV1(old)) : std::nullopt;
  }
  v1::Record record;
  return record.ParseFromString(payload) ? std::optional(std::move(record)) : std::nullopt;
}

}  // namespace

void describeDevice(v1::RecordHeader& header, const gpu::DeviceInfo& device) {
  header.set_device(device.name);
  header.set_gl_version(device.gl_version);
}

std::optional<std::string> deviceDifference(const v1::RecordHeader& header, const gpu::DeviceInfo& device) {
  if (header.device() != device.name)
    return fmt::format("recorded on {}, replayed on {}", header.device(), device.name);
  if (header.gl_version().empty()) {
    return fmt::format("the log does not say which version of the driver it was recorded with; this is {}",
                       device.gl_version);
  }
  if (header.gl_version() != device.gl_version) {
    return fmt::format("recorded with the driver {}, replayed with {}, on {}", header.gl_version(), device.gl_version,
                       device.name);
  }
  return std::nullopt;
}

core::Result<std::unique_ptr<CommandLogWriter>> CommandLogWriter::create(const std::filesystem::path& folder,
                                                                         const v1::RecordHeader& header) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  const auto now = std::chrono::time_point_cast<std::chrono::milliseconds>(std::chrono::system_clock::now());
  const auto ms = now.time_since_epoch().count() % 1000;
  const std::string name = fmt::format("{}-{:%Y%m%dT%H%M%S}{:03}.spinrec", header.room(),
                                       fmt::gmtime(std::chrono::system_clock::to_time_t(now)), ms);
  auto self = std::unique_ptr<CommandLogWriter>(new CommandLogWriter(folder / name));
  self->hash_interval_ticks_ = header.hash_interval_ticks();
  self->out_.open(self->file_, std::ios::binary | std::ios::trunc);
  self->out_.write(kMagic.data(), kMagic.size());
  if (self->out_.good()) {
    v1::Record record;
    *record.mutable_header() = header;
    self->write(std::move(record));
  }
  if (!self->out_.good()) {
    return core::unavailable("the log " + self->file_.string() + " cannot be written (" + std::strerror(errno) +
                             "): choose another folder with --record");
  }
  return self;
}

void CommandLogWriter::write(v1::Record record) {
  if (ended_) return;
  record.set_number(++record_count_);
  const std::string payload = record.SerializeAsString();
  const Prefix prefix{static_cast<std::uint32_t>(payload.size()), core::crc32c(viewOf(payload))};
  const std::size_t record_bytes = sizeof prefix + payload.size();
  if (size_bytes_ + record_bytes > kLogMaxBytes) {
    spdlog::warn("the log {} ends here: it has reached {} bytes", file_.string(), kLogMaxBytes);
    ended_ = true;
    return;
  }
  out_.write(reinterpret_cast<const char*>(&prefix), sizeof prefix);
  out_.write(payload.data(), static_cast<std::streamsize>(payload.size()));
  out_.flush();
  size_bytes_ += record_bytes;
  if (out_.good()) return;
  spdlog::error("the log {} ends here: it could not be written ({})", file_.string(), std::strerror(errno));
  ended_ = true;
}

core::Result<std::unique_ptr<CommandLogReader>> CommandLogReader::open(const std::filesystem::path& file) {
  auto self = std::unique_ptr<CommandLogReader>(new CommandLogReader);
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    return core::unavailable("there is no log " + file.string() + ": `serve --record FOLDER` writes them");
  }
  self->in_.open(file, std::ios::binary);
  std::array<char, kMagic.size()> magic{};
  self->in_.read(magic.data(), magic.size());
  self->is_v1_ = std::string_view(magic.data(), magic.size()) == kMagicV1;
  if (!self->in_.good() || (!self->is_v1_ && std::string_view(magic.data(), magic.size()) != kMagic)) {
    return core::invalid(file.string() +
                         " is not a log of a room: it begins neither with \"spinrec2\" nor with \"spinrec1\"");
  }
  self->offset_bytes_ = magic.size();
  const auto first = self->next();
  if (!first || !first->has_header()) {
    return core::invalid(file.string() + " has no header" +
                         (self->truncation_ ? ": " + *self->truncation_ : std::string()));
  }
  self->header_ = first->header();
  return self;
}

std::optional<v1::Record> CommandLogReader::next() {
  if (truncation_) return std::nullopt;
  const auto broken = [&](const std::string& why) {
    truncation_ = fmt::format("{} at byte {}", why, offset_bytes_);
    return std::nullopt;
  };
  Prefix prefix{};
  in_.read(reinterpret_cast<char*>(&prefix), sizeof prefix);
  if (in_.gcount() == 0) return std::nullopt;
  if (in_.gcount() < std::streamsize{sizeof prefix}) return broken("a record breaks off");
  const std::uint32_t length = prefix.payload_bytes;
  if (length > kRecordMaxBytes) return broken("a record is damaged");
  std::string payload(length, '\0');
  in_.read(payload.data(), length);
  if (in_.gcount() < static_cast<std::streamsize>(length)) return broken("a record breaks off");
  auto record = parse(payload, is_v1_);
  if (core::crc32c(viewOf(payload)) != prefix.crc32c || !record) return broken("a record is damaged");
  ++record_count_;
  if (record->number() != 0 && record->number() != record_count_) {
    return broken(fmt::format("record {} stands where record {} follows: records are missing, doubled or exchanged",
                              record->number(), record_count_));
  }
  offset_bytes_ += sizeof prefix + length;
  return record;
}

}  // namespace spindrift::history
