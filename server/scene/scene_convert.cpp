// What generated code (scene_types.py) does not convert: depths of a grid, and a limit.
#include <cstring>
#include <memory>

#include <spindrift/scene/scene_loader.h>
#include <spindrift/scene/to_core.h>

namespace spindrift::scene {

core::DepthGrid toCore(const v1::DepthGrid& in) {
  core::DepthGrid out;
  out.x_m = in.x_m();
  out.z_m = in.z_m();
  out.length_m = in.length_m();
  out.width_m = in.width_m();
  const std::size_t row_bytes = in.points_size() > 0 ? in.points(0).size() : 0;
  out.columns_count = static_cast<std::uint32_t>(row_bytes / sizeof(float));
  out.rows_count = static_cast<std::uint32_t>(in.points_size());
  // derive() refuses a grid whose rows differ: it has fewer depths than points.
  std::vector<float> depths_m;
  for (const std::string& row : in.points()) {
    if (row.size() != row_bytes) break;
    const std::size_t before = depths_m.size();
    depths_m.resize(before + out.columns_count);
    std::memcpy(depths_m.data() + before, row.data(), out.columns_count * sizeof(float));
  }
  out.depths_m = std::make_shared<const std::vector<float>>(std::move(depths_m));
  return out;
}

core::Scene toCore(const v1::Scene& in) {
  core::Scene out = fieldsToCore(in);
  // Below this, waves need hours to cross any water, and numbers that follow from their speed leave the range of
  // floats.
  constexpr double kLeastGravity_mps2 = 1e-6;
  if (out.gravity_mps2 < kLeastGravity_mps2) out.gravity_mps2 = 0.0;
  return out;
}

}  // namespace spindrift::scene
