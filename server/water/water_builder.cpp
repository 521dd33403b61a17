#include <utility>

#include <spindrift/water/water_builder.h>

namespace spindrift::water {
namespace {

/// Lower priority than the ticks of running rooms.
constexpr int kBuildNiceness = 10;
/// Scenes, parameters included, whose warm-up is remembered.
constexpr std::size_t kWarmUpMaxCount = 64;

core::Error shutDown() {
  return core::unavailable("the server shuts down");
}

}  // namespace

WaterBuilder::WaterBuilder(gpu::DeviceChoice device, SceneCatalog scenes, const std::function<void()>& done)
    : device_(std::move(device)), scenes_(std::move(scenes)), builds_(0, done), changes_(0, done) {}

std::future<WaterBuilder::Built> WaterBuilder::build(v1::Scene scene, FirstTick first_tick) {
  auto promise = std::make_shared<std::promise<Built>>();
  auto future = promise->get_future();
  builds_.push([this, promise, first_tick, scene = std::move(scene)](bool runs) mutable {
    if (!runs) return promise->set_value(shutDown());
    const std::string kind = scene.SerializeAsString();
    KnownScene known{.basins = &basins_};
    const auto before = warm_ups_.find(kind);
    if (first_tick == FirstTick::kMayBeCold && before != warm_ups_.end()) known.warm_up = before->second;
    Built built = Water::create(device_, std::move(scene), known);
    if (built) {
      if (warm_ups_.size() >= kWarmUpMaxCount) warm_ups_.clear();
      warm_ups_.insert_or_assign(kind, (*built)->warmUp());
      (*built)->release();
      (*built)->setLevelCosts(LevelCosts(scenes_, (*built)->scene()));
    } else {
      ++failure_counts_[static_cast<std::size_t>(built.error().code)];
    }
    promise->set_value(std::move(built));
  });
  return future;
}

void WaterBuilder::yieldToRooms() {
  builds_.setNiceness(kBuildNiceness);
}

std::future<WaterBuilder::Prepared> WaterBuilder::prepare(core::Scene scene, sim::SceneBasis basis) {
  auto promise = std::make_shared<std::promise<Prepared>>();
  auto future = promise->get_future();
  changes_.push([promise, scene = std::move(scene), basis = std::move(basis)](bool runs) {
    promise->set_value(runs ? sim::prepareScene(scene, basis) : Prepared(shutDown()));
  });
  return future;
}

void WaterBuilder::dispose(std::unique_ptr<Water> water) {
  if (!water) return;
  water->release();
  builds_.push([kept = std::shared_ptr<Water>(std::move(water))](bool) mutable { kept.reset(); });
}

}  // namespace spindrift::water
