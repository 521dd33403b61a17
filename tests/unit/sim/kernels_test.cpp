// The kernels: on the host against their definition, on the device against the host.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <shared/bindings.h>
#include <shared/sim_uniforms.h>

#include <spindrift/gpu/buffer.h>
#include <spindrift/gpu/program.h>
#include <spindrift/sim_setup/lattice.h>

#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

using core::KernelSet;
constexpr std::array kSets = {KernelSet::kMuller, KernelSet::kCubicSpline, KernelSet::kWendlandC2};

TEST(Kernels, IntegrateToOneOverTheirSupport) {
  for (const KernelSet set : kSets) {
    for (const double H : {0.1, 0.615, 3.0}) {
      double sum = 0.0;
      const int steps = 20000;
      for (int i = 0; i < steps; ++i) {
        const double r = (i + 0.5) / steps * H;
        sum += 4 * std::numbers::pi * r * r * densityKernel(set, r, H) * H / steps;
      }
      EXPECT_NEAR(sum, 1.0, 1e-6);
    }
  }
}

TEST(Kernels, ArePositiveInsideAndZeroOutside) {
  for (const KernelSet set : kSets) {
    for (int percent = 0; percent < 99; ++percent) {
      const double r = 0.01 * percent;
      EXPECT_GT(densityKernel(set, r, 1.0), 0.0);
      EXPECT_GE(pressureSlope(set, r, 1.0), 0.0);
    }
    EXPECT_EQ(densityKernel(set, 1.0, 1.0), 0.0);
    EXPECT_EQ(pressureSlope(set, 1.5, 1.0), 0.0);
  }
}

TEST(Kernels, SlopesAreTheNegativeDerivative) {
  const double H = 0.7;
  for (int percent = 1; percent < 69; ++percent) {
    const double r = 0.01 * percent;
    const double e = 1e-6;
    for (const KernelSet set : {KernelSet::kCubicSpline, KernelSet::kWendlandC2}) {
      const double derivative = (densityKernel(set, r + e, H) - densityKernel(set, r - e, H)) / (2 * e);
      EXPECT_NEAR(pressureSlope(set, r, H), -derivative, 1e-5 * std::abs(derivative) + 1e-4) << r;
    }
    // MULLER has a different pressure kernel: spiky, W = 15/(pi H^6) (H - r)^3.
    const auto spiky = [&](double x) { return 15 / (std::numbers::pi * std::pow(H, 6)) * std::pow(H - x, 3); };
    EXPECT_NEAR(pressureSlope(KernelSet::kMuller, r, H), -(spiky(r + e) - spiky(r - e)) / (2 * e), 1e-3);
  }
}

class KernelsOnDevice : public OnDevice {};

TEST_F(KernelsOnDevice, EqualTheDoublePrecisionOnes) {
  const double H = 0.615;
  const std::uint32_t count = 1001;
  for (const KernelSet set : kSets) {
    const int number = set == KernelSet::kMuller ? 1 : set == KernelSet::kCubicSpline ? 2 : 3;
    auto program = gpu::Program::create(*ctx_, "tests/kernels.comp", {{"KERNEL_SET", std::to_string(number)}});
    ASSERT_TRUE(program) << program.error().message;
    auto values = gpu::Buffer::create(*ctx_, "kernel values", count * 16);
    ASSERT_TRUE(values);
    program->setUniform("support_radius_m", static_cast<float>(H));
    program->setUniform("count", count);
    values->bindStorage(0);
    program->dispatch(count);
    ctx_->barrier(gpu::Barrier::kBufferUpdate);
    const auto v = values->downloadVector<float>(4 * count);
    for (std::uint32_t i = 0; i < count; ++i) {
      const double r = i / (count - 1.0) * 1.25 * H;
      ASSERT_NEAR(v[4 * i] * densityNorm(set, H), densityKernel(set, r, H), 2e-5 * densityKernel(set, 0, H))
          << "r = " << r;
      if (i == 0) continue;  // at r = 0 a slope has no direction: the device multiplies it by a zero vector
      ASSERT_NEAR(v[4 * i + 1] * slopeNorm(set, H), pressureSlope(set, r, H),
                  2e-5 * slopeNorm(set, H) * (set == KernelSet::kMuller ? H * H : 1.0))
          << "r = " << r;
      ASSERT_NEAR(v[4 * i + 2], std::max(H - r, 0.0), 1e-6);
    }
  }
}

TEST_F(KernelsOnDevice, UniformOffsetsAreThoseOfTheDriver) {
  auto program = gpu::Program::create(*ctx_, "sph/integrate.comp",
                                      {{"PERIODIC_X", "1"},
                                       {"PERIODIC_Y", "0"},
                                       {"PERIODIC_Z", "1"},
                                       {"COUPLED", "1"},
                                       {"WAVE_PERIODIC", "1"},
                                       {"FOAM", "1"}});
  ASSERT_TRUE(program) << program.error().message;
  const auto blocks = program->blocks();
  ASSERT_TRUE(blocks.contains("SimUniforms"));
  const auto& offsets = blocks.at("SimUniforms").offsets;
  EXPECT_EQ(blocks.at("SimUniforms").binding, static_cast<std::uint32_t>(SIM_UNIFORMS));
  using shared::SimUniforms;
  const std::pair<const char*, std::size_t> members[] = {
      {"min_x_m", offsetof(SimUniforms, min_x_m)},
      {"max_z_m", offsetof(SimUniforms, max_z_m)},
      {"support_radius_m", offsetof(SimUniforms, support_radius_m)},
      {"particle_count", offsetof(SimUniforms, particle_count)},
      {"cell_count", offsetof(SimUniforms, cell_count)},
      {"mass_kg", offsetof(SimUniforms, mass_kg)},
      {"max_speed_mps", offsetof(SimUniforms, max_speed_mps)},
      {"dt_s", offsetof(SimUniforms, dt_s)},
      {"viscosity_norm", offsetof(SimUniforms, viscosity_norm)},
      {"floor_gap_m", offsetof(SimUniforms, floor_gap_m)},
      {"foam_keep_ratio", offsetof(SimUniforms, foam_keep_ratio)},
      {"wave_nx", offsetof(SimUniforms, wave_nx)},
      {"wave_width_m", offsetof(SimUniforms, wave_width_m)},
      {"wave_pull", offsetof(SimUniforms, wave_pull)},
      {"breaking_loss_per_s", offsetof(SimUniforms, breaking_loss_per_s)},
      {"surface_quantum_m", offsetof(SimUniforms, surface_quantum_m)},
  };
  for (const auto& [name, offset] : members) {
    const std::string member = name;
    // Drivers name members of a block with an instance name "SimUniforms.member".
    const auto found = std::ranges::find_if(offsets, [&](const auto& entry) {
      return entry.first == member || entry.first.ends_with(std::string(".") + member);
    });
    ASSERT_NE(found, offsets.end()) << member;
    EXPECT_EQ(found->second, offset) << member;
  }
}

}  // namespace
}  // namespace spindrift::sim
