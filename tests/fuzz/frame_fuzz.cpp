// Frames as a client reads them. An input is one serialized ServerMessage, or several with a separator; the decoders of
// deltas keep their state from one to the next. The mutator of this target changes payloads inside valid
// messages: lengths and checksums would stop almost every random change before the decoder.
#include <algorithm>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <spindrift/codec/frame_decoder.h>
#include <spindrift/core/crc32c.h>

#include "fuzz.h"
#include "invariants.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed);

namespace spindrift::fuzz {
namespace {

constexpr std::string_view kMark = "\xff\xff====";
/// Larger planes and counts only cost time; other tests run the decoders at their bounds.
constexpr std::uint32_t kResolutionMaxCount = 128;
constexpr std::uint32_t kParticleMaxCount = 4096;

std::vector<std::string> split(std::string_view input) {
  std::vector<std::string> out;
  while (true) {
    const std::size_t mark = input.find(kMark);
    out.emplace_back(input.substr(0, mark));
    if (mark == std::string_view::npos) return out;
    input.remove_prefix(mark + kMark.size());
  }
}

bool isSmall(const v1::LayerFrame& frame) {
  return frame.surface_predicted().resolution_count() <= kResolutionMaxCount &&
         frame.foam_predicted().resolution_count() <= kResolutionMaxCount &&
         frame.particles_by_cell().count() <= kParticleMaxCount;
}

void setChecksum(v1::LayerFrame& frame) {
  frame.set_crc32c(
      core::crc32c({reinterpret_cast<const std::uint8_t*>(frame.payload().data()), frame.payload().size()}));
}

template <typename Decoded>
void check(const Decoded& decoded) {
  must(decoded ? test::isWhole(*decoded) : !decoded.error().message.empty(),
       "a frame decodes to finite values, as many as it says, or not at all");
}

/// A frame with a wrong checksum is always refused.
void checkRefused(const v1::LayerFrame& frame) {
  must(!codec::decodeSurface(frame) && !codec::decodeParticles(frame) && !codec::decodeFoam(frame) &&
           !codec::decodeBodies(frame) && !codec::decodeFloaters(frame) && !codec::decodePackedParticles(frame) &&
           !codec::PackedSurfaceDecoder().decode(frame) && !codec::PackedFoamDecoder().decode(frame) &&
           !codec::PackedFloaterDecoder().decode(frame),
       "a wrong checksum is noticed");
}

class Client {
 public:
  void read(const v1::LayerFrame& frame) {
    check(codec::decodeSurface(frame));
    check(codec::decodeParticles(frame));
    check(codec::decodeFoam(frame));
    if (const auto bodies = codec::decodeBodies(frame)) {
      must(bodies->size() == frame.bodies_fixed28().count(), "as many bodies as the frame says");
    }
    check(codec::decodeFloaters(frame));
    check(packed_surface_.decode(frame));
    check(packed_foam_.decode(frame));
    check(codec::decodePackedParticles(frame));
    check(packed_floaters_.decode(frame));
  }

 private:
  codec::PackedSurfaceDecoder packed_surface_;
  codec::PackedFoamDecoder packed_foam_;
  codec::PackedFloaterDecoder packed_floaters_;
};

/// Replaces the payload of one of the frames, with the matching checksum. False: there is no frame to change.
bool damagePayload(std::string& message_bytes, std::size_t growth_max_bytes) {
  auto message =
      codec::parseServerMessage({reinterpret_cast<const std::uint8_t*>(message_bytes.data()), message_bytes.size()});
  if (!message || !message->has_frame()) return false;
  v1::LayerFrame& frame = *message->mutable_frame();
  std::string& payload = *frame.mutable_payload();
  const std::size_t before = payload.size();
  payload.resize(before + growth_max_bytes);
  payload.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(payload.data()), before, payload.size()));
  setChecksum(frame);
  message_bytes = message->SerializeAsString();
  return true;
}

}  // namespace
}  // namespace spindrift::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace spindrift;
  fuzz::Client client;
  for (const std::string& bytes : fuzz::split({reinterpret_cast<const char*>(data), size})) {
    const auto message = codec::parseServerMessage({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    if (!message || !message->has_frame() || !fuzz::isSmall(message->frame())) continue;
    const v1::LayerFrame& frame = message->frame();
    v1::LayerFrame whole = frame;
    fuzz::setChecksum(whole);
    if (whole.crc32c() != frame.crc32c()) fuzz::checkRefused(frame);
    client.read(whole);
  }
  return 0;
}

std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned seed) {
  using namespace spindrift;
  std::minstd_rand random(seed);
  if (random() % 2 == 0) return LLVMFuzzerMutate(data, size, max_size);
  std::vector<std::string> messages = fuzz::split({reinterpret_cast<const char*>(data), size});
  std::string& chosen = messages[random() % messages.size()];
  constexpr std::size_t kGrowthMaxBytes = 64;
  if (!fuzz::damagePayload(chosen, kGrowthMaxBytes)) return LLVMFuzzerMutate(data, size, max_size);
  std::string joined = messages.front();
  for (std::size_t i = 1; i < messages.size(); ++i) joined.append(fuzz::kMark).append(messages[i]);
  if (joined.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
  std::ranges::copy(joined, data);
  return joined.size();
}
